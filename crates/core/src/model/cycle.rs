//! Operation as a cycle of load and speed (model 9).
//!
//! Load F(t) and speed ω(t) are given at nodes. Steps are at equal angles ψ = ∫ω dt, counted where there is load and speed, and the load of a step is
//! such that Σ F̄ ds = r ∫F ω dt for every m. Every value comes in closed form from the two ends of an interval, the sums
//! over one round and the number of rounds: nothing is added up step by step, so nothing drifts, and nothing is read off a
//! time since the start, which many rounds or a long pause leave few digits of.

mod interval;
mod pause;

use std::f64::consts::TAU;
use std::iter;

use thiserror::Error;

use self::interval::Interval;
pub use self::interval::{Kind, Node};
pub use self::pause::Pause;
use crate::model::clock::StepOperation;

/// Part of a step below which an angle counts as reached: rounding must not put the end of a step behind the pause that begins with
/// it.
const SLACK: f64 = 1e-9;

/// Most intervals of a cycle: each event has a row in the run file, and there may be as many events as intervals.
const MOST_INTERVALS: u64 = 1_000_000;

/// Load and speed between two nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Values of the first node; the last node only ends the cycle.
    Hold,
}

/// Error in the table of a cycle. Rows are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum CycleError {
    #[error("fewer than two rows ({rows}), so there is no time between them")]
    Rows { rows: usize },
    #[error("a time of {time} s after {before} s: times begin with 0 and do not go back")]
    Time { row: usize, time: f64, before: f64 },
    #[error("a {quantity} of {value}, expected 0 or more")]
    Value { row: usize, quantity: &'static str, value: f64 },
    #[error("{intervals} intervals in all, expected at most {MOST_INTERVALS}: fewer rows, or a smaller repeat")]
    TooMany {
        /// Rows times rounds.
        intervals: u64,
    },
    #[error("nowhere between two rows is there load and speed, so no step would be taken")]
    Inactive,
}

/// A table of nodes, played so many times; the last of one round and the first of the next are at the same time.
#[derive(Debug, Clone, PartialEq)]
pub struct Cycle {
    intervals: Vec<Interval>,
    rounds: u64,
    /// Length of a round, s.
    period: f64,
    /// ψ of a round, rad.
    angle: f64,
}

/// A moment of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    round: u64,
    interval: usize,
    /// Time since the start of the interval, s.
    time: f64,
}

impl Cycle {
    /// The cycle that plays a table `rounds` times.
    ///
    /// # Errors
    /// [`CycleError`] when times go back, a value is negative, or no step would be taken.
    pub fn new(nodes: &[Node], interpolation: Interpolation, rounds: u64) -> Result<Self, CycleError> {
        check(nodes)?;
        let intervals = rounds.saturating_mul(nodes.len() as u64);
        if intervals > MOST_INTERVALS {
            return Err(CycleError::TooMany { intervals });
        }
        let mut intervals: Vec<Interval> = Vec::with_capacity(nodes.len());
        for pair in nodes.windows(2).filter(|pair| pair[1].time > pair[0].time) {
            let (start, mut end) = (pair[0], pair[1]);
            if interpolation == Interpolation::Hold {
                end = Node { time: end.time, ..start };
            }
            intervals.push(Interval::between(start, end, intervals.last()));
        }
        let angle = intervals.last().map_or(0.0, |last| last.angle);
        if angle == 0.0 {
            return Err(CycleError::Inactive);
        }
        Ok(Self { intervals, rounds, period: nodes[nodes.len() - 1].time, angle })
    }

    /// Duration of all rounds, s.
    pub fn duration(&self) -> f64 {
        self.rounds as f64 * self.period
    }

    /// F (N) and ω (rad/s) where both never change.
    pub fn constant(&self) -> Option<(f64, f64)> {
        let Node { force, speed, .. } = self.intervals[0].start;
        let mut ends = self.intervals.iter().flat_map(|interval| [interval.start, interval.end]);
        ends.all(|node| node.force == force && node.speed == speed).then_some((force, speed))
    }

    /// The largest F at any time, N.
    pub fn largest_force(&self) -> f64 {
        self.intervals.iter().flat_map(|interval| [interval.start.force, interval.end.force]).fold(0.0, f64::max)
    }

