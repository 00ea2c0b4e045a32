//! Zygo MetroPro and Mx: the text exports "XYZ" (points in um) and "ASCII" (phases), after the header that the MetroPro
//! Reference Guide (OMP-0347, section 12) describes and prysm writes.
//!
//! Line 4 has origin and size of the heights in pixels, line 8 the scale factor, the wavelength, the obliquity factor and
//! the size of a pixel in m, line 11 the resolution of phases. Lines of "#" part header, intensities and heights.

use super::named;
use crate::delimited::{Decimal, lines};
use crate::surface::options::{ReadOptions, agreed, agreed_pitch};
use crate::surface::text::cells::{number, shown};
use crate::surface::text::error::TextError;
use crate::surface::text::lengths::positive;
use crate::surface::text::numbers::scale;
use crate::surface::text::table::Table;

/// How a file of points begins.
pub(super) const POINTS: &str = "Zygo XYZ Data File";
/// How a file of phases begins.
pub(super) const PHASES: &str = "Zygo ASCII Data File";

/// Phases from this on were not measured.
const NO_PHASE: f64 = 2_147_483_640.0;

/// A list fills at least one in so many points of the size that the header states.
const SPARSEST: usize = 16;

/// What the header states.
struct Header {
    origin: [f64; 2],
    size: [usize; 2],
    /// Distance of points, m.
    pixel: Option<f64>,
    /// What the phase 1 stands for, m.
    phase_unit: Option<f64>,
}

impl Header {
    /// Takes the lines of the header and the "#" that ends it.
    fn read<'a>(lines: &mut impl Iterator<Item = (usize, &'a str)>) -> Result<Self, TextError> {
        let numbers = |text: &str| -> Vec<f64> {
            text.split_whitespace().map_while(|word| number(word, Decimal::Point).ok()).collect()
        };
        let mut rectangle = None;
        let (mut optics, mut resolution) = (Vec::new(), None);
        for (line, text) in lines.by_ref().take_while(|(_, text)| text.trim() != "#") {
            match line {
                4 => rectangle = Some(rectangle_of(line, text, &numbers(text))?),
                8 => optics = numbers(text),
                11 => resolution = numbers(text).first().copied(),
                _ => {}
            }
        }
        let Some((origin, size)) = rectangle else {
            return Err(TextError::Header { line: 4, found: String::new(), expected: RECTANGLE });
        };
        let steps = [4096.0, 32768.0, 131_072.0];
        let steps = resolution.and_then(|code| steps.get(code as usize).filter(|_| code.fract() == 0.0 && code >= 0.0));
        let phase_unit = match (optics.as_slice(), steps) {
            ([_, factor, wavelength, _, obliquity, ..], Some(steps)) => {
                positive(Some(factor * wavelength * obliquity / steps))
            }
            _ => None,
        };
        Ok(Self { origin, size, pixel: positive(optics.get(6).copied()), phase_unit })
    }

    fn table(&self, heights: Vec<f64>, notes: Vec<String>, options: &ReadOptions) -> Result<Table, TextError> {
        let [columns, rows] = self.size;
        let pitch = agreed_pitch(self.pixel.map(|pixel| [pixel; 2]), options.pitch)?;
        Ok(Table { columns, rows, pitch, heights, notes, ..Table::default() })
    }
}

const RECTANGLE: &str = "origin and size of the heights: four whole numbers";

/// Origin and size of the heights.
fn rectangle_of(line: usize, text: &str, numbers: &[f64]) -> Result<([f64; 2], [usize; 2]), TextError> {
    /// Pixels of a side, at most.
    const LONGEST: f64 = 1e6;
    let is_size = |size: f64| (1.0..=LONGEST).contains(&size) && size.fract() == 0.0;
    match *numbers {
        [x, y, width, height, ..] if is_size(width) && is_size(height) => {
            Ok(([x, y], [width as usize, height as usize]))
        }
        _ => Err(TextError::Header { line, found: shown(text.trim()), expected: RECTANGLE }),
    }
}

