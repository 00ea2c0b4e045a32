//! Staying alive when a file grows beyond the limit set for the process.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Makes a write beyond the file size limit (`ulimit -f`) an error of that write.
///
/// Without this the system ends the process with the signal SIGXFSZ and nobody is told why. A program calls it once,
/// before it writes run files.
///
/// # Errors
/// When the system does not take the handler.
pub fn report_file_size_limit() -> io::Result<()> {
    // The flag is of no interest: a handler, whatever it does, makes the system answer the write with EFBIG.
    let noticed = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, noticed).map(|_| ())
}
