//! Colours.

use plotters::style::RGBColor;

/// Text and axes.
pub const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// Lines that help the eye.
pub const FAINT: RGBColor = RGBColor(0x9a, 0x9a, 0x9a);
/// What was not measured: in no colour of the map.
pub const MISSING: RGBColor = RGBColor(0xbd, 0xbd, 0xbd);
/// The data.
pub const DATA: RGBColor = RGBColor(0x31, 0x68, 0x8e);
/// Areas of the data.
pub const DATA_AREA: RGBColor = RGBColor(0x9d, 0xbf, 0xd6);
/// What is made out of the data.
pub const DERIVED: RGBColor = RGBColor(0xc4, 0x4e, 0x1c);
/// Areas of it.
pub const DERIVED_AREA: RGBColor = RGBColor(0xf4, 0xcd, 0xb6);

/// Colours of a range, from its least to its greatest value: all of them also told apart by people who are colour-blind, and in grey.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// From violet through green to yellow.
    #[default]
    Viridis,
    /// From blue through grey to yellow.
    Cividis,
    /// From black through red to pale yellow.
    Inferno,
    /// From black through purple to pale yellow.
    Magma,
    /// From blue through red to yellow.
    Plasma,
    /// From black to white.
    Greys,
}

impl ColourMap {
    /// Colour of a value from 0 to 1; what is beyond takes the colour of the end.
    pub fn colour(self, value: f64) -> RGBColor {
        let value = value.clamp(0.0, 1.0);
        let colour = match self {
            Self::Viridis => colorous::VIRIDIS.eval_continuous(value),
            Self::Cividis => colorous::CIVIDIS.eval_continuous(value),
            Self::Inferno => colorous::INFERNO.eval_continuous(value),
            Self::Magma => colorous::MAGMA.eval_continuous(value),
            Self::Plasma => colorous::PLASMA.eval_continuous(value),
            Self::Greys => colorous::GREYS.eval_continuous(1.0 - value),
        };
        RGBColor(colour.r, colour.g, colour.b)
    }

    /// So many that a byte tells which.
    pub fn colours(self) -> Vec<RGBColor> {
        (0..COLOURS).map(|colour| self.colour(colour as f64 / (COLOURS - 1) as f64)).collect()
    }
}

/// Colour of a value from 0 to 1 in the usual colour map.
pub fn viridis(value: f64) -> RGBColor {
    ColourMap::Viridis.colour(value)
}

/// Colours of a map, so few that a byte tells which.
pub const COLOURS: usize = 250;

/// The colours of the usual colour map.
pub fn colour_map() -> Vec<RGBColor> {
    ColourMap::Viridis.colours()
}

/// Which of the colours of a map a part of its range has, from 0 to 1; what is beyond takes the colour of the end.
pub fn colour_index(part: f64) -> u8 {
    (part.clamp(0.0, 1.0) * (COLOURS - 1) as f64).round() as u8
}

/// Where a ring has no cells.
pub const GROUND: RGBColor = RGBColor(0xff, 0xff, 0xff);

/// What a map shows as no part of its range.
pub const APART: RGBColor = RGBColor(0xe4, 0xe4, 0xe4);
/// The same beside a scale of greys.
pub const APART_OF_GREYS: RGBColor = RGBColor(0xbf, 0xdc, 0xf2);

/// Colours of what becomes of debris: on the disc, on the pin, out of the contact, in it.
pub const DEBRIS: [RGBColor; 4] =
    [RGBColor(0x00, 0x5a, 0x9c), RGBColor(0x8c, 0xc4, 0xe8), RGBColor(0xf0, 0xc3, 0x62), RGBColor(0xc4, 0x4e, 0x1c)];

/// Colours of none, primary and secondary: also told apart by people who are colour-blind, and in grey.
pub const STATUSES: [RGBColor; 3] =
    [RGBColor(0xe4, 0xe4, 0xe4), RGBColor(0x00, 0x5a, 0x9c), RGBColor(0xe6, 0x9f, 0x00)];

/// Colours of runs, also told apart by people who are colour-blind.
pub const RUNS: [RGBColor; 8] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x44, 0x44, 0x44),
    RGBColor(0x8c, 0x6b, 0x4f),
];

/// A colour mixed with white: 0 is white, 1 the colour itself.
pub fn paler(colour: RGBColor, part: f64) -> RGBColor {
    let mixed = |level: u8| (255.0 - part * (255.0 - f64::from(level))).round() as u8;
    RGBColor(mixed(colour.0), mixed(colour.1), mixed(colour.2))
}
