//! Closed forms of section 9 of docs/model.md.

use super::*;

fn node(time: f64, force: f64, speed: f64) -> Node {
    Node::new(time, force, speed)
}

fn linear(nodes: &[Node], rounds: u64) -> Cycle {
    Cycle::new(nodes, Interpolation::Linear, rounds).expect("a cycle")
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1e-3), "{found:e}, expected {expected:e}");
}

/// r ∫F ω dt over the active intervals without r, by Simpson's rule on each interval: exact, for F ω is quadratic there.
fn work(nodes: &[Node]) -> f64 {
    let part = |pair: &[Node]| {
        let [one, other] = [pair[0], pair[1]];
        let middle = (one.force + other.force) * (one.speed + other.speed) / 4.0;
        (other.time - one.time) * (one.force * one.speed + 4.0 * middle + other.force * other.speed) / 6.0
    };
    nodes.windows(2).map(part).sum()
}

const STOPS: [Node; 8] = [
    Node::new(0.0, 5.0, 30.0),
    Node::new(1.0, 9.0, 85.0),
    Node::new(2.0, 9.0, 85.0),
    Node::new(3.0, 0.0, 40.0),
    Node::new(4.0, 0.0, 40.0),
    Node::new(4.5, 7.0, 60.0),
    Node::new(5.0, 7.0, 0.0),
    Node::new(6.5, 3.0, 0.0),
];

#[test]
fn a_stop_takes_the_time_of_constant_deceleration() {
    // ω = 10 (1 - t/4): ψ = 10 t - 10 t²/8, so t = 4 - sqrt(16 - 0.8 ψ); 20 rad in all.
    let cycle = linear(&[node(0.0, 3.0, 10.0), node(4.0, 3.0, 0.0)], 1);
    assert_eq!(cycle.steps_done(4.0, 0.5), 40);
    for number in 1..=40 {
        let step = cycle.step(number, 0.5);
        near(step.end, 4.0 - (16.0 - 0.8 * 0.5 * number as f64).sqrt());
        assert_eq!(step.load, 3.0);
    }
    assert_eq!(cycle.end_of(40, 0.5), 4.0);
}

#[test]
fn the_work_of_all_steps_is_that_of_the_cycle() {
    for step in [0.1, 0.7, 3.0, 29.0] {
        for rounds in [1, 2, 5] {
            let cycle = linear(&STOPS, rounds);
            let steps = cycle.steps_done(cycle.duration(), step);
            let found: f64 = (1..=steps).map(|number| cycle.step(number, step).load * step).sum();
            let rest = cycle.angle_at(cycle.duration()) - steps as f64 * step;
            let expected = rounds as f64 * work(&STOPS);
            // What is left out is less than a step, under the load of the end.
            assert!((expected - found - 7.0 * rest).abs() < 7.0 * step, "{step} {rounds}");
            if rest < 1e-9 * step {
                near(found, expected);
            }
        }
    }
    // A step that divides a round: 57.5 + 85 + 62.5 + 25 + 15 rad.
    let cycle = linear(&STOPS, 3);
    near(cycle.angle_at(cycle.duration()), 3.0 * 245.0);
    let found: f64 = (1..=3 * 49).map(|number| cycle.step(number, 5.0).load * 5.0).sum();
    near(found, 3.0 * work(&STOPS));
}

#[test]
fn steps_and_angles_are_inverse() {
    let cycle = linear(&STOPS, 3);
    for step in [0.01, 0.3, 41.0] {
        for number in 1..=cycle.steps_done(cycle.duration(), step) {
            let end = cycle.end_of(number, step);
            assert!((cycle.angle_at(end) / step - number as f64).abs() < 1e-9, "step {number} of {step}");
            assert_eq!(cycle.steps_until(end, step), number);
            assert!(cycle.end_of(number - 1, step) < end);
        }
    }
}

