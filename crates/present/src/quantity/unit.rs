//! Units in which people read a quantity.

use std::borrow::Cow;
use std::ops::Range;

use serde::Serialize;

use plateau_io::number::raised;

/// A unit, and how many of it there are in the SI unit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Unit {
    /// Its symbol; empty for a plain number.
    pub symbol: Cow<'static, str>,
    /// How many of it there are in one SI unit.
    #[serde(rename = "scale")]
    pub per_si: f64,
    /// What 0 of the SI unit is in it: 0 but for degrees Celsius.
    #[serde(skip_serializing_if = "is_zero")]
    pub offset: f64,
}

/// Pages are told of offsets only where there is one. (What serde calls has the value by reference.)
fn is_zero(offset: &f64) -> bool {
    *offset == 0.0
}

/// The units of one kind of quantity.
struct Ladder {
    /// The SI unit, as run files write it.
    si: &'static str,
    /// From the smallest on, each with the size, SI, below which it is taken.
    units: &'static [(f64, Unit)],
    /// The one that serves where sizes are not known, or numbers of all sizes stand side by side.
    usual: Unit,
}

const ANY: f64 = f64::INFINITY;

static LADDERS: [Ladder; 14] = [
    Ladder {
        si: "m",
        units: &[(0.9e-6, unit("nm", 1e9)), (0.9e-3, Unit::MICROMETRE), (0.9, unit("mm", 1e3)), (ANY, Unit::METRE)],
        usual: Unit::MICROMETRE,
    },
    Ladder { si: "m2", units: &[(1e-9, unit("µm²", 1e12)), (ANY, Unit::MM2)], usual: Unit::MM2 },
    Ladder { si: "m3", units: &[(1e-13, unit("µm³", 1e18)), (ANY, Unit::MM3)], usual: Unit::MM3 },
    Ladder { si: "m2 s", units: &[(ANY, unit("mm² s", 1e6))], usual: unit("mm² s", 1e6) },
    Ladder {
        si: "Pa",
        units: &[(1e3, unit("Pa", 1.0)), (1e5, unit("kPa", 1e-3)), (ANY, Unit::MEGAPASCAL)],
        usual: Unit::MEGAPASCAL,
    },
    Ladder {
        si: "s",
        units: &[(0.1, unit("ms", 1e3)), (2e4, unit("s", 1.0)), (ANY, unit("h", 1.0 / 3600.0))],
        usual: unit("s", 1.0),
    },
    Ladder { si: "1", units: &[(ANY, Unit::NUMBER)], usual: Unit::NUMBER },
    Ladder { si: "K", units: &[(ANY, Unit::CELSIUS)], usual: Unit::CELSIUS },
    Ladder {
        si: "J",
        units: &[(0.9e3, unit("J", 1.0)), (0.9e6, Unit::KILOJOULE), (ANY, unit("MJ", 1e-6))],
        usual: Unit::KILOJOULE,
    },
    Ladder {
        si: "kg",
        units: &[
            (0.9e-9, unit("ng", 1e12)),
            (0.9e-6, Unit::MICROGRAM),
            (0.9e-3, unit("mg", 1e6)),
            (ANY, unit("g", 1e3)),
        ],
        usual: Unit::MICROGRAM,
    },
    // What leaves the contact in a time, or for a way of the vehicle.
    Ladder {
        si: "kg s-1",
        units: &[(0.9e-9, unit("ng/s", 1e12)), (0.9e-6, unit("µg/s", 1e9)), (ANY, unit("mg/s", 1e6))],
        usual: unit("µg/s", 1e9),
    },
    Ladder { si: "kg m-1", units: &[(0.09e-9, unit("µg/km", 1e12)), (ANY, Unit::MG_PER_KM)], usual: Unit::MG_PER_KM },
    Ladder { si: "s-1", units: &[(ANY, unit("s⁻¹", 1.0))], usual: unit("s⁻¹", 1.0) },
    Ladder { si: "m-1", units: &[(ANY, Unit::PER_KM)], usual: Unit::PER_KM },
];

/// Numbers of these sizes are read without a power of ten.
const PLAIN: Range<f64> = 0.01..1e5;

const fn unit(symbol: &'static str, per_si: f64) -> Unit {
    Unit { symbol: Cow::Borrowed(symbol), per_si, offset: 0.0 }
}

impl Unit {
    /// A plain number.
    pub const NUMBER: Self = unit("", 1.0);
    /// Per cent of 1.
    pub const PERCENT: Self = unit("%", 100.0);
    /// Metres.
    pub const METRE: Self = unit("m", 1.0);
    /// s.
    pub const SECOND: Self = unit("s", 1.0);
    /// Micrometres.
    pub const MICROMETRE: Self = unit("µm", 1e6);
    /// Square millimetres.
    pub const MM2: Self = unit("mm²", 1e6);
    /// Cubic millimetres.
    pub const MM3: Self = unit("mm³", 1e9);
    /// Megapascals.
    pub const MEGAPASCAL: Self = unit("MPa", 1e-6);
    /// Degrees Celsius, of a temperature: a difference of temperatures is in kelvins.
    pub const CELSIUS: Self = Self { symbol: Cow::Borrowed("°C"), per_si: 1.0, offset: -273.15 };
    /// Kilojoules.
    pub const KILOJOULE: Self = unit("kJ", 1e-3);
    /// Micrograms.
    pub const MICROGRAM: Self = unit("µg", 1e9);
    /// Milligrams for each kilometre.
    pub const MG_PER_KM: Self = unit("mg/km", 1e9);
    /// So many for each kilometre.
    pub const PER_KM: Self = unit("km⁻¹", 1e3);
    /// Newtons.
    pub const NEWTON: Self = unit("N", 1.0);
    /// Revolutions a minute, of an angular velocity.
    pub const RPM: Self = unit("rpm", 60.0 / std::f64::consts::TAU);
    /// Points of a grid whose distance is not known.
    pub const POINTS: Self = unit("points", 1.0);

