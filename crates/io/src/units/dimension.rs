//! The kinds of quantity that scenes ask for: what each is made of, and how people write it.

use std::fmt;

use super::expression::Powers;

/// The kinds of quantity that scenes ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// m.
    Length,
    /// N.
    Force,
    /// Pa: pressures and elastic moduli.
    Pressure,
    /// s.
    Time,
    /// m/s.
    Speed,
    /// rad/s.
    RotationalSpeed,
    /// N m, which is a joule by its powers.
    Torque,
    /// 1/Pa = m³/(N·m): worn volume per force and sliding distance.
    SpecificWearRate,
    /// m².
    Area,
    /// K; also written in degrees Celsius.
    Temperature,
    /// W/(m K).
    ThermalConductivity,
    /// kg/m³.
    Density,
    /// J/(kg K).
    SpecificHeat,
    /// W/K: heat lost per temperature above the ambient.
    Cooling,
    /// J/(K rad): the same per rotational speed.
    CoolingPerSpeed,
    /// 1/kg.
    NumberPerMass,
    /// rad.
    Angle,
}

/// Knowledge of a kind of quantity.
struct Facts {
    powers: Powers,
    /// The coherent SI unit.
    si_unit: &'static str,
    example: &'static str,
    /// Units that are commonly used.
    units: &'static str,
}

const fn facts(powers: Powers, si_unit: &'static str, example: &'static str, units: &'static str) -> Facts {
    Facts { powers, si_unit, example, units }
}

/// Dimension of a unit of these powers.
const MEANINGS: &[(Powers, &str)] = &[
    ([1, 0, 0, 0, 0], "a length"),
    ([1, 1, -2, 0, 0], "a force"),
    ([-1, 1, -2, 0, 0], "a pressure"),
    ([0, 0, 1, 0, 0], "a time"),
    ([1, 0, -1, 0, 0], "a speed"),
    ([0, 0, -1, 1, 0], "a rotational speed"),
    ([1, -1, 2, 0, 0], "a specific wear rate"),
    ([0, 0, 0, 0, 0], "a plain number"),
    ([0, 1, 0, 0, 0], "a mass"),
    ([0, 0, 0, 1, 0], "an angle"),
    ([0, 0, -1, 0, 0], "a frequency"),
    ([2, 0, 0, 0, 0], "an area"),
    ([3, 0, 0, 0, 0], "a volume"),
    ([2, 1, -2, 0, 0], "an energy"),
    ([2, 1, -3, 0, 0], "a power"),
    ([0, 0, 0, 0, 1], "a temperature"),
    ([1, 1, -3, 0, -1], "a thermal conductivity"),
    ([-3, 1, 0, 0, 0], "a density"),
    ([2, 0, -2, 0, -1], "a specific heat"),
    ([2, 1, -3, 0, -1], "a cooling"),
    ([2, 1, -2, -1, -1], "a cooling per speed"),
    ([0, -1, 0, 0, 0], "a number per mass"),
];

pub(super) fn meaning(powers: Powers) -> &'static str {
    MEANINGS.iter().find(|(known, _)| *known == powers).map_or("a quantity of another kind", |(_, name)| name)
}

impl Dimension {
    fn facts(self) -> Facts {
        match self {
            Self::Length => facts([1, 0, 0, 0, 0], "m", "50 um", "m, mm, um, nm"),
            Self::Force => facts([1, 1, -2, 0, 0], "N", "47 N", "N, kN, mN"),
            Self::Pressure => facts([-1, 1, -2, 0, 0], "Pa", "100 GPa", "Pa, kPa, MPa, GPa"),
            Self::Time => facts([0, 0, 1, 0, 0], "s", "3000 s", "s, ms, min, h"),
            Self::Speed => facts([1, 0, -1, 0, 0], "m/s", "2 m/s", "m/s, mm/s, km/h"),
            Self::RotationalSpeed => facts([0, 0, -1, 1, 0], "rad/s", "850 rpm", "rpm, rad/s"),
            Self::Torque => facts([2, 1, -2, 0, 0], "N m", "0.4 N m", "N m, mN m, kN m"),
            Self::SpecificWearRate => facts([1, -1, 2, 0, 0], "1/Pa", "5e-14 1/Pa", "1/Pa, m^2/N, mm^3/(N m)"),
            Self::Area => facts([2, 0, 0, 0, 0], "m^2", "2000 um^2", "m^2, mm^2, um^2"),
            Self::Temperature => facts([0, 0, 0, 0, 1], "K", "23 degC", "degC, K"),
            Self::ThermalConductivity => facts([1, 1, -3, 0, -1], "W/(m K)", "50 W/(m K)", "W/(m K), W/m/K"),
            Self::Density => facts([-3, 1, 0, 0, 0], "kg/m^3", "7200 kg/m^3", "kg/m^3, g/cm^3"),
            Self::SpecificHeat => facts([2, 0, -2, 0, -1], "J/(kg K)", "500 J/(kg K)", "J/(kg K), kJ/(kg K), J/kg/K"),
            Self::Cooling => facts([2, 1, -3, 0, -1], "W/K", "0.4 W/K", "W/K, mW/K"),
            Self::CoolingPerSpeed => facts([2, 1, -2, -1, -1], "J/(K rad)", "0.002 J/(K rad)", "J/(K rad), J/K/rad"),
            Self::NumberPerMass => facts([0, -1, 0, 0, 0], "1/kg", "1e15 1/kg", "1/kg, 1/g, 1/mg"),
            Self::Angle => facts([0, 0, 0, 1, 0], "rad", "90 deg", "deg, rad"),
        }
    }

    pub(super) fn powers(self) -> Powers {
        self.facts().powers
    }

    /// Its meaning in a scene, with an article.
    fn meaning(self) -> &'static str {
        // By its powers it would be an energy.
        if self == Self::Torque { "a torque" } else { meaning(self.powers()) }
    }

    /// Its name, such as "rotational speed".
    pub fn name(self) -> &'static str {
        let meaning = self.meaning();
        meaning.split_once(' ').map_or(meaning, |(_article, name)| name)
    }

    /// The coherent SI unit.
    pub fn si_unit(self) -> &'static str {
        self.facts().si_unit
    }

    /// A quantity as a scene may write it.
    pub fn example(self) -> &'static str {
        self.facts().example
    }

    /// The units that are commonly used, for messages and documentation.
    pub fn units(self) -> &'static str {
        self.facts().units
    }
}

/// Says what is expected, with an example: `a force such as "47 N" (N, kN, mN)`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} such as \"{}\" ({})", self.meaning(), self.example(), self.units())
    }
}
