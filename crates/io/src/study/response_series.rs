//! Series that responses ask: what a scene needs in order to record one, and the least and largest value of a response.

use plateau_core::observe::CYCLE;
use plateau_core::observe::event::event_quantity;
use plateau_core::observe::extra::Extra;
use plateau_core::observe::{EXTRAS, quantities};

use super::record::{EVENT, unit_of};
use super::response::{Question, Response};
use crate::scene::Scene;

/// Part that a scene must have so that its run file has a series, or, with `event/` before it, a quantity of events; none if it has it.
pub fn lacking(scene: &Scene, series: &str) -> Option<String> {
    let extras = scene.extras(scene.adaptive.is_some());
    let needs = |extra: &Extra| extra.needs.to_owned();
    if let Some(name) = series.strip_prefix(EVENT) {
        if scene.cycle.is_none() {
            return Some(needs(&CYCLE));
        }
        return event_quantity(name)?.part.filter(|part| !extras.contains(part)).map(needs);
    }
    if quantities(&extras).any(|quantity| quantity.name == series) {
        return None;
    }
    let extra = EXTRAS.iter().find(|extra| extra.quantities.iter().any(|quantity| quantity.name == series))?;
    let is_asked_for = extra.request.is_none() || scene.output.extras.contains(extra);
    Some(if is_asked_for { needs(extra) } else { format!("output.{} = true", extra.name) })
}

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
    /// Bounds of its values, as far as its series or unit tells.
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
    use std::path::Path;

    use plateau_core::observe::event::event_quantities;
    use plateau_core::observe::{EXTRAS, quantities};

    use super::*;
    use crate::scene::load;

    fn scene(name: &str, sets: &[&str]) -> Scene {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes").join(name);
        load(&path, &sets.iter().map(|set| (*set).to_owned()).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn every_series_of_a_part_asks_for_it() {
        let quick = scene("quick.toml", &[]);
        assert_eq!((lacking(&quick, "contact_area"), lacking(&quick, "pool")), (None, None));
        for (series, expected) in [
            ("disc_sq", "output.roughness = true"),
            ("pressure_gini", "output.pressure_spread = true"),
            ("contact_temperature_heated", "output.contact_temperature = true"),
            ("friction_coefficient", "[friction]"),
            ("contact_temperature", "[thermal]"),
            ("pm10_mass", "[emission]"),
            ("normal_force", "[operation.cycle]"),
            ("road_distance", "road_speed"),
            ("acceleration_error", "tolerance"),
            ("event/worn", "[operation.cycle]"),
        ] {
            let found = lacking(&quick, series).unwrap_or_else(|| panic!("{series}"));
            assert!(found.contains(expected), "{series}: {found}");
        }
        let rough = scene("quick.toml", &["output.roughness=true"]);
        assert_eq!(lacking(&rough, "disc_sq"), None);
    }

    #[test]
    fn no_series_of_a_run_is_lacking() {
        // All parts of the model, and nothing on request.
        let drive = scene("drive.toml", &[]);
        let extras = drive.extras(false);
        assert!(quantities(&extras).all(|quantity| lacking(&drive, quantity.name).is_none()));
        assert!(
            event_quantities(&extras).all(|quantity| lacking(&drive, &format!("{EVENT}{}", quantity.name)).is_none())
        );
        let plain = scene("stops.toml", &[]);
        let has_heat = plain.parameters.thermal.is_some();
        assert_eq!(lacking(&plain, "event/temperature_peak").is_none(), has_heat);
    }

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
