//! Header of a text file, which stands before its numbers: names with values, names of columns, units.

use crate::delimited::{Decimal, Separator};
use crate::units::{self, Dimension};

pub(super) fn positive(number: Option<f64>) -> Option<f64> {
    number.filter(|number| *number > 0.0 && number.is_finite())
}

/// A length, m.
pub(super) fn length(text: &str, decimal: Decimal) -> Option<f64> {
    let point = match decimal {
        Decimal::Point => text.to_owned(),
        Decimal::Comma if text.contains('.') => return None,
        Decimal::Comma => text.replacen(',', ".", 1),
    };
    positive(units::parse(&point, Dimension::Length).ok())
}

pub(super) fn length_unit(text: &str) -> Option<f64> {
    length(text, Decimal::Point).or_else(|| unit_word(text))
}

/// A unit of length by its symbol or name, also a German, French, Italian or Spanish one.
pub(super) fn unit_word(text: &str) -> Option<f64> {
    match text.to_lowercase().trim_end_matches('s') {
        "micron" | "micrometer" | "micrometre" | "mikrometer" | "micromètre" | "micrometro" | "micrómetro" => {
            Some(1e-6)
        }
        "nanometer" | "nanometre" | "nanomètre" | "nanometro" | "nanómetro" => Some(1e-9),
        "millimeter" | "millimetre" | "millimètre" | "millimetro" | "milímetro" => Some(1e-3),
        _ => length(&format!("1 {text}"), Decimal::Point),
    }
}

/// One or two lengths, parted by a comma (unless that is the decimal mark), a semicolon or "x".
pub(super) fn pitch(text: &str, decimal: Decimal) -> Option<[f64; 2]> {
    let marks: &[char] = if decimal == Decimal::Point { &[',', ';', 'x'] } else { &[';', 'x'] };
    match text.split_once(marks) {
        Some((x, y)) => Some([length(x.trim(), decimal)?, length(y.trim(), decimal)?]),
        None => length(text, decimal).map(|pitch| [pitch; 2]),
    }
}

/// Columns of a table that are used, by their place in a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Columns {
    /// x, y and z of points of a surface.
    Points([usize; 3]),
    /// Distance along a profile, and height.
    Profile([usize; 2]),
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Names {
    /// Line that has them.
    pub(super) line: usize,
    pub(super) count: usize,
    /// Columns that are coordinates and heights.
    pub(super) columns: Columns,
    /// Column in which 0 stands for points without a height.
    pub(super) valid: Option<usize>,
    /// Length that 1 stands for in each column, m.
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

/// Returns the text in the brackets of a cell, if it is in brackets.
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

/// Characters between a name and its value, and before another name.
const BEFORE_VALUES: [char; 3] = ['=', ':', '：'];
const BEFORE_NAMES: [char; 2] = [',', ';'];

#[derive(Debug, Default, PartialEq)]
pub(super) struct Header {
    /// Length that the height 1 stands for, m.
    pub(super) unit: Option<f64>,
    /// Length that 1 stands for along x and y, m.
    pub(super) lateral_unit: Option<f64>,
    /// Distance of points along x and y, m.
    pub(super) pitch: Option<[f64; 2]>,
    /// Extent along x and y, m; every point stands for one pitch.
    pub(super) extent: [Option<f64>; 2],
    /// Numbers of columns and rows.
    pub(super) counts: [Option<u64>; 2],
    pub(super) names: Option<Names>,
}

impl Header {
    /// Takes in a line, with or without its comment mark; tells whether it can be a line of a header.
    pub(super) fn read(&mut self, line: usize, text: &str, decimal: Decimal) -> bool {
        let text = text.trim_start_matches(['#', '%']).trim();
        if let Some(names) = Names::read(line, text) {
            self.names = Some(names);
            return true;
        }
        if self.names.as_mut().is_some_and(|names| names.read_units(text)) {
            return true;
        }
        // "rows=305 columns=75": several on a line.
        let words = || text.split_whitespace().map(|word| word.split_once('='));
        if words().all(|pair| pair.is_some_and(|(name, value)| !name.is_empty() && !value.is_empty())) {
            words().flatten().for_each(|(name, value)| self.fact(name, value, decimal));
            return !text.is_empty();
        }
        let found = pairs(text);
        found.iter().for_each(|(name, value)| self.fact(name, value, decimal));
        !found.is_empty()
    }

    /// A name with its value. What is not known, or not understood, states nothing.
    fn fact(&mut self, name: &str, value: &str, decimal: Decimal) {
        let count = || value.parse().ok();
        match name.to_lowercase().as_str() {
            "unit" | "units" | "z unit" | "z-unit" | "height unit" | "data unit" | "value units" | "einheit"
            | "einheiten" | "werteinheiten" | "z-einheit" | "unités" | "unità valore" | "unidades de valor"
            | "jednotky hodnot" => {
                self.unit = self.unit.or(length_unit(value));
            }
            "lateral units" | "x-unit" => self.lateral_unit = length_unit(value),
            "pitch" | "pixel size" | "spacing" | "schrittweite" | "punktabstand" | "pixelgröße" => {
                self.pitch = pitch(value, decimal)
            }
            // Written by Gwyddion, in the language of its user.
            "width" | "breite" | "largeur" | "larghezza" | "anchura" | "šířka" => {
                self.extent[0] = length(value, decimal)
            }
            "height" | "höhe" | "hoehe" | "hauteur" | "altezza" | "altura" | "výška" => {
                self.extent[1] = length(value, decimal)
            }
            "columns" => self.counts[0] = count(),
            "rows" => self.counts[1] = count(),
            _ => {}
        }
    }

    /// Distance of the points of a matrix, m.
    pub(super) fn matrix_pitch(&self, columns: usize, rows: usize) -> Option<[f64; 2]> {
        let from_extent = || Some([self.extent[0]? / columns as f64, self.extent[1]? / rows as f64]);
        self.pitch.or_else(from_extent)
    }
}

/// Names with their values, several on a line where a comma or a semicolon stands before the next name: "unit: um, pitch: 15 um, 20 um".
/// Empty if it is no such line.
fn pairs(text: &str) -> Vec<(&str, &str)> {
    let is_next = |at: &usize| text[at + 1..].split(BEFORE_NAMES).next().and_then(pair).is_some();
    let ends = text.match_indices(BEFORE_NAMES).map(|(at, _)| at).filter(is_next);
    let ends: Vec<usize> = ends.chain([text.len()]).collect();
    let starts = std::iter::once(0).chain(ends.iter().map(|end| end + 1));
    let several: Option<Vec<_>> = starts.zip(&ends).map(|(start, end)| pair(&text[start..*end])).collect();
    // A comma may be part of a name: "size (x, y): 3 mm".
    several.unwrap_or_else(|| pair(text).into_iter().collect())
}

/// A name with its value.
fn pair(text: &str) -> Option<(&str, &str)> {
    let (name, value) = text.split_once(BEFORE_VALUES)?;
    let name = name.trim();
    name.starts_with(char::is_alphabetic).then_some((name, value.trim()))
}
