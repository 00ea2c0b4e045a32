use super::*;
use crate::model::cycle::{Interpolation, Node};

/// Every row holds until the next: lifted for 1 s, 2 rad, standing for 1 s, 1.5 rad, lifted for 0.5 s, standing for
/// 1 s, 0.5 rad, standing for 0.5 s. 4 rad and 8 s in all.
fn cycle(rounds: u64) -> Cycle {
    let rows = [
        (0.0, 0.0, 1.0),
        (1.0, 1.0, 1.0),
        (3.0, 1.0, 0.0),
        (4.0, 1.0, 1.0),
        (5.5, 0.0, 1.0),
        (6.0, 1.0, 0.0),
        (7.0, 1.0, 1.0),
        (7.5, 1.0, 0.0),
        (8.0, 0.0, 0.0),
    ];
    let nodes = rows.map(|(time, force, speed)| Node::new(time, force, speed));
    Cycle::new(&nodes, Interpolation::Hold, rounds).unwrap()
}

/// The pauses of a round from its start on, and the angle at which they are, rad.
const PAUSES: [(f64, f64, Kind, f64); 5] = [
    (0.0, 1.0, Kind::Lifted, 0.0),
    (3.0, 4.0, Kind::Standing, 2.0),
    (5.5, 6.0, Kind::Lifted, 3.5),
    (6.0, 7.0, Kind::Standing, 3.5),
    (7.5, 8.0, Kind::Standing, 4.0),
];

/// Start and end of the pauses after a step, s.
fn after(cycle: &Cycle, number: u64, step: f64) -> Vec<[f64; 2]> {
    let pauses = cycle.pauses_after(number, step);
    assert_eq!(cycle.has_pause_after(number, step), !pauses.is_empty());
    pauses.iter().map(|pause| [pause.start, pause.end]).collect()
}

#[test]
fn a_pause_comes_after_the_step_that_it_lies_in_or_begins_with_the_end_of() {
    let cycle = cycle(2);
    let found: Vec<_> = (0..=9).map(|number| after(&cycle, number, 1.0)).collect();
    let none = Vec::new;
    // The last pause of the first round and the first of the second come after the same step.
    let fourth = vec![[5.5, 6.0], [6.0, 7.0], [7.5, 8.0], [8.0, 9.0]];
    let last = vec![[13.5, 14.0], [14.0, 15.0], [15.5, 16.0]];
    let [leading, second, sixth] = [[0.0, 1.0], [3.0, 4.0], [11.0, 12.0]].map(|pause| vec![pause]);
    assert_eq!(found, [leading, none(), second, none(), fourth, none(), sixth, none(), last, none()]);
    let kinds: Vec<Kind> = cycle.pauses_after(4, 1.0).iter().map(|pause| pause.kind).collect();
    assert_eq!(kinds, [Kind::Lifted, Kind::Standing, Kind::Standing, Kind::Lifted]);
    // One step for all of a round, and one that is not done when the cycle ends.
    assert_eq!(after(&cycle, 1, 4.0).len(), 5);
    assert_eq!((after(&cycle, 1, 7.0).len(), after(&cycle, 2, 7.0).len()), (6, 3));
}

#[test]
fn every_pause_of_all_rounds_is_of_one_step() {
    for (rounds, step) in
        [(50, 0.3), (50, 1.0 / 3.0), (300, 0.1), (50, 0.7), (20, std::f64::consts::PI / 100.0), (50, 9.0)]
    {
        let cycle = cycle(rounds);
        let steps = (cycle.angle_at(cycle.duration()) / step).ceil() as u64 + 1;
        let found: Vec<Pause> = (0..=steps).flat_map(|number| cycle.pauses_after(number, step)).collect();
        let expected: Vec<Pause> = (0..rounds)
            .flat_map(|round| PAUSES.map(|pause| (round as f64 * 8.0, pause)))
            .map(|(round, (start, end, kind, _))| Pause {
                start: round + start,
                end: round + end,
                length: end - start,
                kind,
                // As in the rows.
                speed: if kind == Kind::Lifted { 1.0 } else { 0.0 },
            })
            .collect();
        assert_eq!(found, expected, "{rounds} rounds in steps of {step} rad");
    }
}

#[test]
fn a_pause_that_begins_with_the_end_of_a_step_does_so_many_steps_on() {
    let cycle = cycle(100_000);
    let rounds: Vec<u64> = (0..1000).chain((1000..100_000).step_by(997)).chain([99_998, 99_999]).collect();
    // So many steps a round: their angle is rounded in another way each.
    for steps in [40, 2200, 3400] {
        let step = 4.0 / steps as f64;
        for (round, (start, end, _, angle)) in
            rounds.iter().flat_map(|round| PAUSES[1..4].iter().map(move |pause| (round, pause)))
        {
            let number = steps * round + (angle / step).round() as u64;
            let [start, end] = [start, end].map(|time| 8.0 * *round as f64 + time);
            assert!(after(&cycle, number, step).contains(&[start, end]), "{number}");
            assert!(after(&cycle, number - 1, step).is_empty() && after(&cycle, number + 1, step).is_empty());
            // Samples take the same step for it.
            assert_eq!(cycle.steps_until((start + end) / 2.0, step), number);
        }
    }
}
