//! A million steps of `quick.toml`: the load stays balanced, and no debris comes from nowhere or goes there.

use std::path::Path;

use plateau_core::mesh::Mesh;
use plateau_core::simulation::Simulation;
use plateau_io::{scene, surface};

const STEPS: u64 = 1_000_000;

/// Σ A (heights − others).
fn volume_between(mesh: &Mesh, heights: &[f64], others: &[f64]) -> f64 {
    heights.iter().zip(others).zip(mesh.area().iter().cycle()).map(|((a, b), area)| area * (a - b)).sum()
}

fn largest(heights: &[f64]) -> f64 {
    heights.iter().fold(0.0, |largest, height| f64::max(largest, height.abs()))
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes half a minute in release, and minutes in debug")]
fn residuals_stay_small_and_nothing_is_lost_over_a_million_steps() {
    let path = plateau_tests::program::scene("quick.toml");
    let sets = [format!("operation.steps={STEPS}")];
    let scene = scene::load(Path::new(&path), &sets).unwrap();
    assert_eq!(scene.parameters.steps, STEPS);
    let tolerance = scene.parameters.load_tolerance;
    let mesh = scene.parameters.mesh.clone();
    let initial = surface::load(&scene).unwrap().surfaces;
    let mut simulation = Simulation::new(scene.parameters, initial.clone()).unwrap();

    for step in (0..=STEPS).step_by(100) {
        simulation.advance_to(step).unwrap();
        let load = simulation.course().largest_load_residual;
        assert!(load <= tolerance, "step {step}: load residual {load:e}");
        let balance = simulation.sample().unwrap().balance_residual;
        assert!(balance.abs() <= 1e-12, "step {step}: balance residual {balance:e}");
    }
    assert_eq!(simulation.steps_done(), STEPS);

    let sample = simulation.sample().unwrap();
    let (disc, pin) = (simulation.disc().unwrap(), simulation.pin().unwrap());
    for heights in [&disc.height, &disc.substrate, &pin.height, &pin.substrate] {
        assert!(heights.iter().all(|height| height.is_finite()));
    }
    assert!(disc.height.iter().zip(&disc.substrate).all(|(z, b)| z >= b), "z_d ≥ b_d");
    assert!(pin.height.iter().zip(&pin.substrate).all(|(z, b)| z <= b), "z_p ≤ b_p");

    // The heights tell the same as the account of volumes. In this scene the disc does not wear: it only grows.
    assert_eq!(sample.worn_disc, 0.0);
    assert_eq!(disc.substrate, initial.disc_height);
    let grown = volume_between(&mesh, &disc.height, &initial.disc_height);
    // Each deposit is rounded to half a unit in the last place of the height; a cell gets one per pass of the pin.
    let passes = STEPS as f64 * mesh.pin_columns() as f64 / mesh.disc_columns() as f64 + mesh.pin_columns() as f64;
    let rounding = passes * mesh.disc_area() * largest(&disc.height).max(largest(&initial.disc_height)) * f64::EPSILON;
    assert!(sample.deposited_disc > 1e4 * rounding, "the disc grew: {sample:?}");
    assert!((grown - sample.deposited_disc).abs() <= rounding, "{grown:e} m³ on the disc: {sample:?}");

    // The pin recedes by what is worn off and what is returned to the pool, and grows by what is deposited.
    let receded = volume_between(&mesh, &pin.height, &initial.pin_height);
    let expected = sample.worn_pin + sample.worn_resin + sample.returned - sample.deposited_pin;
    // Wear, destruction and formation each round once a step in each cell.
    let highest = largest(&pin.height).max(largest(&initial.pin_height));
    let rounding = 3.0 * STEPS as f64 * mesh.pin_area() * highest * f64::EPSILON;
    assert!(expected > 1e4 * rounding, "the pin wore: {sample:?}");
    assert!((receded - expected).abs() <= rounding, "{receded:e} m³ off the pin, not {expected:e}: {sample:?}");
}