    /// ψ at a time (s), rad.
    pub fn angle_at(&self, time: f64) -> f64 {
        let Place { round, interval, time } = self.place(time);
        round as f64 * self.angle + self.intervals[interval].angle_after(time)
    }

    /// F and ω at a time (s), and the kind of its interval; at a jump, those of the later interval.
    pub fn at(&self, time: f64) -> (Node, Kind) {
        let Place { interval, time: since, .. } = self.place(time);
        let interval = &self.intervals[interval];
        (Node { time, ..interval.after(since) }, interval.kind)
    }

    /// Kind of the interval right before a time (s); at t = 0, of the first one.
    pub fn before(&self, time: f64) -> Kind {
        let Place { round, interval, time: since } = self.place(time);
        let is_first = (round, interval) == (0, 0);
        let count = self.intervals.len();
        let interval = if since > 0.0 || is_first { interval } else { (interval + count - 1) % count };
        self.intervals[interval].kind
    }

    /// Time for which the pin was on the disc until a time (s), moving or not, s.
    pub fn loaded_until(&self, time: f64) -> f64 {
        self.loaded_at(self.place(time))
    }

    /// Time on the disc until a time (s), since the first step began, s: before it no contact is known.
    pub fn contact_time_until(&self, time: f64) -> f64 {
        let first = self.intervals.iter().find(|interval| interval.kind == Kind::Active);
        (self.loaded_until(time) - first.map_or(0.0, |first| first.loaded_after(0.0))).max(0.0)
    }

    /// Distance that the vehicle travels until a time (s), m.
    pub fn road_distance_at(&self, time: f64) -> f64 {
        let Place { round, interval, time } = self.place(time);
        let whole = self.intervals.last().map_or(0.0, |last| last.road);
        round as f64 * whole + self.intervals[interval].road_after(time)
    }

    /// Time with load and speed in all rounds, s.
    pub fn active_time(&self) -> f64 {
        let active = self.intervals.iter().filter(|interval| interval.kind == Kind::Active);
        self.rounds as f64 * active.map(Interval::length).sum::<f64>()
    }

    /// F̄ of a step of angle `step` (rad), N, and ω at its end, rad/s; in a `pause` ω at a time (s), and no load if it is lifted.
    pub fn operation_at(&self, number: u64, step: f64, time: f64, pause: Option<Kind>) -> [f64; 2] {
        let load = if number == 0 || pause == Some(Kind::Lifted) { 0.0 } else { self.step(number, step).load };
        let speed = if pause.is_some() {
            self.at(time).0.speed
        } else {
            let Place { interval, time, .. } = self.reached(number, step);
            self.intervals[interval].after(time).speed
        };
        [load, speed]
    }

    /// Steps of angle `step` (rad) that are done at a time (s): floor(ψ/(m Δθ) + 1e-9).
    pub fn steps_done(&self, time: f64, step: f64) -> u64 {
        let angle = self.angle_at(time);
        ((angle + Self::slack(angle, step)) / step).floor() as u64
    }

    /// The first step of angle `step` (rad) that ends at a time (s) or later, or in whose pause that time is.
    pub fn steps_until(&self, time: f64, step: f64) -> u64 {
        Self::steps_to(self.angle_at(time), step)
    }

    /// The first step of angle `step` (rad) with whose end ψ has come to an angle (rad).
    pub fn steps_to(angle: f64, step: f64) -> u64 {
        ((angle - Self::slack(angle, step)) / step).ceil().max(0.0) as u64
    }

    /// t_n of the `number`-th step of angle `step` (rad), s.
    pub fn end_of(&self, number: u64, step: f64) -> f64 {
        self.time_of(self.reached(number, step))
    }

    /// The `number`-th step, from 1, of angle `step` (rad).
    pub fn step(&self, number: u64, step: f64) -> StepOperation {
        let (from, to) = (self.reached(number - 1, step), self.reached(number, step));
        let (mut turns, mut active) = (None, 0.0);
        for (place, end) in self.active_parts(from, to) {
            turns = turns.or(Some(place));
            active += end - place.time;
        }
        let [before, turns, after] = [from, turns.unwrap_or(to), to].map(|place| self.loaded_at(place));
        StepOperation {
            end: self.time_of(to),
            load: self.mean_load(number, step),
            standing_before: turns - before,
            loaded: after - turns,
            active,
        }
    }

