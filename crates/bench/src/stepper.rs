//! A simulation as something that can be timed. This file makes all calls of core's time loop.

use std::time::{Duration, Instant};

use plateau_core::kernel::InstructionSet;
use plateau_core::observe::{Map, Sample, Snapshot};
use plateau_core::simulation::Simulation;

use crate::case::Case;
use crate::error::BenchError;
use crate::race::Runner;

/// The most workers that a simulation can have.
pub const MOST_WORKERS: usize = 1;

/// How a simulation is carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setup {
    /// Threads that share the ring.
    pub workers: usize,
    /// Of the kernels.
    pub instructions: InstructionSet,
}

impl Setup {
    /// So many workers with the widest instruction set.
    pub fn of(workers: usize) -> Self {
        Self { workers, instructions: InstructionSet::best() }
    }
}

/// A simulation that counts its load evaluations.
#[derive(Debug)]
pub struct Stepper {
    simulation: Simulation,
    steps: u64,
    evaluations: u64,
}

impl Stepper {
    /// A case before its first step.
    pub fn new(case: &Case, setup: Setup) -> Result<Self, BenchError> {
        if setup.workers > MOST_WORKERS {
            return Err(BenchError::Workers { asked: setup.workers, most: MOST_WORKERS });
        }
        let simulation = Simulation::new(case.parameters.clone(), case.surfaces.clone())?;
        Ok(Self { simulation: simulation.with_instructions(setup.instructions), steps: 0, evaluations: 0 })
    }

    /// Advances by so many steps.
    pub fn run(&mut self, steps: u64) -> Result<(), BenchError> {
        for _ in 0..steps {
            self.simulation.advance()?;
            self.evaluations += u64::from(self.simulation.contact().iterations());
        }
        self.steps += steps;
        Ok(())
    }

    /// The reported quantities after the last step.
    pub fn sample(&mut self) -> Result<Sample, BenchError> {
        Ok(self.simulation.sample())
    }

    /// Maps as they are now.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, BenchError> {
        Ok(self.simulation.snapshot(maps))
    }
}

impl Runner for Stepper {
    fn advance(&mut self, steps: u64) -> Result<Duration, BenchError> {
        let start = Instant::now();
        self.run(steps)?;
        Ok(start.elapsed())
    }

    fn load_evaluations_per_step(&self) -> Option<f64> {
        (self.steps > 0).then(|| self.evaluations as f64 / self.steps as f64)
    }
}
