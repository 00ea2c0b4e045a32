//! Wyko and Bruker Vision: the ASCII export of white-light interferometers (.asc), as SurfaceTopography 1.27.1 and
//! Gwyddion read it.
//!
//! Below the first line, of which the second number says whether heights are in nm or in wavelengths, stand blocks: name,
//! type, length and value, parted by tabs. Arrays have the type 3, no value, and `X Size` lines of `Y Size` numbers below:
//! each line is a column of the surface, y growing. Points that were not measured are `Bad`.

use super::named;
use crate::delimited::lines;
use crate::surface::options::{ReadOptions, agreed, agreed_pitch};
use crate::surface::text::cells::{number, shown};
use crate::surface::text::error::TextError;
use crate::surface::text::lengths::positive;
use crate::surface::text::numbers::scale;
use crate::surface::text::table::Table;

/// How a file begins.
pub(super) const MAGIC: &str = "Wyko ASCII Data File Format";

/// Arrays of heights; others are intensities and the like.
const HEIGHTS: &[&str] = &["RAW_DATA", "RAW DATA", "OPD", "SAMPLE_DATA", "Raw"];

/// What stands before the heights.
#[derive(Debug)]
struct Facts {
    /// Heights are in nm.
    real_units: bool,
    /// Points along x and y.
    size: [Option<usize>; 2],
    /// Distance of points along x, m.
    pixel: Option<f64>,
    /// Distance along y over that along x.
    aspect: f64,
    /// Wavelength, m.
    wavelength: Option<f64>,
    /// Heights in wavelengths are multiplied by this.
    multiplier: f64,
}

/// Reads the first array of heights.
pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Table, TextError> {
    let mut lines = lines(text);
    let mut facts =
        Facts { real_units: false, size: [None; 2], pixel: None, aspect: 1.0, wavelength: None, multiplier: 1.0 };
    if let Some((_, first)) = lines.next() {
        let flags = first.trim_start().trim_start_matches(MAGIC);
        facts.real_units = flags.split_whitespace().nth(1).is_some_and(|flag| flag != "0");
    }
    while let Some((line, text)) = lines.next() {
        let cells: Vec<&str> = text.split('\t').map(str::trim).collect();
        let [name, "3", _, ..] = cells.as_slice() else {
            facts.take(&cells, options);
            continue;
        };
        let [Some(columns), Some(rows)] = facts.size else {
            let expected = "lines \"X Size\" and \"Y Size\" above the heights";
            return Err(TextError::Header { line, found: shown(text), expected });
        };
        if !HEIGHTS.contains(name) {
            // Skipped one by one: a size is only a promise.
            if columns > 0 {
                lines.nth(columns - 1);
            }
            continue;
        }
        let heights = array(&mut lines, [columns, rows], options)?;
        return facts.table(heights, [columns, rows], line, options).map(|table| named("Wyko ASCII", table));
    }
    Err(TextError::NoNumbers)
}

/// An array, line by line.
fn array<'a>(
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
    [columns, rows]: [usize; 2],
    options: &ReadOptions,
) -> Result<Vec<f64>, TextError> {
    let mut heights = Vec::new();
    let mut read = 0;
    for (line, text) in lines.take(columns) {
        let before = heights.len();
        for (column, cell) in text.split_whitespace().enumerate() {
            let height = number(cell, options.decimal.unwrap_or_default());
            heights.push(height.map_err(|fault| fault.at(line, column + 1, cell))?);
        }
        let found = heights.len() - before;
        if found != rows {
            return Err(TextError::Count { what: "numbers a line (Y Size)", expected: rows as u64, found });
        }
        read += 1;
    }
    if read != columns || heights.is_empty() {
        return Err(TextError::Count { what: "lines of heights (X Size)", expected: columns as u64, found: read });
    }
    Ok(heights)
}