    /// F̄ of the `number`-th step of angle `step` (rad), N: W is one of ψ alone, so no work is lost where the end of a step counts
    /// as that of an interval.
    fn mean_load(&self, number: u64, step: f64) -> f64 {
        let (from, to) = (self.turned_to(number - 1, step, 0.0), self.turned_to(number, step, 0.0));
        let (mut work, mut angle, mut only) = (0.0, 0.0, None);
        for (place, end) in self.active_parts(from, to) {
            let (force, turned) = self.intervals[place.interval].mean_force(place.time..end);
            // A load that never changes is that load, to the bit.
            only = if angle == 0.0 || only == Some(force) { Some(force) } else { None };
            work += force * turned;
            angle += turned;
        }
        // The last step may end a trace beyond the cycle.
        let beyond = self.angle_in_round(number, step, self.rounds);
        let part = if beyond > Self::rounding(number as f64 * step) { 1.0 - beyond / step } else { 1.0 };
        only.unwrap_or(work / angle) * part
    }

    /// The parts of the active intervals from one place to another: where each begins, and when it ends, s since the start of its
    /// interval.
    fn active_parts(&self, from: Place, to: Place) -> impl Iterator<Item = (Place, f64)> {
        let end = move |place: &Place| {
            let is_last = (place.round, place.interval) == (to.round, to.interval);
            if is_last { to.time } else { self.intervals[place.interval].length() }
        };
        let parts = self.path(from, to).map(move |place| (place, end(&place)));
        parts.filter(|(place, end)| self.intervals[place.interval].kind == Kind::Active && *end > place.time)
    }

    /// Tolerance of an angle (rad) for rounding, rad, in steps of angle `step` (rad).
    fn slack(angle: f64, step: f64) -> f64 {
        // Many steps on, the angle itself is rounded by more.
        (SLACK * step).max(Self::rounding(angle))
    }

    /// Largest rounding of an angle (rad), or a time (s), that is a multiple of a rounded one, in the same unit.
    fn rounding(multiple: f64) -> f64 {
        4.0 * f64::EPSILON * multiple
    }

    /// Finds the place at which so many steps of angle `step` (rad) are first done.
    fn reached(&self, number: u64, step: f64) -> Place {
        self.turned_to(number, step, Self::slack(number as f64 * step, step))
    }

    /// Finds the place at which the disc has first turned by so many steps of angle `step` (rad), or by less than `slack` (rad) less.
    fn turned_to(&self, number: u64, step: f64, slack: f64) -> Place {
        if number == 0 {
            return Place { round: 0, interval: 0, time: 0.0 };
        }
        let round = (((number as f64 * step - slack) / self.angle).ceil() - 1.0).clamp(0.0, (self.rounds - 1) as f64);
        let angle = self.angle_in_round(number, step, round as u64);
        let found = self.intervals.partition_point(|interval| interval.angle < angle - slack);
        let place = found.min(self.intervals.len() - 1);
        let interval = &self.intervals[place];
        // Where it hardly turns any more, little of an angle is much of time.
        let has_ended = interval.angle - angle <= Self::rounding(number as f64 * step);
        let time = if has_ended { interval.length() } else { interval.time_to(angle) };
        Place { round: round as u64, interval: place, time }
    }

    /// Angle by which so many steps of angle `step` (rad) turn the disc beyond so many whole rounds, rad: both products are
    /// taken with all their digits.
    fn angle_in_round(&self, number: u64, step: f64, round: u64) -> f64 {
        let (number, round) = (number as f64, round as f64);
        let (angle, before) = (number * step, round * self.angle);
        (angle - before) + (number.mul_add(step, -angle) - round.mul_add(self.angle, -before))
    }

    /// The places at which the intervals from one place to another begin, the first being that place itself.
    fn path(&self, from: Place, to: Place) -> impl Iterator<Item = Place> {
        let count = self.intervals.len();
        let next = move |place: &Place| {
            let (round, interval) = (place.round, place.interval);
            let next = if interval + 1 == count { (round + 1, 0) } else { (round, interval + 1) };
            (next <= (to.round, to.interval)).then_some(Place { round: next.0, interval: next.1, time: 0.0 })
        };
        iter::successors(Some(from), next)
    }

