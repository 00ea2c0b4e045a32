//! Text on standard output, tables in it, and tables as comma-separated values.

use std::fmt::Write as _;
use std::io::{self, Write as _};

use plateau_io::text::{cell, is_plain, shown};
use serde::Serialize;

use crate::failure::Failure;

/// Prints text on standard output. Text of others in it cannot do anything to the terminal.
///
/// # Errors
/// [`Failure::Run`] when standard output takes no more, unless the reader simply went away.
pub fn print(text: &str) -> Result<(), Failure> {
    printed(io::stdout().lock().write_all(shown(text).as_bytes()))
}

/// Prints one JSON document.
///
/// # Errors
/// As [`print()`].
pub fn print_json(document: &impl Serialize) -> Result<(), Failure> {
    print(&json(document)?)
}

/// One JSON document for people, with the end of its last line.
///
/// # Errors
/// [`Failure::Run`] when it cannot be written down.
pub fn json(document: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(document).map(|text| text + "\n").map_err(Failure::run)
}

/// Result of writing to standard output.
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
mod tests {
    use super::*;

    #[test]
    fn very_long_cells_are_aligned_too() {
        let rows = [vec!["x".repeat(70_000), "1".to_owned()], vec!["y".to_owned(), "2".to_owned()]];
        let text = columns("Sizes", &["name", "size"], &rows);
        assert!(text.lines().skip(1).all(|line| line.len() == 2 + 70_000 + 2 + 4), "{}", text.len());
        assert_eq!(table("Sizes", &[("x".repeat(70_000), "1".to_owned())]).len(), 6 + 2 + 70_000 + 4);
    }

    #[test]
    fn columns_are_aligned() {
        let rows =
            [vec!["a".to_owned(), "1 µm".to_owned(), "9".to_owned()], vec!["long".into(), "20".into(), String::new()]];
        assert_eq!(
            columns("Sizes", &["name", "size", "n"], &rows),
            "Sizes\n  name  size  n\n  a     1 µm  9\n  long    20\n"
        );
    }

    #[test]
    fn what_a_spreadsheet_would_compute_is_text() {
        assert_eq!(csv_table([["=1+1", "-1.5", "@a"]]), "'=1+1,-1.5,'@a\n");
    }

    #[test]
    fn cells_are_quoted_where_they_need_it() {
        assert_eq!(csv_table([["plain", "a, \"b\""], ["", "two\nlines"]]), "plain,\"a, \"\"b\"\"\"\n,\"two\nlines\"\n");
    }
}
