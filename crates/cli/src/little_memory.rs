//! What the program does where it may take little memory.

use std::env;
use std::os::unix::process::CommandExt;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use plateau_io::memory;
use signal_hook::consts::SIGABRT;

use crate::failure::Failure;

/// Number of pools of memory that the C library makes at most (mallopt(3)).
const POOLS: &str = "MALLOC_ARENA_MAX";

/// Begins only where there is as much memory as any command may need, and ends with status 1 where it runs out later.
///
/// # Errors
/// [`Failure::Run`] where there is too little.
pub fn begin() -> Result<(), Failure> {
    if memory::is_address_space_limited() && env::var_os(POOLS).is_none() {
        begin_anew_with_one_pool();
    }
    end_where_it_runs_out();
    let refused = |no_room| Failure::run(format_args!("the program needs {no_room}: allow more of it (ulimit -v)"));
    memory::refuse_to_begin().map_err(refused)
}

/// Under a limit of the address space (`ulimit -v`, h_vmem of a queue) the C library would reserve 64 MiB of it for each thread, and
/// whatever needs memory next would get none. It reads how many such pools it makes when a process starts.
fn begin_anew_with_one_pool() {
    let mut arguments = env::args_os();
    let name = arguments.next().filter(|name| !name.is_empty()).unwrap_or_else(|| "plateau".into());
    // The file of this process, even where another one has its name by now. It comes back only with an error, and then it is as it was.
    let _ = Command::new("/proc/self/exe").arg0(name).args(arguments).env(POOLS, "1").exec();
}

/// A program that gets no more memory ends as one whose run failed, and not by a signal; the library has said then how much was
/// asked for. Files are left as a kill leaves them: complete up to the last flush.
fn end_where_it_runs_out() {
    // Where the system takes no handler the signal tells, too.
    let _ = signal_hook::flag::register_conditional_shutdown(SIGABRT, 1, Arc::new(AtomicBool::new(true)));
}
