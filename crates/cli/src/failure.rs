//! How the program ends when it cannot do what was asked.

use std::error::Error;
use std::process::ExitCode;
use std::{fmt, io};

use plateau_core::simulation::SimulationError;
use plateau_io::run_file::{ReadError, RunFileError};
use plateau_io::scene::{Problem, SceneError};
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
    /// A wrong input; or a failed run, where the error says, or comes from one that says, that the system lacks what it takes to look at the
    /// input.
    pub fn input(error: impl Into<Box<dyn Error>>) -> Self {
        let error = error.into();
        Self::because(&*error, &error)
    }

    /// As [`input`](Self::input), with a message of its own.
    pub fn because(error: &(dyn Error + 'static), message: impl fmt::Display) -> Self {
        if lacks(error) { Self::Run(message.to_string()) } else { Self::Input(message.to_string()) }
    }

    /// A failed run.
    pub fn run(error: impl fmt::Display) -> Self {
        Self::Run(error.to_string())
    }

    /// A scene that cannot be used, with the lines that are wrong.
    pub fn of_scene(error: SceneError) -> Self {
        let message = excerpt::of(error.problems());
        Self::because(&error, message)
    }

    /// A study that cannot be used, with the lines that are wrong.
    pub fn of_study(error: StudyError) -> Self {
        let message = excerpt::of(&error.0);
        Self::because(&error, message)
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

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(message) | Self::Run(message) | Self::Stopped { message: Some(message), .. } => {
                f.write_str(message)
            }
            Self::Stopped { message: None, .. } => Ok(()),
        }
    }
}

/// Numbers of the system's errors that are not the user's fault: no thread, no memory, too many open files, in all or of this
/// process.
const LACKS: [i32; 4] = [11, 12, 23, 24];

/// Whether an error, or what it comes from, is that the system lacks something.
fn lacks(error: &(dyn Error + 'static)) -> bool {
    let number = |error: &(dyn Error + 'static)| match error.downcast_ref::<ReadError>() {
        Some(ReadError::System { number, .. }) => *number,
        _ => error.downcast_ref::<io::Error>().and_then(io::Error::raw_os_error),
    };
    let of_problems = |problems: &[Problem]| {
        problems.iter().any(|problem| problem.system.is_some_and(|number| LACKS.contains(&number)))
    };
    let is_lack = |error: &(dyn Error + 'static)| {
        number(error).is_some_and(|number| LACKS.contains(&number))
            || matches!(error.downcast_ref(), Some(ReadError::Handles { .. }))
            || error.downcast_ref().is_some_and(|error: &SceneError| of_problems(error.problems()))
            || error.downcast_ref().is_some_and(|error: &StudyError| of_problems(&error.0))
            || matches!(error.downcast_ref(), Some(RunFileError::NoHandle { .. }))
            || matches!(error.downcast_ref(), Some(SimulationError::Threads { .. }))
    };
    let mut next = Some(error);
    while let Some(error) = next {
        if is_lack(error) {
            return true;
        }
        next = error.source();
    }
    false
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

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use plateau_io::scene::Origin;
    use plateau_run::InputError;

    use super::*;

    #[test]
    fn the_status_comes_from_the_error_and_not_from_its_words() {
        let named = "cannot read notes (os error 24), errno = 12, of mine.toml";
        assert_eq!(Failure::input(named).status(), 2);
        let system = |number| io::Error::from_raw_os_error(number);
        for (number, status) in [(2, 2), (13, 2), (11, 1), (12, 1), (23, 1), (24, 1)] {
            assert_eq!(Failure::input(system(number)).status(), status, "{number}");
            assert_eq!(Failure::because(&system(number), "said in other words").status(), status, "{number}");
            // However deep it lies.
            let aside = InputError::SetAside { path: PathBuf::from("run.h5"), error: system(number) };
            assert_eq!(Failure::of(RunError::Input(aside)).status(), status, "{number}");
            let origin = Origin::File(Path::new("mine.toml").into());
            let scene = Problem { origin, key: None, message: named.into(), system: Some(number) };
            assert_eq!(Failure::input(SceneError::from(scene.clone())).status(), status, "{number}");
            assert_eq!(Failure::of_scene(SceneError::from(scene.clone())).status(), status, "{number}");
            assert_eq!(Failure::of_study(StudyError(vec![scene])).status(), status, "{number}");
        }
        let threads = SimulationError::Threads { workers: 2, message: "no".into() };
        assert_eq!(Failure::of(RunError::Input(InputError::Simulation(threads))).status(), 1);
    }
}