    /// Finds the place of a time (s); where two intervals meet, in the later one. A time that is the end of an interval but for rounding is
    /// that end.
    fn place(&self, time: f64) -> Place {
        let rounding = Self::rounding(time);
        let round = ((time + rounding) / self.period).floor().clamp(0.0, (self.rounds - 1) as f64);
        let within = (-round).mul_add(self.period, time);
        let found = self.intervals.partition_point(|interval| interval.end.time <= within + rounding);
        let Some(Interval { start, .. }) = self.intervals.get(found) else {
            let interval = self.intervals.len() - 1;
            return Place { round: round as u64, interval, time: self.intervals[interval].length() };
        };
        let since = within - start.time;
        Place { round: round as u64, interval: found, time: if since <= rounding { 0.0 } else { since } }
    }

    fn time_of(&self, place: Place) -> f64 {
        place.round as f64 * self.period + (self.intervals[place.interval].start.time + place.time)
    }

    fn loaded_at(&self, place: Place) -> f64 {
        let round = self.intervals.last().map_or(0.0, |last| last.loaded);
        place.round as f64 * round + self.intervals[place.interval].loaded_after(place.time)
    }
}

/// Refuses what is no table of a cycle.
fn check(nodes: &[Node]) -> Result<(), CycleError> {
    if nodes.len() < 2 {
        return Err(CycleError::Rows { rows: nodes.len() });
    }
    let mut before = 0.0;
    for (row, node) in nodes.iter().enumerate() {
        // The first row is the start of the run.
        let follows = if row == 0 { node.time == 0.0 } else { node.time >= before && node.time.is_finite() };
        if !follows {
            return Err(CycleError::Time { row, time: node.time, before });
        }
        for (quantity, value) in [("load", node.force), ("speed", node.speed)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(CycleError::Value { row, quantity, value });
            }
        }
        before = node.time;
    }
    Ok(())
}

/// Simulated revolutions below which an event is too short for its mean to say much.
const LEAST_REVOLUTIONS: f64 = 10.0;

/// A maximal stretch of active intervals, such as one stop of a car.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Time, F and ω at the start.
    pub start: Node,
    /// Time, F and ω at the end.
    pub end: Node,
    /// ψ at the start, rad.
    pub start_angle: f64,
    /// Angle by which the disc turns in the event, rad.
    pub angle: f64,
}

impl Cycle {
    /// The maximal stretches of active intervals until a time (s).
    pub fn events(&self, until: f64) -> Vec<Event> {
        let mut events: Vec<Event> = Vec::new();
        // The round and the angle in it, rad, with which the event begins that goes on.
        let mut open = None;
        let places = (0..self.rounds).flat_map(|round| self.intervals.iter().map(move |interval| (round, interval)));
        for (round, interval) in places {
            let before = round as f64 * self.period;
            let (start, rounding) = (before + interval.start.time, Self::rounding(until));
            if start >= until - rounding {
                break;
            }
            if interval.kind != Kind::Active {
                open = None;
                continue;
            }
            let is_whole = before + interval.end.time <= until + rounding;
            let end = if is_whole {
                Node { time: before + interval.end.time, ..interval.end }
            } else {
                Node { time: until, ..interval.after(until - start) }
            };
            let first = interval.angle - interval.turned();
            let (first_round, first) = *open.get_or_insert_with(|| {
                let start_angle = round as f64 * self.angle + first;
                events.push(Event { start: Node { time: start, ..interval.start }, end, start_angle, angle: 0.0 });
                (round, first)
            });
            let last = if is_whole { interval.angle } else { interval.angle_after(until - start) };
            if let Some(event) = events.last_mut() {
                event.end = end;
                event.angle = (round - first_round) as f64 * self.angle + (last - first);
            }
        }
        events
    }

    /// The largest m with which every event until a time (s) has ten simulated revolutions: below 1 none has.
    pub fn largest_acceleration(&self, until: f64) -> f64 {
        let angles = self.events(until).into_iter().map(|event| event.angle);
        angles.fold(f64::INFINITY, f64::min) / (LEAST_REVOLUTIONS * TAU)
    }

    /// Number of events until a time (s) with fewer than ten simulated revolutions at this acceleration.
    pub fn short_events(&self, until: f64, acceleration: f64) -> usize {
        let least = acceleration * LEAST_REVOLUTIONS * TAU * (1.0 - 1e-9);
        self.events(until).iter().filter(|event| event.angle < least).count()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/model/cycle.rs"]
mod tests;
