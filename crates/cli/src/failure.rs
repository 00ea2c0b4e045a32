//! End of the program when it cannot do what was asked: the message, with the lines of a file that are wrong, and the exit status.

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::{fmt, fs};

use console::measure_text_width;
use plateau_io::delimited::{decode, numbered};
use plateau_io::scene::{Origin, Problem, SceneError};
use plateau_io::study::StudyError;
use plateau_io::text;
use plateau_run::sweep::SweepError;
use plateau_run::{Job, Progress, RunError, lacks_resources};

use crate::message;

/// Longest line that is shown, characters: of a longer one its beginning.
const LONGEST: usize = 160;

/// Problems, as many as are read, each with its line if it has one.
fn excerpt(problems: &[Problem]) -> String {
    let mut files = HashMap::new();
    text::problems(problems.iter().map(|problem| with_line(problem, &mut files)))
}

fn with_line<'a>(problem: &'a Problem, files: &mut HashMap<&'a Path, Option<String>>) -> String {
    let Origin::Place { file, line, column } = &problem.origin else { return problem.to_string() };
    let text = files.entry(file).or_insert_with(|| fs::read(file).ok().map(|content| decode(&content).into_owned()));
    let shown = text.as_ref().and_then(|text| marked(text, *line, *column));
    shown.map_or_else(|| problem.to_string(), |shown| format!("{problem}\n{shown}"))
}

/// A line with its number, and a mark below the column; both count from 1. None if there is no such place, as when the file has
/// changed meanwhile.
fn marked(text: &str, line: usize, column: usize) -> Option<String> {
    let (_, found) = numbered(text).nth(line.checked_sub(1)?)?;
    if column > found.chars().count().min(LONGEST) + 1 {
        return None;
    }
    // Tabs and control characters would move the mark, or the terminal.
    let shown: String = found.chars().take(LONGEST).map(|each| if each.is_control() { ' ' } else { each }).collect();
    let number = line.to_string();
    let blank = " ".repeat(number.len());
    // Letters of some languages are two columns wide, and what turns the direction of writing is shown by its number.
    let before: String = shown.chars().take(column - 1).collect();
    let mark = " ".repeat(measure_text_width(&text::shown(&before)));
    Some(format!("  {number} | {}\n  {blank} | {mark}^", shown.trim_end()))
}

/// Exit status of a run that failed.
const RUN: u8 = 1;
/// Exit status where the command line or an input is wrong.
const INPUT: u8 = 2;
/// Exit status of a run that a signal stopped, but for the signal's number, as shells have it.
const STOPPED: u8 = 128;

/// Reason why a command failed, with the exit status that tells whose fault it is.
#[derive(Debug)]
pub struct Failure {
    status: u8,
    /// Message; none where a signal stopped a process that wrote nothing.
    message: Option<String>,
}

impl Failure {
    /// A wrong input; or a failed run, where the error says, or comes from one that says, that the system lacks what it takes to look at
    /// the input.
    pub fn input(error: impl Into<Box<dyn Error>>) -> Self {
        let error = error.into();
        Self::because(&*error, &error)
    }

    /// Fails as [`input`](Self::input) does, with a message of its own.
    pub fn because(error: &(dyn Error + 'static), message: impl fmt::Display) -> Self {
        let status = if lacks_resources(error) { RUN } else { INPUT };
        Self { status, message: Some(message.to_string()) }
    }

    /// A failed run.
    pub fn run(error: impl fmt::Display) -> Self {
        Self { status: RUN, message: Some(error.to_string()) }
    }

    /// A file that cannot be used, and why.
    pub fn of_file(path: &Path, reason: impl fmt::Display) -> Self {
        Self::input(format!("{}: {reason}", path.display()))
    }

    /// A signal stopped the run; with the state that is left of it, which a process that wrote nothing does not know.
    pub fn stopped(signal: u8, message: Option<String>) -> Self {
        Self { status: STOPPED.saturating_add(signal), message }
    }

    /// A scene that cannot be used, with the lines that are wrong.
    pub fn of_scene(error: SceneError) -> Self {
        let message = excerpt(error.problems());
        Self::because(&error, message)
    }

    /// A study that cannot be used, with the lines that are wrong.
    fn of_study(error: StudyError) -> Self {
        let message = excerpt(&error.0);
        Self::because(&error, message)
    }

    /// Failure of a run.
    pub fn of(error: RunError) -> Self {
        match error {
            RunError::Input(error) => Self::input(error),
            RunError::Failed(failure) => Self::run(failure),
            RunError::Stopped(stopped) => {
                let message = (stopped.progress != Progress::Elsewhere).then(|| stopped.to_string());
                Self::stopped(stopped.signal, message)
            }
        }
    }

    /// Failure of the runs of a study.
    pub fn of_sweep(error: SweepError) -> Self {
        match error {
            SweepError::Study(error) => Self::of_study(error),
            SweepError::Input(message) => Self::input(message),
            SweepError::Failed(message) => Self::run(message),
        }
    }

    /// The same failure, with what holds nevertheless.
    #[must_use]
    pub fn but(self, what: impl fmt::Display) -> Self {
        match self.message {
            Some(message) if self.status < STOPPED => Self { message: Some(format!("{message}; {what}")), ..self },
            message => Self { message, ..self },
        }
    }

    /// The exit status.
    pub fn status(&self) -> u8 {
        self.status
    }

    /// Says what happened on standard error.
    pub fn say(&self) {
        self.message.iter().for_each(message::error);
    }

    /// Says what happened on standard error and gives the exit status.
    pub fn report(self) -> ExitCode {
        self.say();
        ExitCode::from(self.status)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.message.as_deref().unwrap_or_default())
    }
}

/// Works together with the other processes of the job if there are any. From here on only the first of them gives warnings; if
/// one fails, all end with its exit status.
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
        Err(failure) if failure.status >= STOPPED => {
            failure.say();
            job.finish();
            Err(Failure { message: None, ..failure })
        }
        Err(failure) => {
            job.fail(failure.status, || failure.say());
            Err(failure)
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/failure.rs"]
mod tests;
