//! What stands before the numbers of a text file.

use crate::units::{self, Dimension};

/// What a header states.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Header {
    /// What the height 1 stands for, m.
    pub(super) unit: Option<f64>,
    /// Distance of points along x and y, m.
    pub(super) pitch: Option<[f64; 2]>,
    /// Extent along x and y, m; every point stands for one pitch.
    pub(super) extent: [Option<f64>; 2],
    /// Columns and rows.
    pub(super) counts: [Option<u64>; 2],
    /// The columns of a list.
    pub(super) names: Option<Names>,
}

/// The names of a list's columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Names {
    /// Line that has them.
    pub(super) line: usize,
    /// How many there are.
    pub(super) count: usize,
    /// Which are x, y and z.
    pub(super) columns: [usize; 3],
    /// What 1 stands for in x, y and z, m.
    pub(super) units: [Option<f64>; 3],
}

impl Header {
    /// Takes in a line, with or without its comment mark; tells whether it can be a line of a header.
    pub(super) fn read(&mut self, line: usize, text: &str) -> bool {
        let text = text.trim_start_matches(['#', '%']).trim();
        if let Some(names) = Names::read(line, text) {
            self.names = Some(names);
            return true;
        }
        // "h=305 w=75": several on a line.
        let words = || text.split_whitespace().map(|word| word.split_once('='));
        if words().all(|pair| pair.is_some_and(|(name, value)| !name.is_empty() && !value.is_empty())) {
            words().flatten().for_each(|(name, value)| self.fact(name, value));
            return !text.is_empty();
        }
        match text.split_once(['=', ':']) {
            Some((name, value)) if name.starts_with(char::is_alphabetic) => {
                self.fact(name.trim(), value.trim());
                true
            }
            _ => false,
        }
    }

    /// A name with its value. What is not known, or not understood, states nothing.
    fn fact(&mut self, name: &str, value: &str) {
        let count = || value.parse().ok();
        match name.to_lowercase().as_str() {
            // Written by digital holographic microscopes, beside a data unit of rad.
            "height conversion factor (-> m)" => self.unit = positive(value.parse().ok()),
            "unit" | "units" | "z unit" | "height unit" | "data unit" | "value units" => {
                self.unit = self.unit.or(length_unit(value));
            }
            "pitch" | "pixel size" => self.pitch = pitch(value),
            // Written by Gwyddion.
            "width" => self.extent[0] = length(value),
            "height" => self.extent[1] = length(value),
            "w" | "columns" => self.counts[0] = count(),
            "h" | "rows" => self.counts[1] = count(),
            _ => {}
        }
    }

    /// Distance of the points of a matrix, m.
    pub(super) fn matrix_pitch(&self, columns: usize, rows: usize) -> Option<[f64; 2]> {
        let extent = match self.extent {
            [Some(x), Some(y)] => Some([x / columns as f64, y / rows as f64]),
            _ => None,
        };
        self.pitch.or(extent)
    }
}

impl Names {
    /// Reads names such as "x [um]; y [um]; z [nm]"; none if x, y and z are not among them, each once.
    fn read(line: usize, text: &str) -> Option<Self> {
        let text = text.replace(" [", "[").replace(" (", "(");
        let cells: Vec<&str> = text.split([';', '\t', ',', ' ']).filter(|cell| !cell.is_empty()).collect();
        let parts = |cell: &str| {
            let (name, rest) = cell.split_once(['[', '(']).unwrap_or((cell, ""));
            (name.trim_matches('"').to_lowercase(), length_unit(rest.trim_end_matches(['"', ']', ')'])))
        };
        let find = |wanted: [&str; 2]| {
            let mut found = cells.iter().enumerate().filter(|(_, cell)| wanted.contains(&parts(cell).0.as_str()));
            match (found.next(), found.next()) {
                (Some((at, cell)), None) => Some((at, parts(cell).1)),
                _ => None,
            }
        };
        let [x, y, z] = [find(["x", "x"])?, find(["y", "y"])?, find(["z", "height"])?];
        Some(Self { line, count: cells.len(), columns: [x.0, y.0, z.0], units: [x.1, y.1, z.1] })
    }
}

fn positive(number: Option<f64>) -> Option<f64> {
    number.filter(|number| *number > 0.0 && number.is_finite())
}

fn length(text: &str) -> Option<f64> {
    positive(units::parse(text, Dimension::Length).ok())
}

/// A unit of length, or a length.
fn length_unit(text: &str) -> Option<f64> {
    length(text).or_else(|| length(&format!("1 {text}")))
}

/// One or two lengths, parted by a comma or "x".
fn pitch(text: &str) -> Option<[f64; 2]> {
    match text.split_once([',', 'x']) {
        Some((x, y)) => Some([length(x.trim())?, length(y.trim())?]),
        None => length(text).map(|pitch| [pitch; 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(lines: &[&str]) -> Header {
        let mut header = Header::default();
        lines.iter().enumerate().for_each(|(line, text)| assert!(header.read(line + 1, text), "{text}"));
        header
    }

    #[test]
    fn reads_what_programs_write() {
        // A digital holographic microscope (shared example B), Gwyddion, and ours.
        let holographic = header(&[
            "h=305 w=75",
            "pixel size=3.69862e-007 m",
            "data unit=rad",
            "height conversion factor (-> m)=2.91818e-008",
        ]);
        assert_eq!(holographic.unit, Some(2.91818e-8));
        assert_eq!(holographic.pitch, Some([3.69862e-7; 2]));
        assert_eq!(holographic.counts, [Some(75), Some(305)]);
        let gwyddion = header(&["# Channel: Height", "# Width: 30 µm", "# Height: 20.0 µm", "# Value units: nm"]);
        assert_eq!(gwyddion.matrix_pitch(300, 100), Some([30e-6 / 300.0, 20e-6 / 100.0]));
        assert_eq!(gwyddion.unit, Some(1e-9));
        let ours = header(&["# unit: um", "# pitch: 50 um, 25 um"]);
        assert_eq!((ours.unit, ours.pitch), (Some(1e-6), Some([50e-6, 25e-6])));
        assert_eq!(header(&["% pitch = 1 mm x 2 mm"]).pitch, Some([1e-3, 2e-3]));
        for nothing in ["unit: V", "unit: 0 m", "pitch = 5", "pitch = -5 um", "pitch=1 m, 2"] {
            assert_eq!(header(&[nothing]), Header::default(), "{nothing}");
        }
    }

    #[test]
    fn reads_the_names_of_columns() {
        let names = header(&["# X [mm], Y [mm], Intensity, Z [nm]"]).names.unwrap();
        assert_eq!((names.columns, names.count), ([0, 1, 3], 4));
        assert_eq!(names.units, [Some(1e-3), Some(1e-3), Some(1e-9)]);
        assert_eq!(header(&["\"x (µm)\";\"y (µm)\";\"height\""]).names.unwrap().units, [Some(1e-6), Some(1e-6), None]);
        for none in ["x y", "x y z z", "a b c", "xyz"] {
            assert_eq!(Names::read(1, none), None, "{none}");
        }
    }
}
