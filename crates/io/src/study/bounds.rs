//! What a response can be at all: an area is not negative, a fraction is not above 1.

use super::record::unit_of;
use super::response::{Question, Response};

/// Series that are fractions.
const FRACTIONS: [&str; 7] =
    ["contact_ratio", "pin_primary", "pin_secondary", "pin_none", "disc_secondary", "filled_fraction", "pressure_gini"];
/// Units of what is not negative, whatever it is: areas and volumes, pressures, masses.
const NOT_NEGATIVE_UNITS: [&str; 5] = ["m2", "m2 s", "m3", "Pa", "kg"];
/// The same of tables from elsewhere, where a pressure may be a difference.
const NOT_NEGATIVE_ELSEWHERE: [&str; 3] = ["m2", "m3", "kg"];
/// Series of other units that are not negative.
const NOT_NEGATIVE: [&str; 12] = [
    "sliding_distance",
    "road_distance",
    "friction_coefficient",
    "friction_coefficient_mean",
    "friction_work",
    "particle_number",
    "pressure_variation",
    "disc_sa",
    "disc_sq",
    "pin_sa",
    "pin_sq",
    "normal_force",
];

/// The least and the most that a response can be, SI; infinite where there is no such bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least.
    pub least: f64,
    /// The most.
    pub most: f64,
}

impl Bounds {
    /// Of what may be any number.
    pub const NONE: Self = Self { least: f64::NEG_INFINITY, most: f64::INFINITY };
    const NOT_NEGATIVE: Self = Self { least: 0.0, ..Self::NONE };
    const FRACTION: Self = Self { least: 0.0, most: 1.0 };
}

impl Response {
    /// What it can be at all, as far as its series or unit tells.
    pub fn bounds(&self) -> Bounds {
        let name = self.series.rsplit('/').next().unwrap_or_default();
        match self.question {
            Question::Imported(unit) if NOT_NEGATIVE_ELSEWHERE.contains(&unit) => Bounds::NOT_NEGATIVE,
            Question::Imported(_) => Bounds::NONE,
            Question::Reaches(_) => Bounds::NOT_NEGATIVE,
            // A pin that hardly wears may gain what a disc loses.
            _ if name == "lost_pin" => Bounds::NONE,
            _ if FRACTIONS.contains(&name) => Bounds::FRACTION,
            _ if NOT_NEGATIVE.contains(&name) => Bounds::NOT_NEGATIVE,
            _ if NOT_NEGATIVE_UNITS.contains(&unit_of(&self.series)) => Bounds::NOT_NEGATIVE,
            _ => Bounds::NONE,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plateau_core::observe::{EXTRAS, quantities};

    fn bounds(series: &str, question: Question) -> Bounds {
        Response { name: "r".into(), series: series.into(), question, transform: "none", stated_unit: None }.bounds()
    }

    #[test]
    fn areas_volumes_and_fractions_have_bounds_and_heights_have_none() {
        assert_eq!(bounds("contact_area", Question::End), Bounds::NOT_NEGATIVE);
        assert_eq!(bounds("event/worn", Question::End), Bounds::NOT_NEGATIVE);
        assert_eq!(bounds("filled_fraction", Question::End), Bounds::FRACTION);
        assert_eq!(bounds("displacement", Question::End), Bounds::NONE);
        assert_eq!(bounds("lost_pin", Question::End), Bounds::NONE);
        assert_eq!(bounds("displacement", Question::Reaches(0.9)), Bounds::NOT_NEGATIVE);
        assert_eq!(bounds("balance_residual", Question::End), Bounds::NONE);
        assert_eq!(bounds("", Question::Imported("m2")), Bounds::NOT_NEGATIVE);
        assert_eq!(bounds("", Question::Imported("1")), Bounds::NONE);
    }

    #[test]
    fn names_are_those_of_series() {
        let known: Vec<&str> = quantities(EXTRAS).map(|quantity| quantity.name).collect();
        for name in FRACTIONS.iter().chain(&NOT_NEGATIVE) {
            assert!(known.contains(name), "{name}");
        }
    }
}
