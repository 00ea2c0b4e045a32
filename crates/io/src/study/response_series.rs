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
#[path = "../../tests/unit/study/response_series.rs"]
mod tests;
