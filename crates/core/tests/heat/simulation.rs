//! A whole simulation with friction, heat, emission and a cycle: who takes its steps, where it is sampled and where it
//! is interrupted changes no bit of it.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::expected::Expected;
use crate::scenes::{engines, few_or_all, random_scene, start};
use plateau_core::model::cycle::{Cycle, Interpolation, Kind, Node};
use plateau_core::model::parameters::{DebrisRule, Parameters};
use plateau_core::observe::extra::CONTACT_TEMPERATURE;
use plateau_core::observe::schedule::{End, Moment, SampleEvery, Schedule};
use plateau_core::simulation::checkpoint::Checkpoint;
use plateau_core::simulation::{Engine, Execution, Simulation};

/// Random scenes with heat, factors and a cycle with pauses, as many as asked for.
fn scenes(count: usize) -> impl Iterator<Item = (u64, Parameters)> {
    let rules = [DebrisRule::Local, DebrisRule::Contact, DebrisRule::Track];
    let scene = move |seed: u64| (seed, random_scene(10_000 + seed, rules[seed as usize % 3]));
    let is_meant = |parameters: &Parameters| {
        let has_pause = |cycle: &Cycle| {
            let early = (0..40).flat_map(|number| cycle.pauses_after(number, parameters.step_angle()));
            early.map(|pause| pause.kind).collect::<Vec<_>>()
        };
        let pauses = parameters.cycle.as_deref().map(has_pause).unwrap_or_default();
        let changes = parameters.thermal.as_ref().is_some_and(|thermal| !thermal.wear_rate_factor.is_one());
        changes && pauses.contains(&Kind::Lifted) && pauses.contains(&Kind::Standing)
    };
    (0..).map(scene).filter(move |(_, parameters)| is_meant(parameters)).take(count)
}

/// What a moment is told by, bit for bit: no number is the same as another, and none is as none.
fn key(moment: &Moment) -> (u64, u64) {
    (moment.step, moment.time.to_bits())
}

/// Runs to the end of a schedule from some moment on, and tells of every sample.
fn run(
    simulation: &mut Simulation,
    schedule: &Schedule,
    from: (u64, f64),
    mut each: impl FnMut(&mut Simulation, &Moment),
) -> BTreeMap<(u64, u64), String> {
    let (mut now, mut samples) = (from, BTreeMap::new());
    while let Some(moment) = schedule.next(now.0, now.1) {
        if simulation.steps_done() < moment.step {
            simulation.advance_to(moment.step).unwrap();
        }
        if moment.pause.is_some() {
            simulation.keep_contact().unwrap();
        }
        let sample = simulation.sample_at(&moment, &[&CONTACT_TEMPERATURE]).unwrap();
        samples.insert(key(&moment), format!("{sample:?}"));
        each(simulation, &moment);
        now = (moment.step, moment.time);
    }
    samples
}

/// So many steps, with a sample every so many steps' time.
fn schedule(parameters: &Parameters, steps: u64, every: f64) -> Schedule {
    let end = parameters.operation_of(steps, &parameters.clock()).end;
    Schedule::new(parameters, End::Time(end), SampleEvery::Time(every * end / steps as f64), &[])
}

#[test]
fn the_number_of_workers_changes_no_bit() {
    for (seed, parameters) in scenes(few_or_all(10, 100)) {
        let steps = 2 * parameters.mesh.disc_columns() as u64 + 5;
        let schedule = schedule(&parameters, steps, 0.3);
        let [one, three] = [1, 3].map(|workers| {
            let execution = Execution { workers, ..Execution::default() };
            run(&mut start(&parameters, seed, execution), &schedule, (0, 0.0), |_, _| {})
        });
        // A ring of two columns has 19.
        assert!(one.len() > 18 && one == three, "seed {seed}");
    }
}

#[test]
fn samples_change_nothing_that_comes_after_them() {
    for execution in engines() {
        for (seed, parameters) in scenes(few_or_all(10, 100)) {
            let steps = 2 * parameters.mesh.disc_columns() as u64 + 5;
            let [often, seldom] = [0.1, 7.0].map(|every| {
                let mut simulation = start(&parameters, seed, execution);
                let samples = run(&mut simulation, &schedule(&parameters, steps, every), (0, 0.0), |_, _| {});
                simulation.advance().unwrap();
                (samples, format!("{:?}", simulation.sample().unwrap()))
            });
            assert!(often.0.len() > 3 * seldom.0.len());
            // What both sampled, and the step after all of it.
            let common = seldom.0.iter().filter_map(|(moment, sample)| Some((sample, often.0.get(moment)?)));
            assert!(common.clone().count() > 0, "seed {seed}");
            assert!(common.clone().all(|(one, other)| one == other), "seed {seed}");
            assert_eq!(often.1, seldom.1, "seed {seed}");
        }
    }
}