    /// The unit in which a size, SI, is a number of few digits.
    pub fn for_size(si: &str, size: f64) -> Self {
        let Some(ladder) = ladder(si) else { return Self::itself(si) };
        let found = ladder.units.iter().find(|(below, _)| size < *below).or(ladder.units.last());
        found.map_or_else(|| ladder.usual.clone(), |(_, unit)| unit.clone())
    }

    /// All units in which a quantity of this SI unit is read.
    pub fn known(si: &str) -> Vec<Self> {
        ladder(si).map_or_else(Vec::new, |ladder| ladder.units.iter().map(|(_, unit)| unit.clone()).collect())
    }

    /// The unit for numbers of any size.
    pub fn usual(si: &str) -> Self {
        ladder(si).map_or_else(|| Self::itself(si), |ladder| ladder.usual.clone())
    }

    /// The unit for values up to a size, SI, with a power of ten where they are very large or small.
    pub fn readable(si: &str, largest: f64) -> Self {
        let found = Self::for_size(si, largest);
        let size = largest * found.per_si;
        let is_plain = PLAIN.contains(&size) || !(size > 0.0 && size.is_finite());
        if ladder(si).is_none() || found.offset != 0.0 || is_plain {
            return found;
        }
        let power = 3 * (size.log10() / 3.0).floor() as i32;
        let symbol = format!("10{} {}", raised(power), found.symbol).trim_end().to_owned();
        Self { symbol: symbol.into(), per_si: found.per_si * 10_f64.powi(-power), ..found }
    }

    /// An SI unit that has no other.
    fn itself(si: &str) -> Self {
        Self { symbol: si.to_owned().into(), per_si: 1.0, offset: 0.0 }
    }

    /// A value, SI, in this unit.
    pub fn value(&self, value: f64) -> f64 {
        value * self.per_si + self.offset
    }

    /// A difference of two values, SI, in this unit.
    pub fn difference(&self, difference: f64) -> f64 {
        difference * self.per_si
    }

    /// What an axis says: what it measures, and the unit.
    pub fn label(&self, what: &str) -> String {
        if self.symbol.is_empty() { what.to_owned() } else { format!("{what}, {}", self.symbol) }
    }

    /// A number with the unit behind it.
    pub fn with_symbol(&self, number: &str) -> String {
        // A power of ten is a factor of all that stands before it.
        if self.symbol.starts_with("10") {
            let number = if number.contains(' ') { format!("({number})") } else { number.to_owned() };
            return format!("{number}·{}", self.symbol);
        }
        format!("{number} {}", self.symbol).trim_end().to_owned()
    }
}

fn ladder(si: &str) -> Option<&'static Ladder> {
    LADDERS.iter().find(|ladder| ladder.si == si)
}

#[cfg(test)]
mod tests {
    use super::Unit;

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
            ("N", 2e9, "N", 2e9),
            ("K", 423.15, "°C", 150.0),
            ("J", 268.0, "J", 268.0),
            ("J", 126e3, "kJ", 126.0),
            ("J", 3.2e6, "MJ", 3.2),
            ("kg", 4e-10, "ng", 400.0),
            ("kg", 4e-7, "µg", 400.0),
            ("kg", 4e-4, "mg", 400.0),
            ("kg", 0.5, "g", 500.0),
            // 1 mg/h is 1e-6 kg in 3600 s.
            ("kg s-1", 1e-6 / 3600.0, "ng/s", 1e3 / 3.6),
            ("kg m-1", 4.5e-9, "mg/km", 4.5),
            ("kg m-1", 2e-11, "µg/km", 20.0),
            ("m-1", 6e6, "10⁹ km⁻¹", 6.0),
            ("s-1", 2.5e6, "10⁶ s⁻¹", 2.5),
        ] {
            let found = Unit::readable(unit, largest);
            assert_eq!(found.symbol, symbol, "{largest} {unit}");
            assert!((found.value(largest) - shown).abs() <= 1e-9 * shown, "{largest} {unit}");
        }
    }

    #[test]
    fn differences_of_temperatures_have_no_offset() {
        let celsius = Unit::usual("K");
        assert_eq!((celsius.value(273.15), celsius.difference(20.0)), (0.0, 20.0));
        // What pages without temperatures are told is as it was.
        assert_eq!(serde_json::to_string(&Unit::PERCENT).unwrap(), r#"{"symbol":"%","scale":100.0}"#);
        let told = serde_json::to_string(&celsius).unwrap();
        assert_eq!(told, r#"{"symbol":"°C","scale":1.0,"offset":-273.15}"#);
    }
}
