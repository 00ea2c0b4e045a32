//! End of the program when it cannot do what was asked: the message, with the lines of a file that are wrong, and the exit status.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

use console::measure_text_width;
use plateau_io::delimited::{decode, numbered};
use plateau_io::scene::{Origin, Problem, SceneError};
use plateau_io::study::StudyError;
use plateau_io::text;
pub use plateau_run::Failure;
use plateau_run::Job;

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

/// A scene that cannot be used, with the lines that are wrong.
pub fn of_scene(error: SceneError) -> Failure {
    Failure::because(&error, excerpt(error.problems()))
}

/// A study that cannot be used, with the lines that are wrong.
pub fn of_study(error: StudyError) -> Failure {
    Failure::because(&error, excerpt(&error.0))
}

/// Says what happened on standard error.
pub fn say(failure: &Failure) {
    failure.message.iter().for_each(message::error);
}

/// Says what happened on standard error and gives the exit status.
pub fn report(failure: Failure) -> ExitCode {
    say(&failure);
    ExitCode::from(failure.status)
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
        Err(failure) if failure.status >= Failure::STOPPED => {
            say(&failure);
            job.finish();
            Err(Failure { message: None, ..failure })
        }
        Err(failure) => {
            job.fail(failure.status, || say(&failure));
            Err(failure)
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/failure.rs"]
mod tests;