#[test]
fn a_pause_is_of_the_step_that_ends_before_it_or_goes_on_through_it() {
    // 10 rad in a second, a second of rest, twice.
    let table = [node(0.0, 2.0, 10.0), node(1.0, 2.0, 10.0), node(1.0, 0.0, 10.0), node(2.0, 0.0, 10.0)];
    let cycle = linear(&table, 2);
    assert_eq!(cycle.duration(), 4.0);
    // The end of a step that comes to the pause is before it, however the angle is rounded.
    for step in [0.1, 1.0 / 3.0, 1.0, 10.0 / 7.0] {
        let steps = (10.0_f64 / step).round() as u64;
        near(cycle.end_of(steps, step), 1.0);
        assert!(cycle.end_of(steps + 1, step) > 2.0);
        assert_eq!(cycle.steps_until(1.5, step), steps);
        near(cycle.end_of(2 * steps, step), 3.0);
        assert_eq!(cycle.steps_done(4.0, step), 2 * steps);
    }
    // Steps of 4 rad: the third has 2 rad before the pause and 2 after it.
    near(cycle.end_of(3, 4.0), 2.2);
    assert_eq!([1.0, 1.5, 1.999].map(|time| cycle.steps_until(time, 4.0)), [3; 3]);
    assert_eq!(cycle.step(3, 4.0).load, 2.0);
    near(cycle.step(3, 4.0).loaded, 0.4);
    assert_eq!(cycle.at(1.5).1, Kind::Lifted);
}

#[test]
fn time_under_load_counts_standing_and_not_lifted_pauses() {
    // Standing for 2 s before it turns at all, then 1 s of turning, lifted for 1 s, 1 s of turning, standing for 3 s.
    let nodes = [
        node(0.0, 4.0, 0.0),
        node(2.0, 4.0, 0.0),
        node(2.0, 4.0, 1.0),
        node(3.0, 4.0, 1.0),
        node(3.0, 0.0, 1.0),
        node(4.0, 0.0, 1.0),
        node(4.0, 4.0, 1.0),
        node(5.0, 4.0, 1.0),
        node(5.0, 4.0, 0.0),
        node(8.0, 4.0, 0.0),
    ];
    let cycle = linear(&nodes, 2);
    let (first, second, third) = (cycle.step(1, 1.5), cycle.step(2, 1.5), cycle.step(3, 0.9));
    assert_eq!((first.standing_before, first.loaded, first.end), (2.0, 1.5, 4.5));
    // Half a second of the first round, then 3 s and 2 s of standing, then a second of the next round.
    assert_eq!((second.standing_before, second.loaded, second.end), (0.0, 6.5, 11.0));
    assert_eq!(third.standing_before, 0.0);
    assert_eq!(cycle.loaded_until(16.0), 14.0);
    // The 2 s before the first step are no time in contact; those before the second round are.
    assert_eq!([1.0, 2.0, 2.5, 10.0, 16.0].map(|time| cycle.contact_time_until(time)), [0.0, 0.0, 0.5, 7.0, 12.0]);
    // Lifted, then standing, before it turns.
    let late =
        [node(0.0, 0.0, 0.0), node(3.0, 0.0, 0.0), node(3.0, 4.0, 0.0), node(5.0, 4.0, 0.0), node(7.0, 4.0, 1.0)];
    assert_eq!([4.0, 6.0].map(|time| linear(&late, 1).contact_time_until(time)), [0.0, 1.0]);
    let kinds = [1.0, 2.5, 3.5, 4.5, 6.0, 9.0].map(|time| cycle.at(time).1);
    let [standing, lifted, active] = [Kind::Standing, Kind::Lifted, Kind::Active];
    assert_eq!(kinds, [standing, active, lifted, active, standing, standing]);
}

#[test]
fn rows_that_hold_their_values_make_a_staircase() {
    let rows = [node(0.0, 1.0, 2.0), node(1.0, 5.0, 4.0), node(1.0, 3.0, 4.0), node(3.0, 9.0, 9.0)];
    let cycle = Cycle::new(&rows, Interpolation::Hold, 1).expect("a cycle");
    near(cycle.angle_at(3.0), 2.0 + 8.0);
    // One step over the jump: 1 rad under 1 N and 3 rad under 3 N.
    near(cycle.step(1, 1.0).load, 1.0);
    near(cycle.step(1, 4.0).load, 2.0);
    assert_eq!(cycle.step(4, 2.0).load, 3.0);
    assert_eq!(cycle.largest_force(), 3.0);
}

