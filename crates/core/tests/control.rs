//! Load, speed and heights that are set between steps: the same bits for any number of workers, the plain model's results, and what is
//! refused.

use plateau_core::model::memory::Heights;
use plateau_core::model::parameters::{DebrisRule, Parameters};
use plateau_core::simulation::checkpoint::Checkpoint;
use plateau_core::simulation::{Engine, Execution, Simulation, SimulationError};

use crate::scenes::{engines, few_or_all, random_scene, random_surfaces, start};

/// Steps between two changes.
const STEPS: u64 = 7;

fn heights(simulation: &mut Simulation) -> Heights {
    let (disc, pin) = (simulation.disc().expect("the disc"), simulation.pin().expect("the pin"));
    Heights {
        disc_height: disc.height,
        disc_substrate: disc.substrate,
        pin_height: pin.height,
        pin_substrate: pin.substrate,
    }
}

/// Steps under loads up and down, above the first one too, with a pin that is lowered and a disc that is lowered and raised again in
/// part; the displacement of each part. None where friction is too small for a braking torque.
fn controlled(parameters: &Parameters, seed: u64, execution: Execution) -> Option<(Vec<f64>, Checkpoint)> {
    let mut simulation = start(parameters, seed, execution);
    let highest = random_surfaces(&parameters.mesh, seed).reference_height();
    let (load, speed) = (parameters.normal_force, parameters.angular_velocity);
    let mut displacements = Vec::new();
    for (part, [of_load, of_speed]) in [[1.0, 1.0], [0.3, 2.0], [8.0, 0.5], [2.0, 0.1]].into_iter().enumerate() {
        simulation.operate(of_load * load, of_speed * speed).expect("a load");
        let mut moved = heights(&mut simulation);
        for cell in (part..moved.pin_height.len()).step_by(3) {
            moved.pin_height[cell] -= 1e-7;
            moved.pin_substrate[cell] -= 1e-7;
        }
        for cell in (part / 2..moved.disc_height.len()).step_by(5) {
            let by = if part % 2 == 0 { -3e-7 } else { 3e-7 };
            let (before, substrate) = (moved.disc_height[cell], moved.disc_substrate[cell]);
            let height = (before + by).min(highest);
            moved.disc_height[cell] = height;
            moved.disc_substrate[cell] = if substrate == before { height } else { (substrate + by).min(height) };
        }
        simulation.set_heights(moved).expect("heights");
        match simulation.advance_to(simulation.steps_done() + STEPS) {
            Err(SimulationError::NoFriction { .. }) => return None,
            taken => taken.expect("steps"),
        }
        displacements.push(simulation.sample().expect("a sample").displacement);
    }
    Some((displacements, simulation.checkpoint().expect("a state")))
}

#[test]
fn what_is_set_between_steps_has_the_same_bits_for_any_workers_and_the_plain_models_results() {
    for seed in 0..few_or_all(8, 300) {
        let parameters = random_scene(seed, DebrisRule::Local);
        if parameters.cycle.is_some() {
            continue;
        }
        let Some((expected, state)) = controlled(&parameters, seed, Execution::default()) else { continue };
        for workers in [2, 3] {
            let execution = Execution { workers, ..Execution::default() };
            let (found, other) = controlled(&parameters, seed, execution).expect("friction");
            assert_eq!(found, expected, "scene {seed}, {workers} workers");
            assert_eq!(other.heights, state.heights, "scene {seed}, {workers} workers");
        }
        let execution = Execution { engine: Engine::Plain, ..Execution::default() };
        let (plain, _) = controlled(&parameters, seed, execution).expect("friction");
        for (fast, plain) in expected.iter().zip(&plain) {
            assert!((fast - plain).abs() < 1e-12, "scene {seed}: {fast:e}, plain {plain:e}");
        }
    }
}

#[test]
fn time_and_distance_go_by_the_speed_that_is_set() {
    let parameters = Parameters { cycle: None, ..random_scene(1, DebrisRule::Local) };
    let mut simulation = start(&parameters, 1, Execution::default());
    let mut expected = 0.0;
    for speed in [10.0, 40.0, 5.0] {
        simulation.operate(parameters.normal_force, speed).expect("a speed");
        // The first step that ends no earlier than half a step after the fourth.
        let step = parameters.step_angle() / speed;
        assert_eq!(simulation.steps_until(expected + 4.5 * step) - simulation.steps_done(), 5);
        simulation.advance_to(simulation.steps_done() + 4).expect("steps");
        expected += 4.0 * step;
        assert!((simulation.time() / expected - 1.0).abs() < 1e-14);
    }
    let distance = 12.0 * parameters.step_angle() * parameters.mesh.mean_radius();
    assert!((simulation.sample().expect("a sample").sliding_distance / distance - 1.0).abs() < 1e-14);
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let parameters = Parameters { cycle: None, ..random_scene(2, DebrisRule::Local) };
    let mut simulation = start(&parameters, 2, Execution::default());
    simulation.advance_to(3).expect("steps");
    let before = heights(&mut simulation);
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(simulation.operate(wrong, 1.0), Err(SimulationError::Operation { .. })));
        assert!(matches!(simulation.operate(1.0, wrong), Err(SimulationError::Operation { .. })));
    }
    let wrong: [fn(&mut Heights); 4] = [
        |heights| heights.disc_height[1] = 1e-3,
        |heights| heights.disc_height[1] = f64::NAN,
        |heights| heights.disc_height[1] = heights.disc_substrate[1] - 1e-6,
        |heights| heights.pin_height[1] = heights.pin_substrate[1] + 1e-6,
    ];
    for change in wrong {
        let mut heights = before.clone();
        change(&mut heights);
        let refused = simulation.set_heights(heights);
        assert!(matches!(refused, Err(SimulationError::Cell { column: 0, row: 1, .. })), "{refused:?}");
    }
    let short = Heights { disc_height: Vec::new(), ..before.clone() };
    assert!(matches!(simulation.set_heights(short), Err(SimulationError::Checkpoint(_))));
    assert_eq!(heights(&mut simulation), before);
}

