//! The pauses of a cycle, and the steps after which they come (model 9).

use super::{Cycle, Interval, Kind, Place};

/// A pause: an interval between two neighbouring nodes without load, or without speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pause {
    /// Start, s.
    pub start: f64,
    /// End, s.
    pub end: f64,
    /// Length, s: with all digits, which its times do not have after a long while.
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

    /// Tells whether a pause comes after the `number`-th step of angle `step` (rad).
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

    /// End, s, of the pauses that follow one another from `time` (s) on and begin by `until` (s); `time` where there are none.
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

    /// Time in pauses until a time (s), s.
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
#[path = "../../../tests/unit/model/cycle/pause.rs"]
mod tests;
