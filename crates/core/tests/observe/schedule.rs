//! When samples and maps of runs with a cycle are due.

use std::f64::consts::PI;
use std::sync::Arc;

use plateau_core::model::cycle::{Cycle, Interpolation, Node};
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::Parameters;
use plateau_core::observe::schedule::{End, Moment, SampleEvery, Schedule};

/// A cycle of these times and forces at one speed, so many times, on two columns with m = 1: a step is half a turn.
fn with_cycle(nodes: &[(f64, f64)], speed: f64, rounds: u64) -> Parameters {
    let nodes: Vec<Node> = nodes.iter().map(|(time, force)| Node::new(*time, *force, speed)).collect();
    let cycle = Cycle::new(&nodes, Interpolation::Linear, rounds).unwrap();
    let mesh = Mesh::new(1, 2, 1, 1.0, 2.0).unwrap();
    Parameters { mesh, time_acceleration: 1.0, cycle: Some(Arc::new(cycle)), ..Parameters::paper() }
}

/// The same once, at 1 rad/s and in steps of 1 rad.
fn in_radians(nodes: &[(f64, f64)]) -> Parameters {
    Parameters { time_acceleration: 1.0 / PI, ..with_cycle(nodes, 1.0, 1) }
}

/// 1 rad/s for 2 s, lifted for 2 s, 1 rad/s for 1.5 s, in steps of 1 rad.
fn schedule(end: f64, sample_every: SampleEvery, maps_at: &[f64]) -> Schedule {
    let parameters = in_radians(&[(0.0, 1.0), (2.0, 1.0), (2.0, 0.0), (4.0, 0.0), (4.0, 1.0), (5.5, 1.0)]);
    Schedule::new(&parameters, End::Time(end), sample_every, maps_at)
}

/// The moments after a step and a time, to the end.
fn after(schedule: &Schedule, step: u64, time: f64) -> impl Iterator<Item = Moment> {
    std::iter::successors(schedule.next(step, time), |moment| schedule.next(moment.step, moment.time))
}

/// Every moment from the start to the end: its step and time, and what is due.
fn moments(schedule: &Schedule) -> Vec<(u64, f64, bool, bool)> {
    let moments = after(schedule, 0, 0.0).take(100).inspect(|moment| {
        assert_eq!(moment.pause.is_some(), moment.time > 2.0 && moment.time <= 4.0, "{moment:?}");
    });
    moments.map(|moment| (moment.step, moment.time, moment.sample, moment.maps)).collect()
}

#[test]
fn the_number_of_samples_is_that_of_the_moments() {
    // Steps of 35 ms or so: the last one is that of the last multiple, or comes after it, or there is none.
    let parameters = Parameters { time_acceleration: 1370.0, ..Parameters::paper() };
    for (end, every) in [(100.0, 0.5), (100.0, 0.7), (20.0, 3.0), (1.0, 2.0), (2.0, 0.01), (3.0, 0.0353)] {
        let schedule = Schedule::new(&parameters, End::Time(end), SampleEvery::Time(every), &[]);
        let count = after(&schedule, 0, 0.0).filter(|moment| moment.sample).count();
        assert_eq!(schedule.samples(), count as u64, "{end} s, every {every} s");
    }
}

#[test]
fn samples_in_a_pause_have_their_own_time() {
    let every = SampleEvery::Time(0.75);
    let times = |end| moments(&schedule(end, every, &[])).iter().map(|moment| (moment.0, moment.1)).collect::<Vec<_>>();
    let pause = [(1, 1.0), (2, 2.0), (2, 2.25), (2, 3.0), (2, 3.75)];
    assert_eq!(times(5.5), [&pause[..], &[(3, 5.0)]].concat());
    // A run that ends in the pause has a sample then.
    assert_eq!(times(3.5), [&pause[..4], &[(2, 3.5)]].concat());
    assert_eq!(times(4.0), [&pause[..], &[(2, 4.0)]].concat());
}

