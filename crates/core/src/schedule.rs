//! When samples and maps are taken (formats.md, run file).

use crate::parameters::Parameters;

/// When samples are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SampleEvery {
    /// Physical time, s.
    Time(f64),
    /// Simulated steps, at least 1.
    Steps(u64),
}

/// The steps after which a sample or maps are due.
#[derive(Debug, Clone)]
pub struct Schedule<'a> {
    parameters: &'a Parameters,
    sample_every: SampleEvery,
    /// Steps after which maps are due, ascending; the last step is always among them.
    map_steps: Vec<u64>,
}

impl<'a> Schedule<'a> {
    /// Plans samples and the maps of the physical times `maps_at` (s); times beyond the end fall on the last step.
    pub fn new(parameters: &'a Parameters, sample_every: SampleEvery, maps_at: &[f64]) -> Self {
        let last = parameters.steps;
        let mut map_steps: Vec<u64> = maps_at.iter().map(|time| parameters.steps_until(*time).min(last)).collect();
        map_steps.push(last);
        map_steps.sort_unstable();
        map_steps.dedup();
        Self { parameters, sample_every, map_steps }
    }

    /// The first step after `step` with a sample: the first with t ≥ j · sample_every for a new j, or the last.
    pub fn next_sample(&self, step: u64) -> u64 {
        let next = match self.sample_every {
            SampleEvery::Steps(every) => (step / every + 1).saturating_mul(every),
            SampleEvery::Time(every) if every <= self.parameters.step_time() => step + 1,
            SampleEvery::Time(every) => {
                let mut multiple = (self.parameters.time_at(step) / every).floor();
                let mut next = self.parameters.steps_until(multiple * every);
                while next <= step {
                    multiple += 1.0;
                    next = self.parameters.steps_until(multiple * every);
                }
                next
            }
        };
        next.min(self.parameters.steps)
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
            SampleEvery::Time(every) => (every / self.parameters.step_time()).max(1.0),
        };
        (self.parameters.steps as f64 / per_sample - 1e-9).ceil() as u64
    }

    /// Number of times at which maps are taken.
    pub fn maps(&self) -> usize {
        self.map_steps.len()
    }
}