#[test]
fn what_never_changes_is_constant() {
    let rows = [node(0.0, 47.0, 89.0), node(2.0, 47.0, 89.0), node(2.0, 47.0, 89.0), node(7.0, 47.0, 89.0)];
    assert_eq!(linear(&rows, 3).constant(), Some((47.0, 89.0)));
    assert_eq!(linear(&STOPS, 1).constant(), None);
}

#[test]
fn events_are_the_longest_active_stretches() {
    let cycle = linear(&STOPS, 2);
    let spans: Vec<_> = cycle.events(12.0).iter().map(|event| [event.start.time, event.end.time]).collect();
    assert_eq!(spans, [[0.0, 3.0], [4.0, 5.0], [6.5, 9.5], [10.5, 11.5]]);
    let stop = cycle.events(12.0)[1];
    assert_eq!((stop.start.speed, stop.end.speed), (40.0, 0.0));
    // A run that ends within one, and a round that goes on where the last ended.
    assert_eq!(cycle.events(2.0), [Event { start: STOPS[0], end: STOPS[2], start_angle: 0.0, angle: 57.5 + 85.0 }]);
    let drag = [node(0.0, 1.0, 1.0), node(1.0, 2.0, 1.0)];
    assert_eq!(linear(&drag, 4).events(9.0).len(), 1);
    // The shortest turns the disc by 25 rad and 15 rad of the 20π rad of ten revolutions.
    near(cycle.largest_acceleration(12.0), 2.0 / std::f64::consts::PI);
    assert_eq!([0.63, 0.64].map(|m| cycle.short_events(12.0, m)), [0, 2]);
}

#[test]
fn what_is_no_cycle_is_refused_with_its_row() {
    let refused = |nodes: &[Node]| Cycle::new(nodes, Interpolation::Linear, 1).expect_err("no cycle");
    assert_eq!(refused(&[node(0.0, 1.0, 1.0)]), CycleError::Rows { rows: 1 });
    assert_eq!(
        refused(&[node(1.0, 1.0, 1.0), node(2.0, 1.0, 1.0)]),
        CycleError::Time { row: 0, time: 1.0, before: 0.0 }
    );
    let drag = [node(0.0, 1.0, 1.0), node(1.0, 1.0, 1.0)];
    assert_eq!(Cycle::new(&drag, Interpolation::Linear, u64::MAX), Err(CycleError::TooMany { intervals: u64::MAX }));
    let back = [node(0.0, 1.0, 1.0), node(2.0, 1.0, 1.0), node(1.5, 1.0, 1.0)];
    assert_eq!(refused(&back), CycleError::Time { row: 2, time: 1.5, before: 2.0 });
    let negative = [node(0.0, 1.0, 1.0), node(2.0, -1.0, 1.0)];
    assert_eq!(refused(&negative), CycleError::Value { row: 1, quantity: "load", value: -1.0 });
    assert!(matches!(refused(&[node(0.0, 1.0, 1.0), node(2.0, 1.0, f64::NAN)]), CycleError::Value { row: 1, .. }));
    assert_eq!(
        refused(&[node(0.0, 1.0, 0.0), node(2.0, 1.0, 0.0), node(2.0, 0.0, 1.0), node(3.0, 0.0, 1.0)]),
        CycleError::Inactive
    );
}

#[test]
fn a_vehicle_travels_in_pauses_too() {
    // 10 m/s, then down to 4 m/s without load, by the trapezoidal rule: 20 m and 14 m a round.
    let row = |time, force, road_speed| Node { road_speed, ..node(time, force, 3.0) };
    let cycle = linear(&[row(0.0, 1.0, 10.0), row(2.0, 1.0, 10.0), row(2.0, 0.0, 10.0), row(4.0, 0.0, 4.0)], 2);
    near(cycle.road_distance_at(1.0), 10.0);
    // Half of the way down: 10 m/s to 7 m/s in a second.
    near(cycle.road_distance_at(3.0), 28.5);
    near(cycle.road_distance_at(8.0), 68.0);
    assert_eq!(cycle.active_time(), 4.0);
}

