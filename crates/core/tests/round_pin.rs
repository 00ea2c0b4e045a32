//! A round pin: closed forms, what becomes of cells beyond its outline, and the same bits however a run is carried out.

use std::f64::consts::PI;

use crate::scenes::{
    WEAR_RATE, all_primary, engines, flat, primary_stiffness, random_surfaces, round_mesh, start, wear_only,
};
use plateau_core::engine::kernel::InstructionSet;
use plateau_core::model::mesh::{Mesh, Outline};
use plateau_core::model::parameters::{DebrisRule, Parameters, PlateauRules};
use plateau_core::model::state::Base;
use plateau_core::observe::{ABSENT, Map, MapValues, Sample};
use plateau_core::simulation::{Decomposition, Execution, Simulation};
use plateau_core::surface::{Body, FibreSynthesis, HeightSynthesis, fibre_fraction};

/// Relative rounding of a sum over a few thousand cells.
const ROUNDING: f64 = 1e-12;

/// Whether a cell is there, by the definition: its arc length and its radius from the middle, within the circle.
fn is_within(mesh: &Mesh, cell: usize) -> bool {
    let Outline::Disc { radius } = mesh.outline() else { return true };
    let (column, r) = ((cell / mesh.rows()) as f64, mesh.radius()[cell % mesh.rows()]);
    let arc = r * mesh.column_angle() * (column + 0.5 - mesh.pin_columns() as f64 / 2.0);
    arc.hypot(r - mesh.mean_radius()) <= radius
}

/// Plateaus of every kind on a small ring, whose outermost rows no pin cell slides over.
fn scene(debris: DebrisRule) -> Parameters {
    let plateaus = PlateauRules { debris, captured_fraction: 0.7, ..PlateauRules::pool(0.7) };
    let plateaus = if debris == DebrisRule::Local { PlateauRules::LOCAL } else { plateaus };
    Parameters { mesh: round_mesh(19, 1.3, 0.83), time_acceleration: 50.0, plateaus, ..wear_only(1, 2, 1) }
}

fn run(parameters: &Parameters, steps: u64, execution: Execution) -> Simulation {
    let mut simulation = start(parameters, 11, execution);
    simulation.advance_to(steps).unwrap();
    simulation
}

const RULES: [DebrisRule; 3] = [DebrisRule::Local, DebrisRule::Contact, DebrisRule::Track];

#[test]
fn flat_on_flat_carries_the_load_on_the_area_of_the_circle() {
    let mesh = round_mesh(40, 1.0, 1.0);
    let Outline::Disc { radius } = mesh.outline() else { panic!("a round pin") };
    let area = PI * radius * radius;
    // Counting centres misses the area of a convex shape by less than its perimeter times half a cell's diagonal.
    let diagonal = mesh.row_height().hypot(mesh.column_angle() * mesh.radius()[mesh.rows() - 1]);
    assert!((mesh.pin_area() - area).abs() < 2.0 * PI * radius * 0.5 * diagonal);
    let cells: Vec<usize> = (0..mesh.pin_cells()).filter(|cell| is_within(&mesh, *cell)).collect();
    let counted: f64 = cells.iter().map(|cell| mesh.area()[cell % mesh.rows()]).sum();

    let parameters = Parameters { mesh, ..wear_only(1, 2, 1) };
    let (force, mesh) = (parameters.normal_force, parameters.mesh.clone());
    // κ Σ F_cell ds_i, with the same pressure everywhere: κ p Σ A ds.
    let moment = cells.iter().map(|cell| mesh.area()[cell % mesh.rows()] * mesh.radius()[cell % mesh.rows()]);
    let moment: f64 = moment.sum();
    for execution in engines() {
        let surfaces = flat(&mesh, Base::Primary);
        let mut simulation = Simulation::with_execution(parameters.clone(), surfaces, execution).unwrap();
        simulation.advance().unwrap();
        let sample = simulation.sample().unwrap();
        let pressure = force / counted;
        for (found, expected) in [
            (sample.mean_pressure, pressure),
            (sample.max_pressure, pressure),
            (sample.contact_area, counted),
            (sample.displacement, pressure / primary_stiffness(&parameters)),
            (sample.worn_pin, moment * WEAR_RATE * pressure * mesh.column_angle()),
            (sample.pin_primary, 1.0),
            (sample.contact_ratio, 1.0),
        ] {
            assert!((found / expected - 1.0).abs() < ROUNDING, "{execution:?}: {found:e}, expected {expected:e}");
        }
    }
}

