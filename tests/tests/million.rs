//! A million steps of `quick.toml` (in short a tenth of them), with local debris and with one pool: the load stays balanced, and no debris comes from
//! nowhere or goes there.

use std::path::Path;

use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::DebrisRule;
use plateau_core::simulation::Simulation;
use plateau_io::{scene, surface};
use plateau_tests::scenes::few_or_all;

/// Σ A (heights − others).
fn volume_between(mesh: &Mesh, heights: &[f64], others: &[f64]) -> f64 {
    heights.iter().zip(others).zip(mesh.area().iter().cycle()).map(|((a, b), area)| area * (a - b)).sum()
}

fn largest(heights: &[f64]) -> f64 {
    heights.iter().fold(0.0, |largest, height| f64::max(largest, height.abs()))
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes half a minute in release, and minutes in debug")]
fn residuals_stay_small_and_nothing_is_lost_over_very_many_steps() {
    expect_balance_over_many_steps(DebrisRule::Local, &[]);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes half a minute in release, and minutes in debug")]
fn the_same_holds_with_one_debris_pool() {
    let sets = ["plateaus.debris=contact", "plateaus.captured_fraction=0.06"];
    expect_balance_over_many_steps(DebrisRule::Contact, &sets);
}

/// Runs the scene with changes that make it have this rule.
fn expect_balance_over_many_steps(debris: DebrisRule, sets: &[&str]) {
    // Pools are the plain model's, which takes many times as long for a step.
    let few = if debris == DebrisRule::Local { 100_000 } else { 20_000 };
    let steps = few_or_all(few, 1_000_000);
    let path = plateau_tests::program::scene("quick.toml");
    let length = format!("operation.steps={steps}");
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).chain([length]).collect();
    let scene = scene::load(Path::new(&path), &sets).unwrap();
    assert_eq!((scene.steps, scene.parameters.plateaus.debris), (steps, debris));
    let is_local = debris == DebrisRule::Local;
    let tolerance = scene.load_tolerance;
    let mesh = scene.parameters.mesh.clone();
    let initial = surface::load(&scene).unwrap().surfaces;
    let reference_height = initial.disc_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut simulation = Simulation::new(scene.parameters, initial.clone()).unwrap();

    for step in (0..=steps).step_by(100) {
        simulation.advance_to(step).unwrap();
        let load = simulation.course().largest_load_residual;
        assert!(load <= tolerance, "step {step}: load residual {load:e}");
        let sample = simulation.sample().unwrap();
        let balance = sample.balance_residual;
        assert!(balance.abs() <= 1e-12, "step {step}: balance residual {balance:e}");
        if is_local {
            assert_eq!((sample.pool, sample.returned), (0.0, 0.0), "step {step}");
            let is_below = simulation.disc_height().unwrap().into_iter().all(|height| height <= reference_height);
            assert!(is_below, "step {step}: the disc grew above its highest initial height");
        }
    }
    assert_eq!(simulation.steps_done(), steps);

    let sample = simulation.sample().unwrap();
    let (disc, pin) = (simulation.disc().unwrap(), simulation.pin().unwrap());
    for heights in [&disc.height, &disc.substrate, &pin.height, &pin.substrate] {
        assert!(heights.iter().all(|height| height.is_finite()));
    }
    assert!(disc.height.iter().zip(&disc.substrate).all(|(z, b)| z >= b), "z_d ≥ b_d");
    assert!(pin.height.iter().zip(&pin.substrate).all(|(z, b)| z <= b), "z_p ≤ b_p");
    if is_local {
        let worn = sample.worn_pin + sample.worn_resin + sample.worn_disc;
        let left = worn - sample.deposited_pin - sample.deposited_disc - sample.emitted;
        assert!(left.abs() <= 1e-12 * worn, "worn is not deposited and emitted, {left:e} m³ are missing: {sample:?}");
    }

    // The heights tell the same as the account of volumes. In this scene the disc does not wear: it only grows.
    assert_eq!(sample.worn_disc, 0.0);
    assert_eq!(disc.substrate, initial.disc_height);
    let grown = volume_between(&mesh, &disc.height, &initial.disc_height);
    // Each deposit is rounded to half a unit in the last place of the height; a cell gets one per pass of the pin.
    let passes = steps as f64 * mesh.pin_columns() as f64 / mesh.disc_columns() as f64 + mesh.pin_columns() as f64;
    let rounding = passes * mesh.disc_area() * largest(&disc.height).max(largest(&initial.disc_height)) * f64::EPSILON;
    assert!(sample.deposited_disc > 1e4 * rounding, "the disc grew: {sample:?}");
    assert!((grown - sample.deposited_disc).abs() <= rounding, "{grown:e} m³ on the disc: {sample:?}");

    // The pin recedes by what is worn off and what is returned to the pool, and grows by what is deposited.
    let receded = volume_between(&mesh, &pin.height, &initial.pin_height);
    let expected = sample.lost_pin();
    // Wear, destruction and formation each round once a step in each cell.
    let highest = largest(&pin.height).max(largest(&initial.pin_height));
    let rounding = 3.0 * steps as f64 * mesh.pin_area() * highest * f64::EPSILON;
    assert!(expected > 1e4 * rounding, "the pin wore: {sample:?}");
    assert!((receded - expected).abs() <= rounding, "{receded:e} m³ off the pin, not {expected:e}: {sample:?}");
}