#[test]
fn load_and_speed_are_told_of_a_step_or_of_the_pause_after_it() {
    let cycle = linear(&STOPS, 1);
    // 30 to 85 rad/s in the first second: 57.5 rad; F̄ of the whole is the work over the angle.
    let [load, speed] = cycle.operation_at(1, 57.5, 1.0, None);
    near(load, (2.0 * 5.0 * 30.0 + 2.0 * 9.0 * 85.0 + 5.0 * 85.0 + 9.0 * 30.0) / 6.0 / 57.5);
    near(speed, 85.0);
    let step = cycle.steps_until(3.5, 5.0);
    assert_eq!(cycle.operation_at(step, 5.0, 3.5, Some(Kind::Lifted)), [0.0, 40.0]);
    let step = cycle.steps_until(6.0, 5.0);
    assert_eq!(cycle.operation_at(step, 5.0, 6.0, Some(Kind::Standing)), [7.0, 0.0]);
}

/// Steps, events and their angles of a table of 6 rad under load and a long pause, before or after it.
#[test]
fn no_step_and_no_angle_is_lost_over_many_rounds_and_long_pauses() {
    for (rounds, period) in [(30, 86401.3), (7, 100_001.1), (211, 12_345.678), (3, 1e8 + 0.1), (5, 1e9 + 1.3)] {
        // As the table has them, there are 1.0 s and 6 rad of it; a node that is not rounded there.
        let late = period - 1.0;
        let length = period - late;
        let before = [node(0.0, 0.0, 0.0), node(late, 0.0, 0.0), node(late, 3.0, 6.0), node(period, 3.0, 6.0)];
        let after = [node(0.0, 3.0, 6.0), node(1.0, 3.0, 6.0), node(1.0, 0.0, 0.0), node(period, 0.0, 0.0)];
        for (nodes, length) in [(before, length), (after, 1.0)] {
            let (cycle, what) = (linear(&nodes, rounds), format!("{rounds} times {period} s"));
            let step = 6.0 * length / 60.0;
            assert_eq!(cycle.steps_done(cycle.duration(), step), 60 * rounds, "{what}");
            let events = cycle.events(cycle.duration());
            assert_eq!(events.len() as u64, rounds, "{what}");
            for (round, event) in events.iter().enumerate() {
                near(event.angle, 6.0 * length);
                let steps = [event.start_angle, event.start_angle + event.angle].map(|at| Cycle::steps_to(at, step));
                assert_eq!(steps, [60 * round as u64, 60 * (round as u64 + 1)], "{what}");
                // A time between two intervals is that, however it is rounded.
                near(cycle.angle_at(event.start.time), 6.0 * length * round as f64);
                near(cycle.angle_at(event.end.time), 6.0 * length * (round + 1) as f64);
            }
        }
    }
}

/// The end of a step counts as that of an interval if it is 1e-9 of a step from it; its work is taken to the last digit.
#[test]
fn no_work_is_lost_where_the_end_of_a_step_is_rounded_to_that_of_an_interval() {
    for short in [5e-11, -5e-11, 9e-11, 0.0] {
        let (early, late) = (10.0 * (1.0 - short), 10.0 * (1.0 + short));
        let nodes = [
            node(0.0, 1.0, 1.0),
            node(early, 1.0, 1.0),
            node(early, 0.0, 0.0),
            node(20.0, 0.0, 0.0),
            node(20.0, 100.0, 1.0),
            node(20.0 + late, 50.0, 1.0),
        ];
        let cycle = linear(&nodes, 3);
        assert_eq!(cycle.steps_done(cycle.duration(), 1.0), 60);
        assert!((cycle.end_of(10, 1.0) - early).abs() < 1e-9);
        let found: f64 = (1..=60).map(|number| cycle.step(number, 1.0).load).sum();
        let expected = 3.0 * (early + 75.0 * late);
        assert!((found / expected - 1.0).abs() < 1e-13, "{short}: {found}, expected {expected}");
    }
    // The last step ends 5e-10 of a step beyond the cycle: there is no more work than that of the cycle.
    let cycle = linear(&[node(0.0, 3.0, 1.0), node(1.0 - 5e-10, 3.0, 1.0)], 1);
    assert_eq!(cycle.steps_done(1.0, 1.0), 1);
    near(cycle.step(1, 1.0).load, 3.0 * (1.0 - 5e-10));
}
