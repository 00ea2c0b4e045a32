//! Keyence VK and VR: a CSV file with quoted cells, a header of names and values, a line "Height" alone, and a matrix.
//!
//! The names of the header are in the language of the program; English and German ones are known (as the converter
//! matusm/Kcsv2Bcr, MIT licence, knows them). Points that were not measured are empty cells.

use super::named;
use crate::delimited::{Decimal, Separator, lines};
use crate::surface::options::ReadOptions;
use crate::surface::text::block;
use crate::surface::text::cells::{number, shown};
use crate::surface::text::dialect::Dialect;
use crate::surface::text::error::TextError;
use crate::surface::text::header::Header;
use crate::surface::text::lengths::{length_unit, positive};
use crate::surface::text::matrix;
use crate::surface::text::numbers::Numbers;
use crate::surface::text::table::Table;

/// Lines that a header has at most; it has some twenty.
const HEADER_LINES: usize = 100;

const PITCH: &[&str] = &["XY Calibration", "XY-Justierung"];
const COLUMNS: &[&str] = &["Horizontal", "Horizont."];
const ROWS: &[&str] = &["Vertical", "Vertikal"];
const UNIT: &[&str] = &["Unit", "Einheit"];
const HEIGHT: &[&str] = &["Height", "Höhe"];

/// Reads the heights; none if the text has no such header.
pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Option<Table>, TextError> {
    let mut facts: Vec<Vec<String>> = Vec::new();
    let mut data = lines(text);
    let title = loop {
        let Some((line, text)) = data.next().filter(|_| facts.len() < HEADER_LINES) else { return Ok(None) };
        let cells = cells(text);
        // What is written is named in a line of its own, below the header.
        if let [title] = cells.as_slice()
            && value(&facts, PITCH, 2).is_some()
        {
            break (line, title.clone());
        }
        facts.push(cells);
    };
    if !HEIGHT.contains(&title.1.as_str()) {
        return Err(TextError::NotHeights { line: title.0, found: shown(&title.1) });
    }
    let count = |names| value(&facts, names, 1).and_then(|count| count.parse().ok());
    let counts: [Option<u64>; 2] = [count(COLUMNS), count(ROWS)];
    let columns = counts[0].and_then(|count| usize::try_from(count).ok());
    let (range, several) = block::chosen(data.clone(), options)?;
    let data = data.filter(move |(line, _)| range.contains(line));
    if let Some(several) = several {
        return Err(several);
    }
    let dialect = Dialect::find(data.clone(), None, options.decimal, columns)?;
    let header = Header {
        unit: value(&facts, UNIT, 1).and_then(length_unit),
        pitch: pitch(&facts, dialect.decimal),
        counts,
        ..Header::default()
    };
    let numbers = Numbers::table(header, data, dialect)?;
    matrix::read(&numbers, options).map(|table| Some(named("Keyence CSV", table)))
}

/// The cells of a line of the header, in which blanks part nothing.
fn cells(line: &str) -> Vec<String> {
    match Separator::of(line) {
        Separator::Blanks => vec![line.trim().trim_matches('"').to_owned()],
        separator => separator.cells(line, false).map(str::to_owned).collect(),
    }
}

/// The cell at this place of the line that begins with one of the names.
fn value<'a>(facts: &'a [Vec<String>], names: &[&str], place: usize) -> Option<&'a str> {
    let line = facts.iter().find(|line| line.first().is_some_and(|name| names.contains(&name.as_str())))?;
    line.get(place).map(String::as_str)
}

/// The distance of the points, m.
fn pitch(facts: &[Vec<String>], decimal: Decimal) -> Option<[f64; 2]> {
    let distance = positive(number(value(facts, PITCH, 1)?, decimal).ok())?;
    Some([distance * length_unit(value(facts, PITCH, 2)?)?; 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(unit: &str, pitch: &str, title: &str, data: &str) -> String {
        format!(
            "\"Measured date\",\"2026-01-02\"\r\n\"Model\",\"VK-X3000 Series\"\r\n\"Data type\n\",\"ImageDataCsv\"\r\n\
             \"XY Calibration\",\"{pitch}\",\"um\"\r\n\"Output image data\",\"Height\"\r\n\"Horizontal\",\"3\"\r\n\
             \"Vertical\",\"2\"\r\n\"Unit\",\"{unit}\"\r\n\"Reference data name\",\"\"\r\n\r\n\"{title}\"\r\n{data}"
        )
    }

    #[test]
    fn reads_header_and_heights() {
        let german = file("µm", "0,5", "Höhe", "\"1,5\",\"2\",\"\"\r\n\"4\",\"5\",\"6\"\r\n")
            .replace("XY Calibration", "XY-Justierung")
            .replace("Horizontal", "Horizont.")
            .replace("Vertical", "Vertikal")
            .replace("\"Unit\"", "\"Einheit\"");
        for text in [
            file("um", "0.5", "Height", "1.5,2,\r\n4,5,6\r\n"),
            file("um", "0.5", "Height", "\"1.5\",\"2\",\"\"\r\n\"4\",\"5\",\"6\"\r\n"),
            german,
        ] {
            let table = read(&text, &ReadOptions::default()).unwrap().unwrap();
            assert_eq!((table.columns, table.rows, table.pitch), (3, 2, Some([0.5e-6; 2])));
            let um: Vec<f64> = table.heights.iter().map(|height| (height * 1e7).round() / 10.0).collect();
            assert_eq!(um[..4], [1.5, 4.0, 2.0, 5.0]);
            assert!(um[4].is_nan() && um[5] == 6.0);
            assert_eq!(table.notes[0], "Keyence CSV");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let error = |text: String| read(&text, &ReadOptions::default()).unwrap_err().to_string();
        let found = error(file("um", "0.5", "Laser intensity", "1,2,3\n4,5,6\n"));
        assert_eq!(found, "line 12: the file holds \"Laser intensity\", expected heights: export these");
        let found = error(file("um", "0.5", "Height", "1,2,3\n4,5,6\n7,8,9\n"));
        assert_eq!(found, "the header states 2 rows, but the file has 3");
        assert_eq!(error(file("um", "0.5", "Height", "")), "the file has no line of numbers");
        for other in ["1,2,3\n4,5,6\n", "Height\n1,2\n", "\"XY Calibration\",\"1\",\"um\"\n"] {
            assert!(read(other, &ReadOptions::default()).unwrap().is_none(), "{other}");
        }
    }
}
