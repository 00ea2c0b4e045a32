//! Units in which people read a quantity.

use serde::Serialize;

/// A unit, and how many of it there are in one of the SI unit of a run file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReadingUnit {
    /// Its symbol; empty for a plain number.
    pub symbol: &'static str,
    /// How many of it there are in one SI unit.
    pub scale: f64,
}

impl ReadingUnit {
    /// A number, or a quantity whose unit is not known here.
    pub const NUMBER: Self = Self { symbol: "", scale: 1.0 };
    /// Heights.
    pub const HEIGHT: Self = Self { symbol: "µm", scale: 1e6 };
    /// Pressures.
    pub const PRESSURE: Self = Self { symbol: "MPa", scale: 1e-6 };

    /// The unit for a series of a run file: heights and displacements are micrometres, ways are metres.
    pub fn of_series(name: &str, unit: &str) -> Self {
        match unit {
            "m" if name.contains("distance") => Self { symbol: "m", scale: 1.0 },
            "m" => Self::HEIGHT,
            "m2" => Self { symbol: "mm²", scale: 1e6 },
            "m3" => Self { symbol: "mm³", scale: 1e9 },
            "m2 s" => Self { symbol: "mm² s", scale: 1e6 },
            "Pa" => Self::PRESSURE,
            "s" => Self { symbol: "s", scale: 1.0 },
            _ => Self::NUMBER,
        }
    }

    /// A number with this unit's symbol.
    pub fn with_symbol(&self, number: &str) -> String {
        if self.symbol.is_empty() { number.to_owned() } else { format!("{number} {}", self.symbol) }
    }
}
