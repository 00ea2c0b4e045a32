//! Text on standard output.

use std::io::{self, Write as _};

use crate::failure::Failure;

pub use plateau_present::table::{columns, list, table};

/// Prints text on standard output.
///
/// # Errors
/// [`Failure::Run`] when standard output takes no more, unless the reader simply went away.
pub fn print(text: &str) -> Result<(), Failure> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::run(format_args!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