/// A list of points: column and row of the pixel, and a height in um or "No Data".
pub(super) fn points(text: &str, options: &ReadOptions) -> Result<Table, TextError> {
    let mut lines = lines(text);
    let header = Header::read(&mut lines)?;
    let mut points = Vec::new();
    for (line, text) in lines.take_while(|(_, text)| text.trim() != "#") {
        let mut words = text.split_whitespace();
        let mut coordinate = |column: usize| {
            let word = words.next().unwrap_or_default();
            let found = number(word, Decimal::Point).ok().filter(|number| number.fract() == 0.0);
            found.ok_or_else(|| TextError::Number { line, column, found: shown(word) })
        };
        let place = [coordinate(1)?, coordinate(2)?];
        let rest = words.collect::<Vec<_>>().join(" ");
        let height = number(&rest, options.decimal.unwrap_or_default()).map_err(|fault| fault.at(line, 3, &rest))?;
        points.push((line, place, height));
    }
    let mut heights = on_grid(&header, &points)?;
    let first = points.first().map_or(1, |(line, ..)| *line);
    let unit = options.unit.unwrap_or(1e-6);
    scale(&mut heights, unit, first)?;
    let mut table = header.table(heights, vec![format!("1 stands for {unit:e} m")], options)?;
    if options.unit.is_none() {
        let warning = "heights taken as um, as the format has it; the program can write other units without saying so: \
                       unit = \"um\" (or another) below file in the scene says which";
        table.warnings.push(warning.to_owned());
    }
    Ok(named("Zygo XYZ", table))
}

/// The heights of points, column by column.
fn on_grid(header: &Header, points: &[(usize, [f64; 2], f64)]) -> Result<Vec<f64>, TextError> {
    let [columns, rows] = header.size;
    let places = columns.saturating_mul(rows);
    if points.is_empty() {
        return Err(TextError::NoNumbers);
    }
    if places > points.len().saturating_mul(SPARSEST) {
        return Err(TextError::Sparse { points: points.len(), grid: (columns, rows) });
    }
    // Pixels are counted from the origin, or from that of the camera.
    let outside = |origin: [f64; 2]| {
        let inside = |place: f64, origin: f64, size: usize| place >= origin && place < origin + size as f64;
        points.iter().find(|(_, [x, y], _)| !(inside(*x, origin[0], columns) && inside(*y, origin[1], rows)))
    };
    let origin = if outside(header.origin).is_none() { header.origin } else { [0.0; 2] };
    if let Some((line, [x, y], _)) = outside(origin) {
        return Err(TextError::Outside { line: *line, found: [*x, *y], size: (columns, rows) });
    }
    let mut heights = vec![f64::NAN; places];
    let mut lines = vec![0; places];
    for (line, [x, y], height) in points {
        let at = (x - origin[0]) as usize * rows + (y - origin[1]) as usize;
        if lines[at] != 0 {
            return Err(TextError::Twice { line: *line, first: lines[at] });
        }
        (lines[at], heights[at]) = (*line, *height);
    }
    Ok(heights)
}

