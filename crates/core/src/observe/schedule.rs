//! Times of samples and maps (docs/run-file.md).

use std::sync::Arc;

use crate::model::clock::Clock;
use crate::model::cycle::{Cycle, Kind};
use crate::model::parameters::Parameters;

/// Interval between samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SampleEvery {
    /// Physical time, s.
    Time(f64),
    /// Simulated steps, at least 1.
    Steps(u64),
}

/// End of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// Physical time, s.
    Time(f64),
    /// Simulated steps.
    Steps(u64),
}

/// A moment at which a sample or maps are due.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moment {
    /// The step whose surfaces are meant.
    pub step: u64,
    /// t, s: the end of that step, or a time within a pause before or after it.
    pub time: f64,
    /// The kind of that pause.
    pub pause: Option<Kind>,
    /// True if a sample is due.
    pub sample: bool,
    /// True if maps are due.
    pub maps: bool,
}

/// The moments at which samples or maps are due.
#[derive(Debug, Clone)]
pub struct Schedule {
    clock: Clock,
    /// The cycle and the angle of a step, rad.
    cycle: Option<(Arc<Cycle>, f64)>,
    sample_every: SampleEvery,
    end: End,
    /// The last step.
    last: u64,
    maps_at: Vec<f64>,
    /// Moments at which maps are due, as step and time (s), in the order of time; the end of the run is always among them.
    map_moments: Vec<(u64, f64)>,
}

impl Schedule {
    /// Plans samples and the maps of the physical times `maps_at` (s) until `end`; times beyond it fall on the end.
    pub fn new(parameters: &Parameters, end: End, sample_every: SampleEvery, maps_at: &[f64]) -> Self {
        let cycle = parameters.cycle.clone().map(|cycle| (cycle, parameters.step_angle()));
        let clock = parameters.clock();
        let (maps_at, map_moments) = (maps_at.to_vec(), Vec::new());
        let mut schedule = Self { clock, cycle, sample_every, end, last: 0, maps_at, map_moments };
        schedule.plan();
        schedule
    }

    /// Plans anew what lies ahead where steps take `step_time` (s) after `step`.
    pub fn change(&mut self, step: u64, step_time: f64) {
        self.clock = self.clock.changed(step, step_time);
        self.plan();
    }

    /// Plans anew for a run that goes on and whose clock is this one.
    pub fn go_on(&mut self, clock: Clock) {
        self.clock = clock;
        self.plan();
    }

    fn plan(&mut self) {
        self.last = match (self.end, &self.cycle) {
            (End::Steps(steps), _) => steps,
            (End::Time(time), Some((cycle, step))) => cycle.steps_done(time, *step),
            (End::Time(time), None) => self.clock.steps_until(time).max(1),
        };
        let end = self.end();
        self.map_moments = self.maps_at.iter().map(|time| earlier(self.due(*time), end)).collect();
        self.map_moments.push(end);
        self.map_moments.sort_by(|one, other| one.1.total_cmp(&other.1).then(one.0.cmp(&other.0)));
        self.map_moments.dedup();
    }

    /// Physical time at the end of the run, s.
    pub fn end_time(&self) -> f64 {
        self.end().1
    }

    /// The last step.
    pub fn last(&self) -> u64 {
        self.last
    }

    /// Tells whether maps are due before the first step.
    pub fn begins_with_maps(&self) -> bool {
        self.map_moments[0] == (0, 0.0)
    }

    /// The first moment after a time (s) that is the end of a step, or lies in a pause before or after its end; none after the last.
    pub fn next(&self, step: u64, time: f64) -> Option<Moment> {
        let now = (step, time);
        let sample = self.next_sample(now)?;
        let map = self.map_moments.get(self.map_moments.partition_point(|map| !is_after(*map, now)));
        let map = map.copied().unwrap_or(sample);
        let (step, time) = earlier(sample, map);
        let is_due = |other| !is_after(other, (step, time));
        let pause = self.pause_at(step, time);
        Some(Moment { step, time, pause, sample: is_due(sample), maps: is_due(map) })
    }

    /// The first moment with a sample: the first with t ≥ j · sample_every for a new j, or the last.
    fn next_sample(&self, now: (u64, f64)) -> Option<(u64, f64)> {
        let end = self.end();
        if !is_after(end, now) {
            return None;
        }
        let (step, time) = now;
        let next = match self.sample_every {
            // The end of a step that was sampled in a pause within it is still to come.
            SampleEvery::Steps(every) if step % every == 0 && self.end_of(step) > time => (step, self.end_of(step)),
            SampleEvery::Steps(every) => {
                let next = (step / every + 1).saturating_mul(every).min(self.last);
                (next, self.end_of(next))
            }
            SampleEvery::Time(every) if self.cycle.is_none() && every <= self.clock.step_time() => {
                (step + 1, self.end_of(step + 1))
            }
            SampleEvery::Time(every) => match &self.cycle {
                Some((cycle, _)) => self.next_of_cycle(cycle, every, now, end),
                None => {
                    let mut multiple = (time / every).floor();
                    let mut next = self.due(multiple * every);
                    while !is_after(next, now) {
                        multiple += 1.0;
                        if multiple * every > end.1 {
                            return Some(end);
                        }
                        next = self.due(multiple * every);
                    }
                    next
                }
            },
        };
        // Steps may be over before the time is, in a pause.
        Some(if is_after(next, now) { earlier(next, end) } else { end })
    }

