//! Reason why a run, or the runs of a study as a whole, did not come to an end, and whose fault that is.

use std::error::Error as StdError;
use std::path::{Path, PathBuf};
use std::{fmt, io};

use plateau_core::engine::comm::CommError;
use plateau_core::simulation::SimulationError;
use plateau_io::claim::ClaimError;
use plateau_io::number;
use plateau_io::run_file::checkpoint::CheckpointError;
use plateau_io::run_file::{KeepError, ReadError, RunFileError};
use plateau_io::scene::{Problem, SceneError};
use plateau_io::study::StudyError;
use plateau_io::surface::SurfaceError;
use thiserror::Error;

/// Reason why a run did not come to its end.
#[derive(Debug, Error)]
#[allow(missing_docs)] // Their own types say what they are.
pub enum RunError {
    /// The scene, a file or what was asked for is wrong: nothing was simulated, and what was there is untouched.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The run failed, or what it needs of the system.
    #[error(transparent)]
    Failed(#[from] RunFailure),
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Problem with the input of a run.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum InputError {
    #[error(transparent)]
    Surface(Box<SurfaceError>),
    /// Surfaces and parameters make no simulation.
    #[error("{0}")]
    Simulation(#[from] SimulationError),
    /// No run file can be made there.
    #[error("{0}")]
    RunFile(#[source] RunFileError),
    /// Another process writes it.
    #[error(transparent)]
    Claim(Box<ClaimError>),
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error("{0}")]
    Read(#[from] ReadError),
    #[error(transparent)]
    Keep(#[from] KeepError),
    /// Files of an earlier run that cannot be moved out of the way.
    #[error("{0}")]
    Aside(String, #[source] io::Error),
    /// File in the place that is an input, of another run, of another program, damaged or not to be replaced; or processes of a job that
    /// were not given the same, or were given what they cannot have.
    #[error("{0}")]
    Refused(String),
}

/// Failure of a run.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum RunFailure {
    /// Step that failed, or what was to be reported of one.
    #[error("{0}")]
    Simulation(#[from] SimulationError),
    /// The run file could not be made or written.
    #[error(transparent)]
    RunFile(#[from] RunFileError),
    /// The run file, though complete, could not be read again.
    #[error("{0}")]
    Read(#[from] ReadError),
    /// Claim for which there is no space: the lock of the run file cannot be written.
    #[error(transparent)]
    Claim(Box<ClaimError>),
    #[error(transparent)]
    Comm(#[from] CommError),
    #[error("the system gives no more threads: allow more of them, as with ulimit -u 64, or in the container ({0})")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// A signal, or whatever the observer took for one, stopped the run.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("stopped by {}{progress}", signal_in_words(*signal))]
pub struct Stopped {
    /// Number that [`Observer::asked_to_stop`](crate::Observer::asked_to_stop) gave.
    pub signal: u8,
    /// Extent to which the run had come; none in a process that has no file to close.
    pub progress: Progress,
}

/// A signal as its sender knows it.
pub fn signal_in_words(signal: u8) -> String {
    match signal {
        2 => "signal 2 (Ctrl-C)".to_owned(),
        other => format!("signal {other}"),
    }
}

/// Progress of a run when it was stopped.
#[derive(Debug, Clone, PartialEq)]
pub enum Progress {
    /// Stop before the first step.
    NotStarted,
    /// The run file has what was done, and a checkpoint is beside it.
    Saved {
        /// Physical time that was reached, and at which the run ends, s.
        times: [f64; 2],
        /// Number of steps.
        steps: u64,
        /// The run file.
        file: PathBuf,
        /// Number of samples in it.
        samples: usize,
    },
    /// Progress that another process of the job knows.
    Elsewhere,
}

impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotStarted => write!(f, " before the first step"),
            Self::Saved { times, steps, file, samples } => {
                let ([reached, end], file) = (times.map(number::short), file.display());
                write!(
                    f,
                    " after {steps} steps, at {reached} s of {end} s; {file} holds {samples} samples, --resume goes on from here"
                )
            }
            Self::Elsewhere => Ok(()),
        }
    }
}

impl From<SurfaceError> for InputError {
    fn from(error: SurfaceError) -> Self {
        Self::Surface(Box::new(error))
    }
}

impl From<SimulationError> for RunError {
    fn from(error: SimulationError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<CommError> for RunError {
    fn from(error: CommError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<rayon::ThreadPoolBuildError> for RunError {
    fn from(error: rayon::ThreadPoolBuildError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<ClaimError> for RunError {
    /// Makes a full disk a failure of the run, for another name would not mend it; all else is a wrong input.
    fn from(error: ClaimError) -> Self {
        let error = Box::new(error);
        if error.lacks_space() { RunFailure::Claim(error).into() } else { InputError::Claim(error).into() }
    }
}

impl From<RunFileError> for RunError {
    /// Sorts the errors of a file that is being made, new or anew.
    fn from(error: RunFileError) -> Self {
        match error {
            RunFileError::Failed(_) | RunFileError::Write(..) => RunFailure::RunFile(error).into(),
            _ => InputError::RunFile(error).into(),
        }
    }
}

/// Numbers of the system's errors that are not the user's fault: no thread, no memory, too many open files, in all or of this
/// process.
const LACKS: [i32; 4] = [11, 12, 23, 24];

/// Tells whether an error is, or comes from, a lack of the system: no thread, no memory, no file handle. Then the input is not wrong.
fn lacks_resources(error: &(dyn StdError + 'static)) -> bool {
    let of_number = |number: Option<i32>| number.is_some_and(|number| LACKS.contains(&number));
    let of_problems = |problems: &[Problem]| problems.iter().any(|problem| of_number(problem.system));
    let is_lack = |error: &(dyn StdError + 'static)| {
        matches!(error.downcast_ref(), Some(ReadError::Handles { .. }))
            || matches!(error.downcast_ref(), Some(ReadError::System(_, _, number)) if of_number(*number))
            || matches!(error.downcast_ref(), Some(RunFileError::NoHandle { .. }))
            || matches!(error.downcast_ref(), Some(SimulationError::Threads { .. }))
            || error.downcast_ref().is_some_and(|error: &io::Error| of_number(error.raw_os_error()))
            || error.downcast_ref().is_some_and(|error: &SceneError| of_problems(error.problems()))
            || error.downcast_ref().is_some_and(|error: &StudyError| of_problems(&error.0))
    };
    std::iter::successors(Some(error), |error| (*error).source()).any(is_lack)
}

/// Reason why something cannot be done, with the exit status of the program, which tells whose fault it is.
#[derive(Debug, Error)]
#[error("{}", message.as_deref().unwrap_or_default())]
pub struct Failure {
    /// One of the statuses below; of a run that a signal stopped, with the number of that added.
    pub status: u8,
    /// Message; none where a signal stopped a process that wrote nothing.
    pub message: Option<String>,
}

impl Failure {
    /// Status of a run that failed.
    pub const RUN: u8 = 1;
    /// Status where an input is wrong.
    pub const INPUT: u8 = 2;
    /// Status of a run that a signal stopped, as shells have it.
    pub const STOPPED: u8 = 128;

    /// A wrong input; or a failed run, where the error says, or comes from one that says, that the system lacks what it takes to look at
    /// the input.
    pub fn input(error: impl Into<Box<dyn StdError>>) -> Self {
        let error = error.into();
        Self::because(&*error, &error)
    }

    /// Fails as [`input`](Self::input) does, with a message of its own.
    pub fn because(error: &(dyn StdError + 'static), message: impl fmt::Display) -> Self {
        let status = if lacks_resources(error) { Self::RUN } else { Self::INPUT };
        Self { status, message: Some(message.to_string()) }
    }

    /// A failed run.
    pub fn run(error: impl fmt::Display) -> Self {
        Self { status: Self::RUN, message: Some(error.to_string()) }
    }

    /// A file that cannot be used, and why.
    pub fn of_file(path: &Path, reason: impl fmt::Display) -> Self {
        Self::input(format!("{}: {reason}", path.display()))
    }

    /// A signal stopped the run; with the state that is left of it, which a process that wrote nothing does not know.
    pub fn stopped(signal: u8, message: Option<String>) -> Self {
        Self { status: Self::STOPPED.saturating_add(signal), message }
    }

    /// The same failure, with what holds nevertheless.
    #[must_use]
    pub fn but(self, what: impl fmt::Display) -> Self {
        match self.message {
            Some(message) if self.status < Self::STOPPED => {
                Self { message: Some(format!("{message}; {what}")), ..self }
            }
            message => Self { message, ..self },
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Input(error) => Self::input(error),
            RunError::Failed(failure) => Self::run(failure),
            RunError::Stopped(stopped) => {
                let message = (stopped.progress != Progress::Elsewhere).then(|| stopped.to_string());
                Self::stopped(stopped.signal, message)
            }
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
            | SimulationError::Threads { .. } => Self::run(error),
            _ => Self::input(error),
        }
    }
}
