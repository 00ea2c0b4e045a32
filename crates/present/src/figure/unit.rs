//! Units of axes.

/// A unit of length, and how many there are in a metre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisUnit {
    /// Its symbol.
    pub symbol: &'static str,
    /// Units in a metre.
    pub per_metre: f64,
}

impl AxisUnit {
    /// The unit in which a length of this size, m, is a number of one to three digits before the point.
    pub fn for_length(size: f64) -> Self {
        let (symbol, per_metre) = match size {
            size if size < 0.9e-6 => ("nm", 1e9),
            size if size < 0.9e-3 => ("µm", 1e6),
            size if size < 0.9 => ("mm", 1e3),
            _ => ("m", 1.0),
        };
        Self { symbol, per_metre }
    }

    /// Micrometres.
    pub const MICROMETRE: Self = Self { symbol: "µm", per_metre: 1e6 };

    /// Counts instead of lengths.
    pub const POINTS: Self = Self { symbol: "points", per_metre: 1.0 };
}

/// A unit of another quantity than length, and how many there are in the SI unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaledUnit {
    /// Its symbol.
    pub symbol: &'static str,
    /// Units in the SI unit.
    pub per_si: f64,
}

impl ScaledUnit {
    /// Per cent of 1.
    pub const PERCENT: Self = Self { symbol: "%", per_si: 100.0 };

    /// Seconds.
    pub const SECOND: Self = Self { symbol: "s", per_si: 1.0 };

    /// For areas up to this, m².
    pub fn for_area(size: f64) -> Self {
        if size < 1e-9 { Self { symbol: "µm²", per_si: 1e12 } } else { Self { symbol: "mm²", per_si: 1e6 } }
    }

    /// For volumes up to this, m³.
    pub fn for_volume(size: f64) -> Self {
        if size < 1e-13 { Self { symbol: "µm³", per_si: 1e18 } } else { Self { symbol: "mm³", per_si: 1e9 } }
    }

    /// For pressures up to this, Pa.
    pub fn for_pressure(size: f64) -> Self {
        match size {
            size if size < 1e3 => Self { symbol: "Pa", per_si: 1.0 },
            size if size < 1e5 => Self { symbol: "kPa", per_si: 1e-3 },
            _ => Self { symbol: "MPa", per_si: 1e-6 },
        }
    }

    /// For times up to this, s.
    pub fn for_time(size: f64) -> Self {
        match size {
            size if size < 0.1 => Self { symbol: "ms", per_si: 1e3 },
            size if size < 2e4 => Self { symbol: "s", per_si: 1.0 },
            _ => Self { symbol: "h", per_si: 1.0 / 3600.0 },
        }
    }
}
