//! What the program does where it may take little memory.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use plateau_io::memory;
use signal_hook::consts::SIGABRT;

use crate::failure::Failure;

/// Begins only where there is as much memory as any command may need, and ends with status 1 where it runs out later.
///
/// # Errors
/// [`Failure::Run`] where there is too little.
pub fn begin() -> Result<(), Failure> {
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
