//! Responses to series that no run of a study records, for its scenes do not ask for them.

use plateau_core::observe::event::event_quantity;
use plateau_core::observe::extra::Extra;
use plateau_core::observe::operation::CYCLE;
use plateau_core::observe::{EXTRAS, quantities};

use super::record::EVENT;
use crate::scene::Scene;

/// What a scene must have so that its run file has a series, or, with `event/` before it, a quantity of events; none if it has it.
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use plateau_core::observe::event::event_quantities;

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
}
