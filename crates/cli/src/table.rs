//! Text on standard output.

use std::io::{self, Write as _};

use plateau_io::text::shown;

use crate::failure::Failure;

pub use plateau_present::table::{columns, list, table};

/// Prints text on standard output. Text of others in it cannot do anything to the terminal.
///
/// # Errors
/// [`Failure::Run`] when standard output takes no more, unless the reader simply went away.
pub fn print(text: &str) -> Result<(), Failure> {
    printed(io::stdout().lock().write_all(shown(text).as_bytes()))
}

/// What comes of writing to standard output.
///
/// # Errors
/// As [`print()`].
pub fn printed(written: io::Result<()>) -> Result<(), Failure> {
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::run(format_args!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
