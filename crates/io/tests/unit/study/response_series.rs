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
    assert!(event_quantities(&extras).all(|quantity| lacking(&drive, &format!("{EVENT}{}", quantity.name)).is_none()));
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
