//! Closed forms of what experiments ask for: wear by counterface, strength of build-up, transport length (model 4.2, 4.2a, 4L).

use plateau_core::model::parameters::{Parameters, PlateauRules};
use plateau_core::model::state::{Base, Disc, InitialSurfaces, Pin};
use plateau_core::simulation::{Execution, Simulation};

use crate::scenes::{engines, wear_only};

/// One row with local debris, and of resin only what `base` says.
fn one_row(disc_columns: usize, pin_columns: usize) -> Parameters {
    let mut parameters = wear_only(1, disc_columns, pin_columns);
    parameters.plateaus = PlateauRules::LOCAL;
    parameters
}

fn start(parameters: &Parameters, surfaces: &InitialSurfaces, execution: Execution) -> Simulation {
    Simulation::with_execution(parameters.clone(), surfaces.clone(), execution).expect("surfaces that fit")
}

/// Steps under constant operation from a state that surfaces alone cannot give.
fn from_state(parameters: &Parameters, disc: Disc, pin: Pin, execution: Execution) -> Simulation {
    let surfaces = InitialSurfaces {
        disc_height: disc.height.clone(),
        pin_height: pin.height.clone(),
        pin_base: pin.base.clone(),
    };
    let mut simulation = start(parameters, &surfaces, execution);
    let mut checkpoint = simulation.checkpoint().expect("a state");
    checkpoint.heights.disc_substrate = disc.substrate;
    checkpoint.heights.pin_substrate = pin.substrate;
    simulation.restore(&checkpoint).expect("a state of the same mesh");
    simulation
}

/// A pin flat on a disc of which every other column is build-up: each fibre wears by the rate of what it slides on.
#[test]
fn two_rates_on_a_half_filled_disc() {
    let mut parameters = one_row(40, 10);
    parameters.materials.pin_primary.specific_wear_rate = 2e-14;
    parameters.materials.pin_primary_against_secondary = Some(6e-14);
    parameters.materials.pin_secondary = parameters.materials.pin_primary;
    let mesh = parameters.mesh.clone();
    let disc = Disc {
        height: vec![0.0; 40],
        substrate: (0..40).map(|column| if column % 2 == 0 { 0.0 } else { -1e-6 }).collect(),
    };
    let pin = Pin { height: vec![0.0; 10], substrate: vec![0.0; 10], base: vec![Base::Primary; 10] };
    for execution in engines() {
        let mut simulation = from_state(&parameters, disc.clone(), pin.clone(), execution);
        simulation.advance().unwrap();
        let sample = simulation.sample().unwrap();
        // All cells touch and are equally stiff, so that each carries F/10, and half of them wear by either rate.
        let sliding = parameters.time_acceleration * mesh.radius()[0] * mesh.column_angle();
        let expected = parameters.normal_force * sliding * 0.5 * (2e-14 + 6e-14);
        assert!((sample.worn_pin / expected - 1.0).abs() < 1e-12, "{execution:?}: {:e}, {expected:e}", sample.worn_pin);
    }
}

/// Films on resin under a flat load: pressed by a hundredth less than its strength a film stays, by a hundredth more it is gone.
#[test]
fn a_film_just_below_and_above_its_strength() {
    let mut parameters = one_row(40, 10);
    for material in [&mut parameters.materials.pin_primary, &mut parameters.materials.pin_secondary] {
        material.specific_wear_rate = 0.0;
    }
    let pressure = parameters.normal_force / parameters.mesh.pin_area();
    let disc = Disc { height: vec![0.0; 40], substrate: vec![0.0; 40] };
    let film = 3e-7;
    let pin = Pin { height: vec![0.0; 10], substrate: vec![film; 10], base: vec![Base::Resin; 10] };
    for (part, returned) in [(1.01, 0.0), (0.99, film * parameters.mesh.pin_area())] {
        parameters.materials.strength = Some(part * pressure);
        for execution in engines() {
            let mut simulation = from_state(&parameters, disc.clone(), pin.clone(), execution);
            simulation.advance().unwrap();
            let sample = simulation.sample().unwrap();
            assert!(
                (sample.returned - returned).abs() <= 1e-12 * film * parameters.mesh.pin_area(),
                "{execution:?}, {part}"
            );
            assert!(
                (sample.emitted - returned).abs() <= 1e-12 * film * parameters.mesh.pin_area(),
                "{execution:?}, {part}"
            );
            let height = if returned > 0.0 { film } else { 0.0 };
            assert!(simulation.pin().unwrap().height.iter().all(|z_p| (z_p - height).abs() < 1e-18));
        }
    }
}

/// One edge: `touching` fibres slide on a plateau ahead of a valley. Each open cell within L columns behind the edge gets
/// η Σ v/L, Σ over at most L of the fibres; the others get nothing.
#[test]
fn one_edge_feeds_one_valley() {
    for (columns, touching) in [(1, 4), (3, 2), (3, 6), (5, 5), (7, 3)] {
        let (disc_columns, pin_columns) = (60, 20);
        let mut parameters = one_row(disc_columns, pin_columns);
        parameters.plateaus.captured_fraction = 0.7;
        // So that overlaps are far less than the valley is deep.
        parameters.normal_force = 0.1;
        let column = parameters.mesh.column_width();
        parameters.plateaus.transport_length = Some(columns as f64 * column);
        // The pin is flat; in the first step pin column j lies over disc column j. The disc stands under some columns, the last
        // but one among them, and is low elsewhere. z_ref is above the valley by far more than a step fills.
        let last = pin_columns - 2;
        let stands = |column: usize| (last + 1 - touching..=last).contains(&column);
        let surfaces = InitialSurfaces {
            disc_height: (0..disc_columns).map(|column| if stands(column) { 0.0 } else { -2e-6 }).collect(),
            pin_height: vec![0.0; pin_columns],
            pin_base: vec![Base::Primary; pin_columns],
        };
        for execution in engines() {
            let mut simulation = start(&parameters, &surfaces, execution);
            simulation.advance().unwrap();
            let sample = simulation.sample().unwrap();
            let mesh = &parameters.mesh;
            let sliding = parameters.time_acceleration * mesh.radius()[0] * mesh.column_angle();
            let area = mesh.area()[0];
            let wear = parameters.materials.pin_primary.specific_wear_rate
                + parameters.materials.disc_primary.specific_wear_rate;
            let lost = wear * parameters.normal_force / (touching as f64 * area) * sliding;
            let share = 0.7 * lost * touching.min(columns) as f64 / columns as f64;
            let disc = simulation.disc_height().unwrap();
            let edge = last + 1 - touching;
            for (column, (found, before)) in disc.iter().zip(&surfaces.disc_height).enumerate() {
                let fed = column < edge && column + columns >= edge;
                if !stands(column) {
                    let expected = before + if fed { share } else { 0.0 };
                    assert!(
                        (found - expected).abs() < 1e-18,
                        "{execution:?}, {columns}, {touching}, column {column}: {found:e}"
                    );
                }
            }
            let open = columns.min(last + 1 - touching) as f64;
            let deposited = sample.deposited_pin + sample.deposited_disc;
            assert!((deposited / (open * share * area) - 1.0).abs() < 1e-9, "{execution:?}, {columns}, {touching}");
        }
    }
}