#[test]
fn a_state_holds_load_and_speed_that_were_set() {
    let execution = |engine, workers| Execution { engine, workers, ..Execution::default() };
    for (seed, engine) in (0..few_or_all(8, 300)).flat_map(|seed| [(seed, Engine::Fast), (seed, Engine::Plain)]) {
        let parameters = Parameters { cycle: None, by_torque: false, ..random_scene(seed, DebrisRule::Local) };
        let load = parameters.normal_force;
        let mut first = start(&parameters, seed, execution(engine, 1));
        first.advance_to(2).expect("steps");
        let untouched = first.checkpoint().expect("a state");
        for (of_load, speed) in [(9.0, 3.0), (0.5, 70.0)] {
            // What sums are multiples of goes by the largest load, whatever is made anew since.
            first.accelerate(parameters.time_acceleration + of_load).expect("an acceleration");
            first.operate(of_load * load, speed).expect("a load");
            first.advance_to(first.steps_done() + STEPS).expect("steps");
        }
        // Told after the last step, which had another.
        first.operate(2.0 * load, 11.0).expect("a load");
        let state = first.checkpoint().expect("a state");
        let mut ends = Vec::new();
        let mut end = |simulation: &mut Simulation| {
            let speed = simulation.last_speed();
            simulation.advance_to(simulation.steps_done() + 2 * STEPS).expect("steps");
            // Of a sample as text: what is no number is as another that is none.
            let sample = format!("{:?}", simulation.sample().expect("a sample"));
            ends.push((speed, sample, simulation.checkpoint().expect("a state")));
        };
        end(&mut first);
        for workers in [1, 2] {
            let mut again = start(&parameters, seed, execution(engine, workers));
            again.restore(&state).expect("its state");
            end(&mut again);
        }
        // Whatever was told a simulation before.
        first.restore(&state).expect("its state");
        end(&mut first);
        assert!(ends.iter().all(|found| found == &ends[0]), "scene {seed}, {engine:?}");
        assert_eq!(ends[0].0, 70.0);
        let mut anew = start(&parameters, seed, execution(engine, 1));
        for simulation in [&mut anew, &mut first] {
            simulation.restore(&untouched).expect("its state");
            assert_eq!(simulation.parameters(), &parameters);
            simulation.advance_to(40).expect("steps");
        }
        assert_eq!(anew.checkpoint(), first.checkpoint(), "scene {seed}, {engine:?}");
    }
}

#[test]
fn distance_goes_on_from_a_change_of_the_acceleration() {
    for execution in engines() {
        let parameters = Parameters { cycle: None, ..random_scene(1, DebrisRule::Local) };
        let mut simulation = start(&parameters, 1, execution);
        let column = parameters.mesh.column_angle() * parameters.mesh.mean_radius();
        let mut distance = 0.0;
        for (acceleration, speed) in [(2.0, None), (3.0, Some(10.0)), (5.0, None), (1.0, Some(2.0))] {
            simulation.accelerate(acceleration).expect("an acceleration");
            if let Some(speed) = speed {
                simulation.operate(parameters.normal_force, speed).expect("a speed");
            }
            simulation.advance_to(simulation.steps_done() + 6).expect("steps");
            distance += 6.0 * acceleration * column;
            let found = simulation.sample().expect("a sample").sliding_distance;
            assert!((found / distance - 1.0).abs() < 1e-14, "{execution:?}: {found:e}, expected {distance:e}");
        }
    }
}

#[test]
fn a_speed_at_which_time_stands_still_is_refused() {
    let parameters = Parameters { cycle: None, ..random_scene(2, DebrisRule::Local) };
    let mut simulation = start(&parameters, 2, Execution::default());
    simulation.advance_to(3).expect("steps");
    for wrong in [1e300, 1e-320] {
        let refused = simulation.operate(parameters.normal_force, wrong);
        assert!(matches!(refused, Err(SimulationError::TimeLost { .. })), "{refused:?}");
    }
    assert_eq!(simulation.parameters(), &parameters);
}