#[test]
fn a_run_that_goes_on_from_any_moment_is_the_same() {
    let (mut in_pauses, mut within_intervals) = (0, 0);
    for execution in engines() {
        for (seed, parameters) in scenes(few_or_all(4, 40)) {
            let steps = parameters.mesh.disc_columns() as u64 + 15;
            let schedule = schedule(&parameters, steps, 0.6);
            let mut checkpoints: Vec<(Moment, Checkpoint)> = Vec::new();
            let whole = run(&mut start(&parameters, seed, execution), &schedule, (0, 0.0), |simulation, moment| {
                checkpoints.push((*moment, simulation.checkpoint().unwrap()));
            });
            for (moment, checkpoint) in checkpoints.into_iter().step_by(3) {
                // On another number of workers, too.
                let workers = if execution.engine == Engine::Fast { 1 + moment.step as usize % 3 } else { 1 };
                let mut simulation = start(&parameters, seed, Execution { workers, ..execution });
                simulation.restore(&checkpoint).unwrap();
                let rest = run(&mut simulation, &schedule, (moment.step, moment.time), |_, _| {});
                let differ: Vec<_> = rest.iter().filter(|(moment, sample)| whole[*moment] != **sample).collect();
                assert!(differ.is_empty(), "seed {seed}, from {moment:?}: {:?}", differ[0]);
                *if moment.pause.is_some() { &mut in_pauses } else { &mut within_intervals } += 1;
            }
        }
    }
    assert!(in_pauses > 5 && within_intervals > 20, "{in_pauses} {within_intervals}");
}

#[test]
fn the_engine_agrees_with_the_plain_model_in_pauses_too() {
    let mut pauses = 0;
    for (seed, parameters) in scenes(few_or_all(10, 100)) {
        let steps = parameters.mesh.disc_columns() as u64 + 15;
        let schedule = schedule(&parameters, steps, 0.4);
        let [fast, plain] = engines().map(|execution| {
            let (mut simulation, mut found) = (start(&parameters, seed, execution), Vec::new());
            run(&mut simulation, &schedule, (0, 0.0), |simulation, moment| {
                if moment.pause.is_some() {
                    let sample = simulation.sample_at(moment, &[&CONTACT_TEMPERATURE]).unwrap();
                    let heat = sample.accounts.heat.unwrap();
                    let heated = sample.extras.iter().map(|(_, value)| *value);
                    found.push(heated.chain([heat.contact, heat.face, heat.disc, heat.pin]).collect::<Vec<f64>>());
                }
            });
            found
        });
        assert_eq!(fast.len(), plain.len());
        pauses += fast.len();
        for (fast, plain) in fast.iter().flatten().zip(plain.iter().flatten()) {
            let ambient = parameters.thermal.as_ref().unwrap().ambient;
            let close = (fast - plain).abs() <= 1e-9 * ((plain - ambient).abs() + 1e-3);
            assert!(close || (fast.is_nan() && plain.is_nan()), "seed {seed}: {fast} {plain}");
        }
    }
    assert!(pauses > 50, "{pauses}");
}

#[test]
fn samples_in_a_pause_of_very_many_rows_take_each_row_once() {
    // Lifted in rows of 1 s each. To take all rows before it again for every sample would be 10 sub-steps for each of 200
    // million pairs of rows: minutes.
    const ROWS: u32 = 20_000;
    let constant = super::expected::parameters(super::thermal(), None);
    let active = 30.0 * constant.step_time();
    let (load, speed) = (constant.normal_force, constant.angular_velocity);
    let lifted = (0..ROWS).map(|row| Node::new(active + f64::from(row), 0.0, speed));
    let end = [active + f64::from(ROWS), 2.0 * active + f64::from(ROWS)].map(|time| Node::new(time, load, speed));
    let nodes: Vec<Node> = [Node::new(0.0, load, speed)].into_iter().chain(lifted).chain(end).collect();
    let cycle = Arc::new(Cycle::new(&nodes, Interpolation::Hold, 1).unwrap());
    let parameters = Parameters { cycle: Some(cycle), ..constant };
    let mut expected = Expected::new(&parameters);
    // Three revolutions of ten steps.
    (0..3).for_each(|_| expected.interval(active / 3.0, load, speed, 1.0));
    let mut simulation = start(&parameters, 1, Execution::default());
    simulation.advance_to(30).unwrap();
    let (begin, mut first) = (Instant::now(), None);
    for row in 1..=ROWS {
        let time = active + f64::from(row) - 0.5;
        let moment = Moment { step: 30, time, pause: Some(Kind::Lifted), sample: true, maps: false };
        simulation.keep_contact().unwrap();
        let sample = simulation.sample_at(&moment, &[]).unwrap();
        first.get_or_insert_with(|| format!("{sample:?}"));
        if row % 1000 == 1 {
            // Ten sub-steps for each row before, five of this one.
            let mut then = expected.clone();
            then.pause(1.0, 5, Kind::Lifted);
            assert!(then.agrees(&sample.accounts), "row {row}: {:?}", sample.accounts);
        }
        expected.pause(1.0, 10, Kind::Lifted);
    }
    assert!(begin.elapsed() < Duration::from_secs(30), "{:?}", begin.elapsed());
    // A moment before the last one is told of as it was then.
    let moment = Moment { step: 30, time: active + 0.5, pause: Some(Kind::Lifted), sample: true, maps: false };
    assert_eq!(Some(format!("{:?}", simulation.sample_at(&moment, &[]).unwrap())), first);
}
