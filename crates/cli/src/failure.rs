//! How the program ends when it cannot do what was asked.

use std::fmt;
use std::process::ExitCode;

use plateau_io::scene::SceneError;
use plateau_io::study::StudyError;
use plateau_run::{Job, Progress, RunError};

use crate::{excerpt, message};

/// Why a command failed, with the exit status that tells whose fault it is.
#[derive(Debug)]
pub enum Failure {
    /// The command line or an input is wrong: exit status 2.
    Input(String),
    /// The run failed: exit status 1.
    Run(String),
    /// A signal stopped the run: exit status 128 and the signal's number, as shells have it.
    Stopped {
        /// The signal.
        signal: u8,
        /// What is left of the run; a process that wrote nothing does not know.
        message: Option<String>,
    },
}

impl Failure {
    /// A wrong input; or a failed run, where the system lacks what it takes to look at the input.
    pub fn input(error: impl fmt::Display) -> Self {
        let message = error.to_string();
        if LACKS.iter().any(|number| is_lacking(&message, *number)) { Self::Run(message) } else { Self::Input(message) }
    }

    /// A failed run.
    pub fn run(error: impl fmt::Display) -> Self {
        Self::Run(error.to_string())
    }

    /// A scene that cannot be used, with the lines that are wrong.
    pub fn of_scene(error: SceneError) -> Self {
        Self::Input(excerpt::of(error.problems()))
    }

    /// A study that cannot be used, with the lines that are wrong.
    pub fn of_study(error: StudyError) -> Self {
        Self::input(excerpt::of(&error.0))
    }

    /// How a run failed.
    pub fn of(error: RunError) -> Self {
        match error {
            RunError::Input(error) => Self::input(error),
            RunError::Failed(failure) => Self::run(failure),
            RunError::Stopped(stopped) => {
                let message = (stopped.progress != Progress::Elsewhere).then(|| stopped.to_string());
                Self::Stopped { signal: stopped.signal, message }
            }
        }
    }

    /// The same failure, with what holds nevertheless.
    #[must_use]
    pub fn but(self, what: impl fmt::Display) -> Self {
        match self {
            Self::Input(message) => Self::Input(format!("{message}; {what}")),
            Self::Run(message) => Self::Run(format!("{message}; {what}")),
            stopped @ Self::Stopped { .. } => stopped,
        }
    }

    /// The exit status.
    pub fn status(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Run(_) => 1,
            Self::Stopped { signal, .. } => 128_u8.saturating_add(*signal),
        }
    }

    /// Says what happened on standard error.
    pub fn say(&self) {
        if let Self::Input(message) | Self::Run(message) | Self::Stopped { message: Some(message), .. } = self {
            message::error(message);
        }
    }

    /// Says what happened on standard error and gives the exit status.
    pub fn report(self) -> ExitCode {
        self.say();
        ExitCode::from(self.status())
    }
}

/// Numbers of the system's errors that are not the user's fault: no thread, no memory, too many open files, in all or of this
/// process.
const LACKS: [u8; 4] = [11, 12, 23, 24];

/// Whether a message ends in that number of the system, as the standard library and HDF5 write it.
fn is_lacking(message: &str, number: u8) -> bool {
    message.contains(&format!("(os error {number})")) || message.contains(&format!("errno = {number},"))
}

/// Works together with the other processes of the job if there are any. From here on only the first of them gives warnings; if
/// one fails, all end with its exit status.
///
/// # Errors
/// Those of `work`, and [`Failure::Run`] when the others cannot be joined.
pub fn in_job(work: impl FnOnce(&mut Job) -> Result<(), Failure>) -> Result<(), Failure> {
    let mut job = Job::start().map_err(Failure::run)?;
    if !job.leads() {
        message::no_warnings();
    }
    match work(&mut job) {
        Ok(()) => {
            job.finish();
            Ok(())
        }
        // All ranks were stopped together. It is said while all are still there: the launcher ends the others as soon as one is
        // gone with a status other than 0.
        Err(failure @ Failure::Stopped { signal, .. }) => {
            failure.say();
            job.finish();
            Err(Failure::Stopped { signal, message: None })
        }
        Err(failure) => {
            job.fail(failure.status(), || failure.say());
            Err(failure)
        }
    }
}
