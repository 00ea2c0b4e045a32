//! When samples and maps are taken (docs/run-file.md).

use crate::model::clock::Clock;

/// When samples are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SampleEvery {
    /// Physical time, s.
    Time(f64),
    /// Simulated steps, at least 1.
    Steps(u64),
}

/// When a run is over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// After this physical time, s.
    Time(f64),
    /// After so many steps.
    Steps(u64),
}

/// The steps after which a sample or maps are due.
#[derive(Debug, Clone)]
pub struct Schedule {
    clock: Clock,
    sample_every: SampleEvery,
    maps_at: Vec<f64>,
    end: End,
    /// The last step.
    last: u64,
    /// Steps after which maps are due, ascending; the last step is always among them.
    map_steps: Vec<u64>,
}

impl Schedule {
    /// Plans samples and the maps of the physical times `maps_at` (s) until `end`; times beyond it fall on the last step.
    pub fn new(clock: Clock, end: End, sample_every: SampleEvery, maps_at: &[f64]) -> Self {
        let mut schedule = Self { clock, sample_every, maps_at: maps_at.to_vec(), end, last: 0, map_steps: Vec::new() };
        schedule.plan(clock);
        schedule
    }

    /// Plans anew what lies ahead where steps take `step_time` (s) after `step`.
    pub fn change(&mut self, step: u64, step_time: f64) {
        self.plan(self.clock.changed(step, step_time));
    }

    /// Plans anew for a run that goes on and whose clock is this one.
    pub fn go_on(&mut self, clock: Clock) {
        self.plan(clock);
    }

    fn plan(&mut self, clock: Clock) {
        self.clock = clock;
        self.last = match self.end {
            End::Steps(steps) => steps,
            End::Time(time) => clock.steps_until(time).max(1),
        };
        self.map_steps = self.maps_at.iter().map(|time| clock.steps_until(*time).min(self.last)).collect();
        self.map_steps.push(self.last);
        self.map_steps.sort_unstable();
        self.map_steps.dedup();
    }

    /// Physical time at the end of the last step, s.
    pub fn end_time(&self) -> f64 {
        self.clock.time_at(self.last)
    }

    /// The last step.
    pub fn last(&self) -> u64 {
        self.last
    }

    /// The first step after `step` with a sample: the first with t ≥ j · sample_every for a new j, or the last.
    pub fn next_sample(&self, step: u64) -> u64 {
        let next = match self.sample_every {
            SampleEvery::Steps(every) => (step / every + 1).saturating_mul(every),
            SampleEvery::Time(every) if every <= self.clock.step_time() => step + 1,
            SampleEvery::Time(every) => {
                let mut multiple = (self.clock.time_at(step) / every).floor();
                let mut next = self.clock.steps_until(multiple * every);
                while next <= step {
                    multiple += 1.0;
                    next = self.clock.steps_until(multiple * every);
                }
                next
            }
        };
        next.min(self.last)
    }

    /// Whether maps are due after `step`.
    pub fn has_maps(&self, step: u64) -> bool {
        self.map_steps.binary_search(&step).is_ok()
    }

    /// The first step after `step` with a sample or maps.
    pub fn next_event(&self, step: u64) -> u64 {
        let map = self.map_steps[self.map_steps.partition_point(|map| *map <= step).min(self.map_steps.len() - 1)];
        self.next_sample(step).min(map.max(step + 1))
    }

    /// Number of samples of the whole run.
    pub fn samples(&self) -> u64 {
        let per_sample = match self.sample_every {
            SampleEvery::Steps(every) => every as f64,
            SampleEvery::Time(every) => (every / self.clock.step_time()).max(1.0),
        };
        (self.last as f64 / per_sample - 1e-9).ceil() as u64
    }

    /// Number of times at which maps are taken.
    pub fn maps(&self) -> usize {
        self.map_steps.len()
    }
}
