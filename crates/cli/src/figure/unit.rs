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

    /// Counts instead of lengths.
    pub const POINTS: Self = Self { symbol: "points", per_metre: 1.0 };
}
