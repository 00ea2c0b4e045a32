//! A simulation as something that can be timed. This file makes all calls of core's time loop.

use std::time::{Duration, Instant};

use plateau_core::engine::kernel::InstructionSet;
use plateau_core::observe::{Map, Sample, Snapshot};
use plateau_core::simulation::{Execution, Simulation};

use crate::case::Case;
use crate::error::BenchError;
use crate::race::Runner;

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
}

impl Stepper {
    /// A case at its start.
    pub fn new(case: &Case, setup: Setup) -> Result<Self, BenchError> {
        let execution = Execution { workers: setup.workers, instructions: setup.instructions, ..Execution::default() };
        let mut simulation = Simulation::with_execution(case.parameters.clone(), case.surfaces.clone(), execution)?;
        if let Some(start) = &case.start {
            simulation.restore(start)?;
        }
        Ok(Self { simulation })
    }

    /// Advances by so many steps, after which something may be reported.
    pub fn run(&mut self, steps: u64) -> Result<(), BenchError> {
        let end = self.simulation.steps_done() + steps;
        Ok(self.simulation.advance_to(end)?)
    }

    /// The reported quantities after the last step.
    pub fn sample(&mut self) -> Result<Sample, BenchError> {
        Ok(self.simulation.sample()?)
    }

    /// Maps as they are now.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, BenchError> {
        Ok(self.simulation.snapshot(maps)?)
    }
}

impl Runner for Stepper {
    fn advance(&mut self, steps: u64) -> Result<Duration, BenchError> {
        let end = self.simulation.steps_done() + steps;
        let start = Instant::now();
        self.simulation.pass_to(end)?;
        Ok(start.elapsed())
    }

    fn load_evaluations_per_step(&self) -> Option<f64> {
        let course = self.simulation.course();
        (course.steps > 0).then(|| 1.0 + course.extra_readings as f64 / course.steps as f64)
    }
}