/// Phases as whole numbers, row by row, below the intensities.
pub(super) fn phases(text: &str, options: &ReadOptions) -> Result<Table, TextError> {
    let mut lines = lines(text);
    let header = Header::read(&mut lines)?;
    let unit = agreed("unit", header.phase_unit, options.unit)?.ok_or(TextError::NoUnit)?;
    lines.by_ref().take_while(|(_, text)| text.trim() != "#").for_each(drop);
    let mut phases = Vec::new();
    let mut first = None;
    for (line, text) in lines.take_while(|(_, text)| text.trim() != "#") {
        first.get_or_insert(line);
        for (column, word) in text.split_whitespace().enumerate() {
            let phase = number(word, Decimal::Point).map_err(|fault| fault.at(line, column + 1, word))?;
            phases.push(if phase >= NO_PHASE { f64::NAN } else { phase });
        }
    }
    let [columns, rows] = header.size;
    if columns.checked_mul(rows) != Some(phases.len()) {
        let expected = (columns as u64).saturating_mul(rows as u64);
        return Err(TextError::Count { what: "phases", expected, found: phases.len() });
    }
    let mut heights = Vec::with_capacity(phases.len());
    for column in 0..columns {
        heights.extend(phases.iter().skip(column).step_by(columns));
    }
    scale(&mut heights, unit, first.unwrap_or(1))?;
    let notes = vec![format!("1 stands for {unit:e} m")];
    header.table(heights, notes, options).map(|table| named("Zygo ASCII", table))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(form: &str, origin: &str) -> String {
        format!(
            "{form} - Format\n0 0 0 0 \"Mon Jan 05 10:00:00 2026\"\n0 0 0 0 0 0\n{origin} 3 2\n\"\"\n\"\"\n\"\"\n\
             0 0.5 6.328e-07 0 1 0 2.5e-06 1767607200\n3 2 0 0 0 0 \"\"\n0 0 0 0 0 0 0 0 0 0\n1 1 20 2 0 0 0 0 0\n0 \"\"\n1 0\n"
        )
    }

    #[test]
    fn points_are_in_um_unless_the_scene_says_otherwise() {
        let data = "#\n10 20 No Data\n11\t20\t2.0\n12   20   3.0\n10 21 4.0\n11 21 5.0\n12 21 6.5\n#\n";
        for origin in ["10 20", "0 0"] {
            let mut text = header(POINTS, origin) + data;
            if origin == "0 0" {
                text = text
                    .replace("\n10 2", "\n0 2")
                    .replace("\n11 2", "\n1 2")
                    .replace("\n11\t2", "\n1\t2")
                    .replace("\n12 ", "\n2 ");
                text = text.replace(" 20 ", " 0 ").replace("\t20\t", "\t0\t").replace(" 21 ", " 1 ");
            }
            let table = points(&text, &ReadOptions::default()).unwrap();
            assert_eq!((table.columns, table.rows, table.pitch), (3, 2, Some([2.5e-6; 2])), "{text}");
            assert!(table.heights[0].is_nan());
            let um: Vec<f64> = table.heights[1..].iter().map(|height| (height * 1e7).round() / 10.0).collect();
            assert_eq!(um, [4.0, 2.0, 5.0, 3.0, 6.5]);
            assert_eq!(table.warnings.len(), 1);
            let nm = points(&text, &ReadOptions { unit: Some(1e-9), ..ReadOptions::default() }).unwrap();
            assert_eq!((nm.heights[5], nm.warnings.len()), (6.5 * 1e-9, 0));
        }
    }

    #[test]
    fn phases_are_parts_of_the_wavelength() {
        let text = header(PHASES, "0 0") + "\"\"\n#\n7 7 7\n#\n32768 -16384 2147483640 \n0 1 65536 \n#\n";
        let table = phases(&text, &ReadOptions::default()).unwrap();
        assert_eq!((table.columns, table.rows, table.pitch), (3, 2, Some([2.5e-6; 2])));
        assert!(table.heights[4].is_nan());
        // Half of the wavelength for the phase 32768, with the scale factor 0.5.
        let half = 0.5 * 6.328e-7;
        for (at, phase) in [(0, 1.0), (1, 0.0), (2, -0.5), (3, 1.0 / 32768.0), (5, 2.0)] {
            assert!((table.heights[at] - phase * half).abs() <= 4.0 * f64::EPSILON * half * phase.abs(), "{at}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let error = |text: &str| {
            let read = if text.starts_with(POINTS) { points } else { phases };
            read(text, &ReadOptions::default()).unwrap_err().to_string()
        };
        let list = |data: &str| error(&(header(POINTS, "0 0") + "#\n" + data));
        assert_eq!(list(""), "the file has no line of numbers");
        assert!(list("0 0 1\n3 0 1\n").starts_with("line 16: the point 3, 0 lies outside of the 3 x 2 points"));
        assert_eq!(list("0 0 1\n0 0 1\n"), "line 16 has the same x and y as line 15");
        assert!(list("0 0 1\n0 x 1\n").starts_with("line 16, column 2: found \"x\""));
        assert!(list("0 0 No\n").starts_with("line 15, column 3: found \"No\""));
        let large = header(POINTS, "0 0").replace("0 0 3 2", "0 0 999999 999999") + "#\n0 0 1\n";
        assert!(error(&large).starts_with("the 1 points lie on a grid of 999999 x 999999"));
        let wrong = header(POINTS, "0 0").replace("0 0 3 2", "0 0 3");
        assert_eq!(
            error(&wrong),
            "line 4: found \"0 0 3\", expected origin and size of the heights: four whole numbers"
        );
        let short = header(PHASES, "0 0") + "#\n#\n1 2 3 4 5\n#\n";
        assert_eq!(error(&short), "the header states 6 phases, but the file has 5");
        let unitless = (header(PHASES, "0 0") + "#\n#\n1 2 3 4 5 6\n#\n").replace("6.328e-07", "0");
        assert!(error(&unitless).starts_with("the file does not say the unit of its heights"));
        assert!(error(POINTS).starts_with("line 4: found \"\", expected origin"));
    }
}
