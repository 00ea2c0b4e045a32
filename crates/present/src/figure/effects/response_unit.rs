//! Units in which responses are shown.

use crate::figure::ticks::raised;
use crate::figure::unit::{AxisUnit, ScaledUnit};

/// Numbers of these sizes are read without a power of ten.
const PLAIN: std::ops::Range<f64> = 0.01..1e5;

/// A unit, and how many of it there are in the SI unit.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseUnit {
    /// Its symbol, with a power of ten where numbers are very large or small; empty for plain numbers.
    pub symbol: String,
    /// Units in the SI unit.
    pub per_si: f64,
}

impl ResponseUnit {
    /// The unit for values up to a size, both in this SI unit as run files write it.
    pub fn new(si_unit: &str, largest: f64) -> Self {
        let (symbol, per_si) = match si_unit {
            "m" => {
                let AxisUnit { symbol, per_metre } = AxisUnit::for_length(largest);
                (symbol, per_metre)
            }
            "m2" => of(ScaledUnit::for_area(largest)),
            "m3" => of(ScaledUnit::for_volume(largest)),
            "m2 s" => ("mm² s", 1e6),
            "Pa" => of(ScaledUnit::for_pressure(largest)),
            "s" => of(ScaledUnit::for_time(largest)),
            "1" => ("", 1.0),
            _ => return Self { symbol: si_unit.to_owned(), per_si: 1.0 },
        };
        let size = largest * per_si;
        if PLAIN.contains(&size) || !(size > 0.0 && size.is_finite()) {
            return Self { symbol: symbol.to_owned(), per_si };
        }
        let power = 3 * (size.log10() / 3.0).floor() as i32;
        let symbol = format!("10{} {symbol}", raised(power)).trim_end().to_owned();
        Self { symbol, per_si: per_si * 10_f64.powi(-power) }
    }

    /// A value in SI units in this one.
    pub fn value(&self, value: f64) -> f64 {
        value * self.per_si
    }

    /// What an axis says: what it measures, and the unit.
    pub fn label(&self, what: &str) -> String {
        if self.symbol.is_empty() { what.to_owned() } else { format!("{what}, {}", self.symbol) }
    }

    /// A number with the unit behind it.
    pub fn with_symbol(&self, number: &str) -> String {
        format!("{number} {}", self.symbol).trim_end().to_owned()
    }
}

fn of(unit: ScaledUnit) -> (&'static str, f64) {
    (unit.symbol, unit.per_si)
}

#[cfg(test)]
mod tests {
    use super::ResponseUnit;

    #[test]
    fn numbers_are_of_a_readable_size() {
        for (unit, largest, symbol, shown) in [
            ("m2", 2.5e-5, "mm²", 25.0),
            ("m3", 3e-15, "µm³", 3000.0),
            ("m", 4e-7, "nm", 400.0),
            ("1", 0.4, "", 0.4),
            ("1", 3e-13, "10⁻¹⁵", 300.0),
            ("m3", 2e-18, "µm³", 2.0),
            ("m3", 2e-21, "10⁻³ µm³", 2.0),
            ("s", 60.0, "s", 60.0),
            ("1", 0.0, "", 0.0),
        ] {
            let found = ResponseUnit::new(unit, largest);
            assert_eq!(found.symbol, symbol, "{largest} {unit}");
            assert!((found.value(largest) - shown).abs() <= 1e-9 * shown, "{largest} {unit}");
        }
    }
}
