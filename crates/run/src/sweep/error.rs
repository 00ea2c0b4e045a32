//! Failure of the runs of a study as a whole.

use std::error::Error as StdError;
use std::fmt;

use plateau_io::study::StudyError;
use thiserror::Error;

use crate::error::lacks_resources;

/// Failure of the runs of a study, which tells a wrong input from a failed run.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The study cannot be used: everything that is wrong with it.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// An input is wrong: a scene, a file that it names, the folder of the results.
    #[error("{0}")]
    Input(String),
    /// Runs failed, their results could not be kept, or the system lacks what they take.
    #[error("{0}")]
    Failed(String),
}

impl SweepError {
    /// A wrong input; or a failure, where the error says, or comes from one that says, that the system lacks what it takes to look at
    /// the input.
    pub(super) fn input(error: impl StdError + 'static) -> Self {
        let message = error.to_string();
        Self::because(&error, message)
    }

    /// As [`input`](Self::input), with a message of its own.
    pub(super) fn because(error: &(dyn StdError + 'static), message: impl fmt::Display) -> Self {
        let message = message.to_string();
        if lacks_resources(error) { Self::Failed(message) } else { Self::Input(message) }
    }

    /// A failure.
    pub(super) fn failed(error: impl fmt::Display) -> Self {
        Self::Failed(error.to_string())
    }
}
