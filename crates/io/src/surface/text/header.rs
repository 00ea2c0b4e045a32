//! What stands before the numbers of a text file.

use super::cells::number;
use super::lengths::{length, length_unit, pitch, positive};
use super::names::Names;
use crate::delimited::Decimal;

/// What stands between a name and its value, and before another name.
const BEFORE_VALUES: [char; 3] = ['=', ':', '：'];
const BEFORE_NAMES: [char; 2] = [',', ';'];

/// What a header states.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Header {
    /// What the height 1 stands for, m.
    pub(super) unit: Option<f64>,
    /// What 1 stands for along x and y, m.
    pub(super) lateral_unit: Option<f64>,
    /// Distance of points along x and y, m.
    pub(super) pitch: Option<[f64; 2]>,
    /// Extent along x and y, m; every point stands for one pitch.
    pub(super) extent: [Option<f64>; 2],
    /// The same without their unit.
    pub(super) lengths: [Option<f64>; 2],
    /// The header is that of SPIP, whose lengths are in nm.
    pub(super) is_spip: bool,
    /// Columns and rows.
    pub(super) counts: [Option<u64>; 2],
    /// The names of the columns.
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
        // "h=305 w=75": several on a line.
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
        let number = || positive(number(value, decimal).ok());
        match name.to_lowercase().as_str() {
            // Written by digital holographic microscopes, beside a data unit of rad.
            "height conversion factor (-> m)" => self.unit = number(),
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
            "w" | "columns" | "x-pixels" => self.counts[0] = count(),
            "h" | "rows" | "y-pixels" => self.counts[1] = count(),
            // Written by SPIP; other programs give the unit of the lengths.
            "file format" => self.is_spip = value.eq_ignore_ascii_case("ascii"),
            "x-length" => self.lengths[0] = number(),
            "y-length" => self.lengths[1] = number(),
            "bit2nm" => self.unit = self.unit.or(number().map(|factor| factor * 1e-9)),
            _ => {}
        }
    }

    /// Distance of the points of a matrix, m.
    pub(super) fn matrix_pitch(&self, columns: usize, rows: usize) -> Option<[f64; 2]> {
        let unit = self.lateral_unit.or(self.is_spip.then_some(1e-9));
        let extent = |axis: usize| self.extent[axis].or_else(|| Some(self.lengths[axis]? * unit?));
        let from_extent = || Some([extent(0)? / columns as f64, extent(1)? / rows as f64]);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn header(lines: &[&str]) -> Header {
        let mut header = Header::default();
        let read = |(line, text): (usize, &&str)| assert!(header.read(line + 1, text, Decimal::Point), "{text}");
        lines.iter().enumerate().for_each(read);
        header
    }

    #[test]
    fn reads_german_headers() {
        let german = header(&["Einheit: µm", "Schrittweite: 20 um"]);
        assert_eq!((german.unit, german.pitch), (Some(1e-6), Some([2e-5; 2])));
        assert_eq!(header(&["Einheit: Mikrometer"]).unit, Some(1e-6));
        assert_eq!(header(&["Werteinheiten: nm", "Punktabstand = 5 um, 10 um"]).pitch, Some([5e-6, 1e-5]));
    }

    #[test]
    fn reads_several_names_on_a_line() {
        for line in ["# unit: um, pitch: 15 um", "unit = um; pitch = 15 um", "pitch: 15 um , unit: um"] {
            let found = header(&[line]);
            assert_eq!((found.unit, found.pitch), (Some(1e-6), Some([1.5e-5; 2])), "{line}");
        }
        let both = header(&["# pitch: 15 um, 20 um, unit: nm, of: sample 3, left"]);
        assert_eq!((both.unit, both.pitch), (Some(1e-9), Some([1.5e-5, 2e-5])));
        let mut german = Header::default();
        assert!(german.read(1, "Schrittweite: 1,5 um, Einheit: um", Decimal::Comma));
        assert_eq!((german.unit, german.pitch), (Some(1e-6), Some([1.5e-6; 2])));
        assert_eq!(header(&["size (x, y): 3 mm, made by: hand"]), Header::default());
        // A value may have a colon.
        assert_eq!(header(&["date: 12:30:05", "unit: um"]).unit, Some(1e-6));
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
        let german = header(&["# Kanal: Höhe", "# Breite: 30 µm", "# Höhe: 20.0 µm", "# Einheiten: nm"]);
        assert_eq!(german, gwyddion);
        let ours = header(&["# unit: um", "# pitch: 50 um, 25 um"]);
        assert_eq!((ours.unit, ours.pitch), (Some(1e-6), Some([50e-6, 25e-6])));
        assert_eq!(header(&["% pitch = 1 mm x 2 mm"]).pitch, Some([1e-3, 2e-3]));
        for nothing in ["unit: V", "unit: 0 m", "pitch = 5", "pitch = -5 um", "pitch=1 m, 2"] {
            assert_eq!(header(&[nothing]), Header::default(), "{nothing}");
        }
    }

    #[test]
    fn reads_the_header_of_spip() {
        let lines =
            ["# File Format = ASCII", "# x-pixels = 4", "# y-pixels = 3", "# x-length = 2000", "# y-length = 1500"];
        let spip = header(&[&lines[..], &["# z-unit = um", "# Start of Data:"]].concat());
        assert_eq!((spip.counts, spip.unit), ([Some(4), Some(3)], Some(1e-6)));
        assert_eq!(spip.matrix_pitch(4, 3), Some([2000.0 * 1e-9 / 4.0, 1500.0 * 1e-9 / 3.0]));
        assert_eq!(header(&[&lines[..], &["# Bit2nm = 0.5"]].concat()).unit, Some(0.5 * 1e-9));
        // Without the name of the format the unit has to be given.
        assert_eq!(header(&lines[1..]).matrix_pitch(4, 3), None);
        let stated = header(&[&lines[1..], &["# x-unit: um"]].concat());
        assert_eq!(stated.matrix_pitch(4, 3), Some([2000.0 * 1e-6 / 4.0, 1500.0 * 1e-6 / 3.0]));
    }

    #[test]
    fn numbers_are_those_of_the_file() {
        let read = |text: &str| {
            let mut header = Header::default();
            assert!(header.read(1, text, Decimal::Comma));
            header.pitch
        };
        assert_eq!(read("pitch: 0,5 um"), Some([0.5e-6; 2]));
        assert_eq!(read("pitch: 1,25 um; 2 um"), Some([1.25e-6, 2e-6]));
        assert_eq!(read("pitch: 1.25 um"), None);
    }
}
