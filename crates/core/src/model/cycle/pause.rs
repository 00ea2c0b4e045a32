//! The pauses of a cycle, and the steps after which they come (model 9).

use super::{Cycle, Interval, Kind, Place};

/// A pause: an interval between two neighbouring nodes without load, or without speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pause {
    /// When it begins, s.
    pub start: f64,
    /// When it ends, s.
    pub end: f64,
    /// How long it is, s: with all digits, which its times do not have after a long while.
    pub length: f64,
    /// Lifted or standing.
    pub kind: Kind,
    /// Mean ω, rad/s: a disc under lifted pads turns with the wheel.
    pub speed: f64,
}

impl Cycle {
    /// The pauses that come after the contact of the `number`-th step of angle `step` (rad): those within it, and those
    /// that begin with its end; for number 0 those before the first step.
    pub fn pauses_after(&self, number: u64, step: f64) -> Vec<Pause> {
        self.resting_after(number, step).map(|place| self.pause(place)).collect()
    }

    /// Whether there are any.
    pub fn has_pause_after(&self, number: u64, step: f64) -> bool {
        self.resting_after(number, step).next().is_some()
    }

    /// The first pause that ends after a time (s) and begins at another or before it.
    pub fn pause_in(&self, time: f64, until: f64) -> Option<Pause> {
        let last = Place { round: self.rounds - 1, interval: self.intervals.len() - 1, time: 0.0 };
        let places = self.path(self.place(time), last);
        let mut pauses = places.map(|place| self.pause(place)).take_while(|pause| pause.start <= until);
        pauses.find(|pause| pause.kind != Kind::Active && pause.end > time)
    }

    /// When the last of the pauses ends, s, that follow one another from the one at a time (s) on and begin until another.
    pub fn rests_to(&self, time: f64, until: f64) -> f64 {
        let last = Place { round: self.rounds - 1, interval: self.intervals.len() - 1, time: 0.0 };
        let pauses = self.path(self.place(time), last).map(|place| self.pause(place));
        let rest = pauses.take_while(|pause| pause.kind != Kind::Active && pause.start <= until);
        rest.last().map_or(time, |pause| pause.end)
    }

    /// The last time up to a time (s) that lies in a pause, or ends one, s; 0 where there is none.
    pub fn rested_until(&self, time: f64) -> f64 {
        let Place { round, interval, time: since } = self.place(time);
        let rests = |interval: &Interval| interval.kind != Kind::Active;
        if since > 0.0 && rests(&self.intervals[interval]) {
            return time;
        }
        let last = |intervals: &[Interval]| {
            intervals.iter().rev().find(|interval| rests(interval)).map(|pause| pause.end.time)
        };
        let before = last(&self.intervals[..interval]).map(|end| (round, end));
        let found = before.or_else(|| Some((round.checked_sub(1)?, last(&self.intervals)?)));
        found.map_or(0.0, |(round, end)| round as f64 * self.period + end)
    }

    /// For how long there was a pause until a time (s), s.
    pub fn resting_until(&self, time: f64) -> f64 {
        let Place { round, interval, time: since } = self.place(time);
        let of = |interval: &Interval| if interval.kind == Kind::Active { 0.0 } else { interval.length() };
        let within: f64 = self.intervals[..interval].iter().map(of).sum();
        let last = if self.intervals[interval].kind == Kind::Active { 0.0 } else { since };
        round as f64 * self.intervals.iter().map(of).sum::<f64>() + within + last
    }

    fn resting_after(&self, number: u64, step: f64) -> impl Iterator<Item = Place> {
        // Until when a step counts as ended: as for the ends of steps.
        let is_after = move |place: &Place, number: u64| {
            let angle = self.intervals[place.interval].angle;
            angle - self.angle_in_round(number, step, place.round) > Self::slack(number as f64 * step, step)
        };
        let last = Place { round: self.rounds - 1, interval: self.intervals.len() - 1, time: 0.0 };
        let before = number.saturating_sub(1);
        self.path(self.reached(before, step), last)
            .skip_while(move |place| number > 0 && !is_after(place, before))
            .take_while(move |place| !is_after(place, number))
            .filter(|place| self.intervals[place.interval].kind != Kind::Active)
    }

    fn pause(&self, Place { round, interval, .. }: Place) -> Pause {
        let (before, interval) = (round as f64 * self.period, &self.intervals[interval]);
        let [start, end] = [interval.start, interval.end].map(|node| before + node.time);
        let speed = (interval.start.speed + interval.end.speed) / 2.0;
        Pause { start, end, length: interval.length(), kind: interval.kind, speed }
    }
}

#[cfg(test)]
mod tests {
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
}