#[test]
fn worn_volume_is_wear_rate_times_load_times_distance_and_no_debris_is_lost() {
    for debris in RULES {
        // Fibre alone on a rough disc: every step loses κ Σ F_cell ds_i.
        let mut parameters = scene(debris);
        parameters.time_acceleration = 1.0;
        let (mesh, surfaces) = (parameters.mesh.clone(), random_surfaces(&parameters.mesh, 3));
        let mut simulation = all_primary(parameters.clone(), surfaces.disc_height.clone(), vec![0.0; mesh.pin_cells()]);
        let mut expected = 0.0;
        for _ in 0..2 * mesh.disc_columns() {
            simulation.advance().unwrap();
            let snapshot = simulation.snapshot(&[Map::Pressure]).unwrap();
            let MapValues::Float(pressures) = &snapshot.maps[0].1 else { panic!("pressures") };
            let cells = pressures.iter().enumerate().filter(|(_, pressure)| !pressure.is_nan());
            let moment: f64 = cells
                .map(|(cell, pressure)| pressure * mesh.area()[cell % mesh.rows()] * mesh.radius()[cell % mesh.rows()])
                .sum();
            expected += WEAR_RATE * moment * mesh.column_angle();
        }
        let sample = simulation.sample().unwrap();
        assert!((sample.worn_pin / expected - 1.0).abs() < ROUNDING, "{debris:?}: {:e}, {expected:e}", sample.worn_pin);
        assert!(sample.balance_residual.abs() < ROUNDING, "{debris:?}: {:e}", sample.balance_residual);
        let deposited = sample.deposited_pin + sample.deposited_disc;
        assert!(deposited > 0.0, "{debris:?}: nothing to balance");
    }
}

/// Σ A z over a disc's heights, m³.
fn volume(mesh: &Mesh, heights: &[f64]) -> f64 {
    heights.iter().zip(mesh.area().iter().cycle()).map(|(height, area)| height * area).sum()
}

#[test]
fn nothing_happens_beyond_the_outline() {
    for debris in RULES {
        let parameters = scene(debris);
        let mesh = &parameters.mesh;
        let before = random_surfaces(mesh, 11);
        let mut simulation = run(&parameters, 3 * mesh.disc_columns() as u64, Execution::default());
        let (disc, sample) = (simulation.disc().unwrap(), simulation.sample().unwrap());
        assert!(sample.deposited_disc > 0.0 && sample.worn_resin > 0.0, "{debris:?}: {sample:?}");
        // Rows that no cell slides over stay as they were; that there are some is what the mesh is for.
        let beyond: Vec<usize> = (0..mesh.rows())
            .filter(|row| (0..mesh.pin_columns()).all(|column| !is_within(mesh, column * mesh.rows() + row)))
            .collect();
        assert!(!beyond.is_empty());
        for (cell, (now, then)) in disc.height.iter().zip(&before.disc_height).enumerate() {
            assert!(now == then || !beyond.contains(&(cell % mesh.rows())), "{debris:?}: disc cell {cell}");
        }
        // What is told as deposited on the disc is there, and nothing else: nothing wears it.
        let grown = volume(mesh, &disc.height) - volume(mesh, &before.disc_height);
        let all = volume(mesh, &disc.height).abs() + volume(mesh, &before.disc_height).abs();
        assert!((grown - sample.deposited_disc).abs() < 1e-12 * all, "{debris:?}");
        assert!((sample.pin_none + sample.pin_primary + sample.pin_secondary - 1.0).abs() < ROUNDING);

        let maps =
            simulation.snapshot(&[Map::PinHeight, Map::PinSubstrate, Map::Pressure, Map::PinStatus]).unwrap().maps;
        for (map, values) in maps {
            for cell in 0..mesh.pin_cells() {
                let is_absent = match &values {
                    MapValues::Float(values) => values[cell].is_nan(),
                    MapValues::Status(statuses) => statuses[cell] == ABSENT,
                };
                assert_eq!(is_absent, !is_within(mesh, cell), "{map:?}, cell {cell}");
            }
        }
    }
}

