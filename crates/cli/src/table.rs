//! Text on standard output, tables in it, and tables as comma-separated values.

use std::fmt::Write as _;
use std::io::{self, Write as _};

use plateau_io::text::{cell, is_plain, shown};
use serde::Serialize;

use crate::failure::Failure;

/// Prints text on standard output. Text of others in it cannot do anything to the terminal.
pub fn print(text: &str) -> Result<(), Failure> {
    printed(io::stdout().lock().write_all(shown(text).as_bytes()))
}

/// Prints one JSON document.
pub fn print_json(document: &impl Serialize) -> Result<(), Failure> {
    print(&json(document)?)
}

/// One JSON document for people, with the end of its last line.
pub fn json(document: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(document).map(|text| text + "\n").map_err(Failure::run)
}

/// Result of writing to standard output.
pub fn printed(written: io::Result<()>) -> Result<(), Failure> {
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::run(format_args!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// A text without characters that would move, hide or turn what follows them.
pub fn on_one_line(text: &str) -> String {
    text.chars().map(|letter| if is_plain(letter) { letter } else { ' ' }).collect()
}

/// A heading, which may be anybody's title, and rows of a name and a value, aligned.
pub fn table(heading: &str, rows: &[(impl AsRef<str>, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.as_ref().chars().count()).max().unwrap_or(0);
    let mut text = format!("{}\n", on_one_line(heading));
    for (name, value) in rows {
        let name = name.as_ref();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {name}{}  {value}", blanks(name, width));
    }
    text
}

/// A heading and rows below the names of columns: the first one to the left, the others to the right.
pub fn columns(heading: &str, names: &[&str], rows: &[Vec<String>]) -> String {
    let header: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    let lines = || std::iter::once(&header).chain(rows);
    let width = |column: usize| lines().filter_map(|line| line.get(column)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..names.len()).map(|column| width(column).unwrap_or(0)).collect();
    let line = |cells: &Vec<String>| {
        let cells = cells.iter().zip(&widths).enumerate().map(|(column, (cell, width))| match column {
            0 => format!("{cell}{}", blanks(cell, *width)),
            _ => format!("{}{cell}", blanks(cell, *width)),
        });
        format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    format!("{heading}\n{}", lines().map(line).collect::<String>())
}

/// Blanks that a text lacks to a width: of more than 65 535, which formats take, too.
fn blanks(text: &str, width: usize) -> String {
    " ".repeat(width.saturating_sub(text.chars().count()))
}

/// A heading and lines below it.
pub fn list(heading: &str, lines: &[String]) -> String {
    let lines: String = lines.iter().map(|line| format!("  {line}\n")).collect();
    format!("{heading}\n{lines}")
}

/// Lines of cells, those that need it in quotation marks, and those that a spreadsheet would compute marked as text.
pub fn csv_table<Line>(lines: impl IntoIterator<Item = Line>) -> String
where
    Line: IntoIterator,
    Line::Item: AsRef<str>,
{
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    for line in lines {
        // Writing to memory cannot fail.
        let _ = writer.write_record(line.into_iter().map(|text| cell(text.as_ref()).into_owned()));
    }
    String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
}

#[cfg(test)]
#[path = "../tests/unit/table.rs"]
mod tests;
