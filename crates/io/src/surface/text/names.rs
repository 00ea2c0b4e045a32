//! The names of columns.

use super::lengths::{length_unit, unit_word};
use crate::delimited::Separator;

/// Columns of a table that are used, by their place in a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Columns {
    /// x, y and z of points of a surface.
    Points([usize; 3]),
    /// Distance along a profile, and height.
    Profile([usize; 2]),
}

/// The names of columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Names {
    /// Line that has them.
    pub(super) line: usize,
    /// How many there are.
    pub(super) count: usize,
    /// Which are coordinates and heights.
    pub(super) columns: Columns,
    /// Where 0 stands for points without a height.
    pub(super) valid: Option<usize>,
    /// What 1 stands for in each column, m.
    pub(super) units: Vec<Option<f64>>,
}

/// The columns by what is named in them.
const X: &[&str] = &["x", "lateral"];
const Y: &[&str] = &["y", "y1"];
const Z: &[&str] = &["z", "height", "höhe", "hoehe", "raw"];

impl Names {
    /// Reads names such as "x [um]; y [um]; z [nm]", or "x in µm, y in µm" of a profile; none if the columns of points or
    /// of a profile are not among them, each once.
    pub(super) fn read(line: usize, text: &str) -> Option<Self> {
        let text = text.replace(" [", "[").replace(" (", "(");
        let mut cells: Vec<&str> = Separator::of(&text).cells(&text, false).collect();
        while cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        let places = |wanted: &[&str]| -> Vec<usize> {
            (0..cells.len()).filter(|place| wanted.contains(&name(cells[*place]).as_str())).collect()
        };
        let columns = match (places(X).as_slice(), places(Y).as_slice(), places(Z).as_slice()) {
            (&[x], &[y], &[z]) => Columns::Points([x, y, z]),
            (&[x], [], &[z]) => Columns::Profile([x, z]),
            // A profile is often given as y over x.
            (&[x], &[y], []) => Columns::Profile([x, y]),
            _ => return None,
        };
        let valid = places(&["valid"]).first().copied();
        Some(Self { line, count: cells.len(), columns, valid, units: cells.iter().map(|cell| unit(cell)).collect() })
    }

    /// The first columns of a table that has no names.
    pub(super) fn first(line: usize, count: usize, columns: Columns) -> Self {
        Self { line, count, columns, valid: None, units: vec![None; count] }
    }

    /// Takes in a line of units below the names, such as "[mm];[mm];[um]"; tells whether it is one.
    pub(super) fn read_units(&mut self, text: &str) -> bool {
        let separator = Separator::of(text);
        let cells: Vec<&str> = separator.cells(text, false).take(self.count + 1).collect();
        let is_unit = |cell: &&str| bracketed(cell).is_some() || length_unit(cell).is_some() || cell.is_empty();
        let units: Vec<_> = cells.iter().map(|cell| length_unit(bracketed(cell).unwrap_or(cell))).collect();
        let fits = cells.len() == self.count && cells.iter().all(is_unit) && units.iter().any(Option::is_some);
        if fits {
            self.units = units;
        }
        fits
    }
}

/// What stands in brackets.
fn bracketed(cell: &str) -> Option<&str> {
    let inner = |open, close| cell.strip_prefix(open)?.strip_suffix(close);
    inner('[', ']').or_else(|| inner('(', ')'))
}

/// The first word of a name, in small letters.
fn name(cell: &str) -> String {
    let end = cell.find([' ', '_', '[', '(']).unwrap_or(cell.len());
    cell[..end].to_lowercase()
}

/// The unit in a name: in brackets, or the last word.
fn unit(cell: &str) -> Option<f64> {
    let rest = &cell[cell.find([' ', '_', '[', '('])?..];
    let rest = rest.trim_start_matches([' ', '_']);
    match bracketed(rest) {
        Some(unit) => length_unit(unit),
        None => rest.rsplit(' ').next().and_then(|word| unit_word(word.trim_matches(['[', ']', '(', ')']))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_names_of_columns() {
        let read = |text| Names::read(1, text).unwrap();
        let names = read("X [mm], Y [mm], Intensity, Z [nm]");
        assert_eq!((names.columns, names.count), (Columns::Points([0, 1, 3]), 4));
        assert_eq!(names.units, [Some(1e-3), Some(1e-3), None, Some(1e-9)]);
        assert_eq!(read("\"x (µm)\";\"y (µm)\";\"height\"").units, [Some(1e-6), Some(1e-6), None]);
        let german = read("X in mm; Y in mm; Hoehe in Mikrometer");
        assert_eq!(
            (german.columns, german.units),
            (Columns::Points([0, 1, 2]), vec![Some(1e-3), Some(1e-3), Some(1e-6)])
        );
        assert_eq!(read("x y z").columns, Columns::Points([0, 1, 2]));
        assert_eq!(read("X [mm] Y [mm] Z [um]").units, [Some(1e-3), Some(1e-3), Some(1e-6)]);
        assert_eq!(read("X\tY\tZ [2.9e-8 m]").units, [None, None, Some(2.9e-8)]);
        for none in ["x", "y z", "x y z z", "a b c", "xyz", "x x z", ""] {
            assert_eq!(Names::read(1, none), None, "{none}");
        }
    }

    #[test]
    fn reads_the_names_of_profiles() {
        let um = Some(1e-6);
        for (text, columns, units) in [
            ("x in µm,y in µm", [0, 1], vec![um, um]),
            ("index, x in µm,y in µm", [1, 2], vec![None, um, um]),
            ("X_(microns),y1", [0, 1], vec![um, None]),
            ("Lateral um,Raw Micrometer,", [0, 1], vec![um, um]),
            ("X;Y;valid", [0, 1], vec![None; 3]),
            ("x [mm]\tz [um]", [0, 1], vec![Some(1e-3), um]),
            ("x z", [0, 1], vec![None; 2]),
        ] {
            let names = Names::read(1, text).unwrap();
            assert_eq!((names.columns, names.units), (Columns::Profile(columns), units), "{text}");
        }
    }

    #[test]
    fn reads_a_line_of_units() {
        let mut names = Names::read(1, "X;Y;valid").unwrap();
        for other in ["8.6;106.6;1", "[mm];[mm]", "[1];[1];[1]", "a;b;c"] {
            assert!(!names.read_units(other), "{other}");
        }
        assert!(names.read_units("[mm];[um];[1/0]"));
        assert_eq!(names.units, [Some(1e-3), Some(1e-6), None]);
    }
}