impl Facts {
    fn take(&mut self, cells: &[&str], options: &ReadOptions) {
        let text = |place: usize| cells.get(place).copied().unwrap_or_default();
        let value = || positive(number(text(3), options.decimal.unwrap_or_default()).ok());
        match text(0) {
            "X Size" => self.size[0] = text(1).parse().ok(),
            "Y Size" => self.size[1] = text(1).parse().ok(),
            "Pixel_size" => self.pixel = value().map(|millimetres| millimetres * 1e-3),
            "Aspect" => self.aspect = value().unwrap_or(1.0),
            "Wavelength" => self.wavelength = value().map(|nanometres| nanometres * 1e-9),
            "Mult" => self.multiplier = value().unwrap_or(1.0),
            _ => {}
        }
    }

    fn table(
        &self,
        mut heights: Vec<f64>,
        [columns, rows]: [usize; 2],
        line: usize,
        options: &ReadOptions,
    ) -> Result<Table, TextError> {
        let stated = if self.real_units { Some(1e-9) } else { self.wavelength.map(|wave| wave / self.multiplier) };
        let unit = agreed("unit", stated, options.unit)?.ok_or(TextError::NoUnit)?;
        let pitch = agreed_pitch(self.pixel.map(|pixel| [pixel, pixel * self.aspect]), options.pitch)?;
        scale(&mut heights, unit, line)?;
        let notes = vec![format!("1 stands for {unit:e} m")];
        Ok(Table { columns, rows, pitch, heights, notes, ..Table::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example by which SurfaceTopography 1.27.1 tests its reader: 4 x 3 points, one of them bad.
    fn file(real_units: u8) -> String {
        format!(
            "Wyko ASCII Data File Format 0\t{real_units}\t1\nX Size\t4\nY Size\t3\nBlock Name\tType\tLength\tValue\n\
             Pixel_size\t7\t4\t0.002\nWavelength\t7\t4\t632.8\nMult\t7\t4\t2\nIntensity\t3\t48\t\n1\t2\t3\n1\t2\t3\n1\t2\t3\n\
             1\t2\t3\nRAW_DATA\t3\t48\t\n1\t2\t3\n4\tBad\t6\n7\t8\t9\n10\t11\t12\nTrailer\t5\t4\tx\n"
        )
    }

    #[test]
    fn heights_are_in_nm_or_in_wavelengths() {
        for (real_units, unit) in [(1, 1e-9), (0, 632.8e-9 / 2.0)] {
            let table = read(&file(real_units), &ReadOptions::default()).unwrap();
            assert_eq!((table.columns, table.rows, table.pitch), (4, 3, Some([2e-6; 2])));
            for (at, height) in table.heights.iter().enumerate() {
                let expected = (at + 1) as f64 * unit;
                assert!(
                    if at == 4 { height.is_nan() } else { (height / expected - 1.0).abs() < 1e-15 },
                    "{at}: {height}"
                );
            }
        }
        let aspect = file(1).replace("Mult\t", "Aspect\t");
        assert_eq!(read(&aspect, &ReadOptions::default()).unwrap().pitch, Some([2e-6, 4e-6]));
    }

    #[test]
    fn what_is_not_there_is_told() {
        let error = |text: &str| read(text, &ReadOptions::default()).unwrap_err().to_string();
        let text = file(0);
        assert_eq!(error(&text.replace("Y Size\t3\n", "")).split(':').next(), Some("line 7"));
        assert!(
            error(&text.replace("Wavelength", "Wave")).starts_with("the file does not say the unit of its heights")
        );
        assert_eq!(
            error(&text.replace("X Size\t4", "X Size\t99999999999")),
            "the file has no line of numbers",
            "the intensities take all lines"
        );
        let cut = &text[..text.find("10\t11").unwrap()];
        assert_eq!(error(cut), "the header states 4 lines of heights (X Size), but the file has 3");
        assert_eq!(
            error(&text.replace("4\tBad\t6", "4\t6")),
            "the header states 3 numbers a line (Y Size), but the file has 2"
        );
        assert!(error(&text.replace("Bad", "worse")).starts_with("line 15, column 2: found \"worse\""));
        assert!(
            error(&text.replace("X Size\t4", "X Size\t0").replace("Intensity", "RAW_DATA"))
                .starts_with("the header states 0")
        );
    }
}
