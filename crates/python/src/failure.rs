//! Failures as exceptions of the package, with the texts of the program.

use std::error::Error;

use plateau_core::simulation::SimulationError;
use plateau_run::sweep::SweepError;
use plateau_run::{RunError, lacks_resources};
use pyo3::prelude::*;

/// Exit statuses of the program: a failed run, and wrong input.
const FAILED: u8 = 1;
const WRONG_INPUT: u8 = 2;

/// Reason why something cannot be done, with the exit status that the program would end with.
#[derive(Debug)]
pub struct Failure {
    message: String,
    status: u8,
}

impl Failure {
    /// Something that was given is wrong; or the system lacks what it takes to look at it.
    pub fn input(error: impl Into<Box<dyn Error>>) -> Self {
        let error = error.into();
        let status = if lacks_resources(&*error) { FAILED } else { WRONG_INPUT };
        Self { message: error.to_string(), status }
    }

    /// A run failed.
    pub fn failed(error: impl std::fmt::Display) -> Self {
        Self { message: error.to_string(), status: FAILED }
    }

    /// A signal stopped it.
    pub fn stopped(signal: u8, message: impl std::fmt::Display) -> Self {
        Self { message: message.to_string(), status: 128_u8.saturating_add(signal) }
    }

    /// The exception; `about` are the files that the message may begin with.
    pub fn raise(self, py: Python<'_>, about: &[&str]) -> PyErr {
        let error_of = py.import("plateau.errors").and_then(|errors| errors.getattr("error_of"));
        let made = error_of.and_then(|error_of| error_of.call1((self.message, (), self.status, about)));
        made.map_or_else(|error| error, PyErr::from_value)
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Input(error) => Self::input(error),
            RunError::Failed(error) => Self::failed(error),
            RunError::Stopped(stopped) => Self::stopped(stopped.signal, stopped),
        }
    }
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Failed(message) => Self::failed(message),
            error => Self::input(error),
        }
    }
}

impl From<SimulationError> for Failure {
    /// Failure of a step, or of what was given between two steps.
    fn from(error: SimulationError) -> Self {
        match error {
            SimulationError::Contact { .. }
            | SimulationError::NoFriction { .. }
            | SimulationError::NotFinite { .. }
            | SimulationError::Worker { .. }
            | SimulationError::Threads { .. } => Self::failed(error),
            SimulationError::NotWatched { step } => {
                Self::input(format!("the pressures of step {step} were not kept: advance with watch=True"))
            }
            _ => Self::input(error),
        }
    }
}