/// All that is told of a simulation.
fn told(simulation: &mut Simulation) -> (Sample, Vec<f64>, Vec<f64>) {
    let (disc, pin) = (simulation.disc().unwrap(), simulation.pin().unwrap());
    (simulation.sample().unwrap(), [disc.height, disc.substrate].concat(), [pin.height, pin.substrate].concat())
}

#[test]
fn workers_and_instruction_sets_give_the_same_bits() {
    for debris in RULES {
        let parameters = scene(debris);
        let steps = 2 * parameters.mesh.disc_columns() as u64 + 3;
        let reference = Execution { instructions: InstructionSet::PORTABLE, shortcut: false, ..Execution::default() };
        let expected = told(&mut run(&parameters, steps, reference));
        for (place, instructions) in InstructionSet::available().enumerate() {
            for workers in [1, 2, 3] {
                let decomposition = [Decomposition::Bands, Decomposition::Sectors][place % 2];
                let execution = Execution { workers, instructions, decomposition, ..Execution::default() };
                assert_eq!(told(&mut run(&parameters, steps, execution)), expected, "{debris:?}, {execution:?}");
            }
        }
    }
}

#[test]
fn a_checkpoint_goes_on_as_if_nothing_had_happened() {
    for debris in RULES {
        for engine in engines() {
            let parameters = scene(debris);
            let execution = |workers| Execution { workers, ..engine };
            let mut first = run(&parameters, 100, execution(2));
            let checkpoint = first.checkpoint().unwrap();
            let mut second = run(&parameters, 0, execution(3));
            second.restore(&checkpoint).unwrap();
            first.advance_to(200).unwrap();
            second.advance_to(200).unwrap();
            assert_eq!(told(&mut first), told(&mut second), "{debris:?}, {engine:?}");
        }
    }
}

#[test]
fn surfaces_are_made_for_the_cells_that_are_there() {
    let mesh = round_mesh(60, 1.0, 0.9);
    let there = |field: &[f64]| -> Vec<f64> {
        field.iter().enumerate().filter(|(cell, _)| is_within(&mesh, *cell)).map(|(_, height)| *height).collect()
    };
    let heights = there(&HeightSynthesis::gaussian(5, 0.5e-6, 200e-6).field(Body::Pin, &mesh).unwrap());
    let count = heights.len() as f64;
    let mean = heights.iter().sum::<f64>() / count;
    let rms = (heights.iter().map(|height| height * height).sum::<f64>() / count).sqrt();
    assert!(mean.abs() < 1e-12 * rms && (rms / 0.5e-6 - 1.0).abs() < ROUNDING, "{mean:e} {rms:e}");

    // To half a fibre, and a cell along its perimeter.
    let synthesis = FibreSynthesis { seed: 2, fibre_fraction: 0.3, fibre_length: 300e-6, fibre_width: 100e-6 };
    let base = synthesis.base(&mesh).unwrap();
    let fibre = there(&base.iter().map(|base| f64::from(*base as u8)).collect::<Vec<_>>());
    let areas = there(&(0..mesh.pin_cells()).map(|cell| mesh.area()[cell % mesh.rows()]).collect::<Vec<_>>());
    let found = fibre.iter().zip(&areas).map(|(fibre, area)| fibre * area).sum::<f64>() / areas.iter().sum::<f64>();
    assert!((found - 0.3).abs() <= 0.5 * (300e-6 * 100e-6 + 0.8e-3 * 60e-6) / mesh.pin_area(), "{found}");
    assert!((fibre_fraction(&base, &mesh) / found - 1.0).abs() < ROUNDING);
}