#[test]
fn a_sample_before_a_pause_within_a_step_takes_none_of_the_pause() {
    // Steps of 1 rad end at 1, 2, 4.5 and 5.5 s: the pause from 2.5 s to 4 s lies within the third.
    let parameters = in_radians(&[(0.0, 1.0), (2.5, 1.0), (2.5, 0.0), (4.0, 0.0), (4.0, 1.0), (6.0, 1.0)]);
    let moments = |every: f64, end: f64, (step, time): (u64, f64)| {
        let schedule = Schedule::new(&parameters, End::Time(end), SampleEvery::Time(every), &[]);
        after(&schedule, step, time).take(100).map(|moment| (moment.step, moment.time)).collect::<Vec<_>>()
    };
    // 2.4 s is due at 4.5 s, but after what is due in the pause; 4.2 s has the same step.
    let expected = [(2, 2.0), (3, 3.0), (3, 3.6), (3, 4.5), (4, 5.5)];
    let found = moments(0.6, 6.0, (1, 1.0));
    assert!(found.iter().zip(expected).all(|(one, other)| one.0 == other.0 && (one.1 - other.1).abs() < 1e-12));
    assert_eq!(found.len(), expected.len());
    // A run that ended in the pause, before the step around it, goes on from there: no time comes twice or goes back.
    let ended = moments(0.6, 3.3, (1, 1.0));
    assert_eq!(ended.last(), Some(&(2, 3.3)));
    let gone_on = moments(0.6, 6.0, (2, 3.3));
    assert!(gone_on[0].0 == 3 && (gone_on[0].1 - 3.6).abs() < 1e-12 && gone_on.len() == 3, "{gone_on:?}");
}

#[test]
fn maps_and_steps_are_due_in_order_of_time() {
    let found = moments(&schedule(5.5, SampleEvery::Steps(2), &[0.0, 1.5, 2.5]));
    assert_eq!(found, [(2, 2.0, true, true), (2, 2.5, false, true), (3, 5.0, true, true)]);
    let found = moments(&schedule(3.5, SampleEvery::Steps(2), &[]));
    assert_eq!(found, [(2, 2.0, true, false), (2, 3.5, true, true)]);
}

/// The end of a step that is rounded to just before the pause that begins with it takes none of the pause either.
#[test]
fn a_pause_that_begins_with_the_end_of_a_step_has_all_its_samples() {
    for speed in [400.0 * (2.0 * PI) / 60.0, 400.0 * (2.0 * PI / 60.0)] {
        let nodes = [(0.0, 5.0), (10.0, 5.0), (10.0, 0.0), (14.0, 0.0), (14.0, 10.0), (17.0, 10.0)];
        let mesh = Mesh::new(1, 690, 40, 0.020, 0.021).unwrap();
        let parameters = Parameters { mesh, time_acceleration: 40.0, ..with_cycle(&nodes, speed, 1) };
        let schedule = Schedule::new(&parameters, End::Time(17.0), SampleEvery::Time(0.1), &[]);
        let in_pause = after(&schedule, 0, 0.0).filter(|moment| moment.time > 10.05 && moment.time < 13.95);
        assert_eq!(in_pause.count(), 39);
    }
}

/// Stops of a second with a pause of nine: every multiple of 10 s is in a pause, so none is that of a step. To look at all that
/// remain for each would take hours.
#[test]
fn multiples_that_all_lie_in_pauses_are_found_one_after_the_other() {
    let nodes = [(0.0, 0.0), (5.0, 0.0), (5.0, 1.0), (6.0, 1.0), (6.0, 0.0), (10.0, 0.0)];
    let rounds = 150_000;
    let parameters = with_cycle(&nodes, PI, rounds);
    let schedule = Schedule::new(&parameters, End::Time(10.0 * rounds as f64), SampleEvery::Time(10.0), &[]);
    let mut count = 0;
    for moment in after(&schedule, 0, 0.0) {
        count += 1;
        assert_eq!((moment.step, moment.time), (count, 10.0 * count as f64));
    }
    assert_eq!(count, rounds);
}

/// A pause of which the table has many rows, within a step: 0.5 rad before it, and 0.5 rad after it.
#[test]
fn every_multiple_in_a_pause_of_many_rows_within_a_step_has_its_sample() {
    let rows = 100_u32;
    let mut nodes = vec![(0.0, 1.0), (0.5, 1.0)];
    nodes.extend((0..=rows).map(|row| (0.5 + f64::from(row), 0.0)));
    nodes.extend([1.0, 3.0].map(|more| (0.5 + f64::from(rows) + more - 1.0, 1.0)));
    let parameters = in_radians(&nodes);
    let end = parameters.cycle.as_ref().unwrap().duration();
    let schedule = Schedule::new(&parameters, End::Time(end), SampleEvery::Time(0.25), &[]);
    let (mut now, mut count) = ((0, 0.0), 0);
    for moment in after(&schedule, 0, 0.0) {
        assert!(moment.time > now.1 || count == 0, "{moment:?}");
        now = (moment.step, moment.time);
        count += u32::from(moment.pause.is_some());
    }
    // From 0.5 s on, before the pause ends, and the step that 0.25 s is due with.
    assert_eq!(count, 4 * rows);
    assert_eq!(now.0, 2);
}
