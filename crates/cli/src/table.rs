//! Two-column tables on standard output.

use std::fmt::Write as _;
use std::io::{self, Write as _};

use crate::failure::Failure;
use crate::label::on_one_line;

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

/// A heading, which may be anybody's title, and rows of a name and a value, aligned.
pub fn table(heading: &str, rows: &[(impl AsRef<str>, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.as_ref().chars().count()).max().unwrap_or(0);
    let mut text = format!("{}\n", on_one_line(heading));
    for (name, value) in rows {
        let name = name.as_ref();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {name:width$}  {value}");
    }
    text
}

/// A heading and lines below it.
pub fn list(heading: &str, lines: &[String]) -> String {
    let lines: String = lines.iter().map(|line| format!("  {line}\n")).collect();
    format!("{heading}\n{lines}")
}
