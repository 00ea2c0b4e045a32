//! The program: which it is; its start, with the environment that libraries read when a process starts, and too little memory; and a panic,
//! told in one line.

use std::env;
use std::os::unix::process::CommandExt;
use std::panic::{self, AssertUnwindSafe};
use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use plateau_io::memory;
use plateau_run::Program;
use signal_hook::consts::SIGABRT;

use crate::failure::Failure;
use crate::message;

/// Revision of the source that the program was built from.
pub const REVISION: &str = env!("PLATEAU_REVISION");

/// Version and revision, as `--version` prints them.
pub const WITH_REVISION: &str = concat!(env!("CARGO_PKG_VERSION"), " (revision ", env!("PLATEAU_REVISION"), ")");

/// This program, as run files name it.
pub fn this() -> Program {
    Program { name: name(), revision: REVISION.into() }
}

/// Name and version.
pub fn name() -> String {
    format!("plateau {}", env!("CARGO_PKG_VERSION"))
}

/// Number of pools of memory that the C library makes at most (mallopt(3)).
const POOLS: &str = "MALLOC_ARENA_MAX";
/// Variables by which HDF5 gets at files in another way. Files of this program are plain files: with another driver the library
/// finds none of them, or does not start at all.
const DRIVERS: [&str; 3] = ["HDF5_DRIVER", "HDF5_DRIVER_CONFIG", "HDF5_VOL_CONNECTOR"];

/// Begins anew where the environment does not fit: an environment can be changed safely only for a process that starts.
///
/// Under a limit of the address space (`ulimit -v`, h_vmem of a queue) the C library would reserve 64 MiB of it for each thread, and
/// whatever needs memory next would get none.
pub fn fit_environment() {
    let one_pool = memory::is_address_space_limited() && env::var_os(POOLS).is_none();
    let drivers = DRIVERS.into_iter().filter(|name| env::var_os(name).is_some());
    if !one_pool && drivers.clone().next().is_none() {
        return;
    }
    let mut arguments = env::args_os();
    let name = arguments.next().filter(|name| !name.is_empty()).unwrap_or_else(|| "plateau".into());
    // The file of this process, even where another one has its name by now.
    let mut anew = Command::new("/proc/self/exe");
    anew.arg0(name).args(arguments);
    for name in drivers {
        anew.env_remove(name);
    }
    if one_pool {
        anew.env(POOLS, "1");
    }
    // It comes back only with an error, and then all is as it was.
    let _ = anew.exec();
}

/// Begins only where there is as much memory as any command may need, and ends with status 1 where it runs out later.
pub fn refuse_little_memory() -> Result<(), Failure> {
    end_where_it_runs_out();
    let refused = |no_room| Failure::run(format_args!("the program needs {no_room}: allow more of it (ulimit -v)"));
    memory::refuse_to_begin().map_err(refused)
}

/// A program that gets no more memory ends as one whose run failed, and not by a signal; the library has said then how much was
/// asked for. Files are left as a kill leaves them: complete up to the last flush.
fn end_where_it_runs_out() {
    // Where the system takes no handler the signal tells, too.
    let _ = signal_hook::flag::register_conditional_shutdown(SIGABRT, 1, Arc::new(AtomicBool::new(true)));
}

/// Words with which libraries say that there is no thread to be had: the standard library, rayon.
const NO_THREAD: [&str; 2] = ["failed to spawn thread", "ThreadPoolBuildError"];

/// Words with which libraries say that there is no memory to be had: those that deflate.
const NO_MEMORY: [&str; 3] = ["MemError", "InsufficientMemory", "memory allocation of"];

/// Does `work`; a panic in it, or in a thread, is told in one line, and makes the exit status 1. With `RUST_BACKTRACE` it is told as
/// usual.
pub fn catch_panics(work: impl FnOnce() -> ExitCode) -> ExitCode {
    if env::var_os("RUST_BACKTRACE").is_none_or(|value| value == "0") {
        panic::set_hook(Box::new(|panic| {
            let place =
                panic.location().map_or_else(String::new, |place| format!(" at {}:{}", place.file(), place.line()));
            message::error(in_words(panic.payload_as_str().unwrap_or_default(), &place));
        }));
    }
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or(ExitCode::FAILURE)
}

fn in_words(text: &str, place: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if NO_THREAD.iter().any(|known| text.contains(known)) {
        return format!("the system gives no more threads: allow more of them, or more memory ({text})");
    }
    if NO_MEMORY.iter().any(|known| text.contains(known)) {
        return format!("the system gives no more memory: allow more of it ({text})");
    }
    format!("the program panicked{place}: {text}: this is a mistake of the program, please report it with the command")
}

#[cfg(test)]
#[path = "../tests/unit/program.rs"]
mod tests;