    /// The first moment with a sample in a run with a cycle: a multiple of `every` (s) in a pause, at its own time, or the end of the
    /// first step in whose time with load and speed there is one.
    fn next_of_cycle(&self, cycle: &Cycle, every: f64, now: (u64, f64), end: (u64, f64)) -> (u64, f64) {
        let (step, time) = now;
        let mut done = step.min(self.last);
        // In a pause within a step that step has not ended.
        while done > 0 && self.end_of(done) > time {
            done -= 1;
        }
        let mut found = end;
        let mut at = multiple_after(self.end_of(done), every);
        while at <= found.1 {
            let next = self.due(at);
            let is_resting = next.1 == at && cycle.pause_in(at, at).is_some();
            at = match (is_after(next, now), is_resting) {
                // A multiple in a pause is reported there; those after it are due later.
                (true, true) => return earlier(next, found),
                (false, true) => match cycle.rests_to(at, time) {
                    end if end <= time => multiple_from(end, every),
                    _ => multiple_after(time, every),
                },
                (false, false) if next.0 < self.last => multiple_after(at, every),
                // Until the step has ended, only those in a pause within it come before.
                (is_new, false) => {
                    found = if is_new { earlier(next, found) } else { found };
                    let Some(pause) = cycle.pause_in(at, found.1) else { break };
                    multiple_after(at, every).max(multiple_from(pause.start, every))
                }
            };
        }
        found
    }

    /// The step whose surfaces are those of a time (s), and its end, or that time if it lies in a pause.
    fn due(&self, time: f64) -> (u64, f64) {
        let Some((cycle, angle)) = &self.cycle else {
            let step = self.clock.steps_until(time);
            return (step, self.clock.time_at(step));
        };
        // What is left of the angle after the last step is left out; a pause after it has the surfaces of that step.
        let step = cycle.steps_until(time, *angle).min(self.last);
        let end = cycle.end_of(step, *angle);
        if (time - end).abs() <= 1e-12 * time {
            return (step, end);
        }
        if cycle.at(time).1 != Kind::Active {
            return (step, time);
        }
        // A time at which a pause ends is due with the step after it.
        let step = if end < time { (step + 1).min(self.last) } else { step };
        let end = cycle.end_of(step, *angle);
        // What is left out has what the run ends with.
        if end < time { self.end() } else { (step, end) }
    }

    /// The pause that a time (s) of a moment lies in, if it is not the end of a step.
    fn pause_at(&self, step: u64, time: f64) -> Option<Kind> {
        let (cycle, angle) = self.cycle.as_ref()?;
        if time == cycle.end_of(step, *angle) {
            return None;
        }
        // The end of a run may be that of a pause.
        [cycle.at(time).1, cycle.before(time)].into_iter().find(|kind| *kind != Kind::Active)
    }

    /// t at the end of a step, s.
    fn end_of(&self, step: u64) -> f64 {
        match &self.cycle {
            Some((cycle, angle)) => cycle.end_of(step, *angle),
            None => self.clock.time_at(step),
        }
    }

    /// The last moment: the end of the last step, or that of the last pause of the run after it.
    fn end(&self) -> (u64, f64) {
        match (self.end, &self.cycle) {
            (End::Time(time), Some((cycle, _))) => (self.last, cycle.rested_until(time).max(self.end_of(self.last))),
            _ => (self.last, self.end_of(self.last)),
        }
    }

    /// Number of samples of the whole run.
    pub fn samples(&self) -> u64 {
        let samples = match self.sample_every {
            SampleEvery::Steps(every) => self.last as f64 / every as f64,
            SampleEvery::Time(every) if self.cycle.is_some() => self.samples_of_cycle(every),
            SampleEvery::Time(every) if every <= self.clock.step_time() => self.last as f64,
            SampleEvery::Time(every) => {
                let multiples = (self.end_time() / every).floor();
                // The last step is mostly the one that is sampled for the last of them.
                if self.due(multiples * every).0 < self.last { multiples + 1.0 } else { multiples }
            }
        };
        (samples - 1e-9).ceil() as u64
    }

    /// Number of samples of a run with a cycle, at most: in pauses one for each multiple, else not more than one for each step.
    fn samples_of_cycle(&self, every: f64) -> f64 {
        let Some((cycle, _)) = &self.cycle else { return 0.0 };
        let end = self.end_time();
        let resting = cycle.resting_until(end);
        resting / every + ((end - resting) / every).min(self.last as f64)
    }

    /// Number of times at which maps are taken.
    pub fn maps(&self) -> usize {
        self.map_moments.len()
    }
}

/// The first multiple of `every` after a time.
fn multiple_after(time: f64, every: f64) -> f64 {
    let multiple = (time / every).floor();
    // Of a product that is rounded down, the next.
    [0.0, 1.0, 2.0].map(|more| (multiple + more) * every).into_iter().find(|at| *at > time).unwrap_or(f64::INFINITY)
}

/// The first multiple of `every` that is not before a time.
fn multiple_from(time: f64, every: f64) -> f64 {
    let multiple = (time / every).floor();
    [0.0, 1.0].map(|more| (multiple + more) * every).into_iter().find(|at| *at >= time).unwrap_or(f64::INFINITY)
}

/// Tells whether a moment, as step and time (s), is later than another. Where both are known, time decides: a run that was ended in a pause
/// may go on with the step around it.
fn is_after(one: (u64, f64), other: (u64, f64)) -> bool {
    one.1 > other.1 || (one.1 == other.1 && one.0 > other.0)
}

/// The earlier of two moments.
fn earlier(one: (u64, f64), other: (u64, f64)) -> (u64, f64) {
    if is_after(one, other) { other } else { one }
}
