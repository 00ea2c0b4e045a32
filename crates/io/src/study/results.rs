//! Results of the runs of a study, as far as there are any, and as a table of text: a line for each run, units in the head, those in which
//! the study states its factors, and SI units of responses.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use thiserror::Error;

use super::factor::Level;
use super::journal::{Entry, Journal};
use super::plan::{Plan, Run};
use super::record::{Series, firsts, unit_of};
use super::response::NoAnswer;
use crate::dataset_file::DatasetFileError;

/// The results of the runs of a study, as far as there are any.
#[derive(Debug, Clone)]
pub struct Collected {
    /// The runs in the order of the design.
    pub runs: Vec<CollectedRun>,
}

/// A run and what came of it.
#[derive(Debug, Clone)]
pub struct CollectedRun {
    /// The run.
    pub run: Run,
    /// The first run of the design with the same scene and files, by its place: its own unless it repeats that
    /// one, whose result it has.
    pub first: usize,
    /// End of the run, if it has ended.
    pub state: RunStatus,
    /// Answers to the questions of the study, in their order; NaN where there is none.
    pub responses: Vec<f64>,
    /// Reason why a finished run gives no answer to a question, with its place.
    pub unanswered: Vec<(usize, NoAnswer)>,
    /// Standard errors of the responses; NaN where there is none.
    pub errors: Vec<f64>,
    /// Wall time, s; NaN if it has not ended.
    pub wall_time: f64,
    pub(super) entry: Option<Entry>,
    pub(super) time: Vec<f64>,
    pub(super) series: Vec<String>,
}

/// End of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RunStatus {
    /// All steps were taken.
    Finished,
    /// Run that failed, for this reason.
    Failed(String),
    /// Run that was not made yet, or with other files or numbers of the program.
    Missing,
}

impl RunStatus {
    /// Name of the state, one word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Failed(_) => "failed",
            Self::Missing => "missing",
        }
    }
}

/// Reason why results cannot be collected.
#[derive(Debug, Error)]
pub enum CollectError {
    /// The journal cannot be read.
    #[error("cannot read the results: {0}")]
    Read(#[from] io::Error),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] DatasetFileError),
}

impl Collected {
    /// Looks up the results of all runs; `identities` are theirs, in the order of the design.
    pub fn new(plan: &Plan, identities: &[String], journal: &Journal) -> Result<Self, CollectError> {
        let responses = &plan.study().responses;
        let run = |((number, identity), first): ((usize, &String), usize)| {
            let mut collected = CollectedRun {
                run: plan.run(number),
                first,
                state: RunStatus::Missing,
                responses: vec![f64::NAN; responses.len()],
                errors: vec![f64::NAN; responses.len()],
                unanswered: Vec::new(),
                wall_time: f64::NAN,
                entry: journal.get(identity).cloned(),
                time: Vec::new(),
                series: Vec::new(),
            };
            if let Some(entry) = &collected.entry {
                collected.wall_time = entry.wall_time;
                collected.state = entry.failure.clone().map_or(RunStatus::Finished, RunStatus::Failed);
                let series = series(entry)?;
                if series.is_none() && collected.state == RunStatus::Finished {
                    collected.state = RunStatus::Failed(NO_SERIES.to_owned());
                }
                if let Some(series) = series {
                    collected.time = series.time().to_vec();
                    collected.series = series.names().to_vec();
                    let known = |answer: Option<f64>| answer.unwrap_or(f64::NAN);
                    let answers: Vec<_> = responses.iter().map(|response| response.of(&series)).collect();
                    collected.responses = answers.iter().map(|answer| *answer.as_ref().unwrap_or(&f64::NAN)).collect();
                    collected.unanswered =
                        answers.into_iter().enumerate().filter_map(|(at, answer)| Some((at, answer.err()?))).collect();
                    collected.errors = responses.iter().map(|response| known(response.error_of(&series))).collect();
                }
            }
            Ok(collected)
        };
        let runs = (1..).zip(identities).zip(firsts(identities)).map(run).collect::<Result<_, CollectError>>()?;
        Ok(Self { runs })
    }

    /// Number of runs that repeat another one: they tell nothing that it does not.
    pub fn repeats(&self) -> usize {
        self.runs.iter().enumerate().filter(|(place, run)| run.first != *place).count()
    }

    /// Number of runs that ended like this.
    pub fn count(&self, state: &str) -> usize {
        self.runs.iter().filter(|run| run.state.name() == state).count()
    }
}

/// Name of the standard error of a response.
pub fn error_name(response: &str) -> String {
    format!("{response} standard error")
}

/// Message on a run whose record is whole and whose series are not.
const NO_SERIES: &str = "its record in the journal holds no series; move the journal away, and make the runs again";

/// The series of a record; none of a run that failed, and none where the record does not hold what it says.
pub(super) fn series(entry: &Entry) -> Result<Option<Series>, CollectError> {
    Ok(entry.record()?.outcome.series())
}

/// Heads of the first columns of every table.
const FIRST: [&str; 4] = ["run", "point", "replicate", "state"];

/// Head and lines: number, point, replicate and state of each run, its factors and responses, and why it failed.
///
/// Quantities are numbers in the unit that stands behind the name, as in `speed [rpm]`: in that of the study, if it states all
/// levels of a factor in one, or in SI units; words, and numbers without a unit, stand as the study has them. A response that a run
/// does not give is an empty cell; one that no run gives by itself has no column. A response that has a standard error is
/// followed by it.
pub fn table(plan: &Plan, collected: &Collected) -> Vec<Vec<String>> {
    let study = plan.study();
    let mut names = Names::default();
    // Its head, and a cell for each run.
    let mut column = |name: &str, what: &str, unit: &str, cell: &dyn Fn(&CollectedRun) -> String| -> Vec<String> {
        std::iter::once(names.head(name, what, unit)).chain(collected.runs.iter().map(cell)).collect()
    };
    let mut columns = vec![
        column(FIRST[0], "", "", &|run| run.run.number.to_string()),
        column(FIRST[1], "", "", &|run| (run.run.point + 1).to_string()),
        column(FIRST[2], "", "", &|run| (run.run.replicate + 1).to_string()),
        column(FIRST[3], "", "", &|run| run.state.name().to_owned()),
    ];
    // The last column; its name is nobody else's.
    let error = column("error", "", "", &|run| match &run.state {
        RunStatus::Failed(error) => error.clone(),
        RunStatus::Finished | RunStatus::Missing => String::new(),
    });
    for (at, factor) in study.factors.iter().enumerate() {
        let levels: Vec<&Level> = collected.runs.iter().map(|run| &run.run.levels[at]).collect();
        let is_quantity = !["", "1"].contains(&factor.unit()) && levels.iter().all(|level| level.number.is_some());
        let stated = stated_unit(&levels).filter(|_| is_quantity);
        let unit = stated.unwrap_or(if is_quantity { factor.unit() } else { "" });
        columns.push(column(&factor.name, "factor", unit, &|run| {
            let level = &run.run.levels[at];
            let number = if stated.is_some() { level.split().map(|(number, _)| number) } else { level.number };
            number.filter(|_| is_quantity).map_or_else(|| level.label.clone(), exactly)
        }));
    }
    for (at, response) in study.responses.iter().enumerate().filter(|(_, response)| response.is_of_one_run()) {
        let unit = Some(response.unit(unit_of(&response.series))).filter(|unit| *unit != "1").unwrap_or_default();
        let number = |number: f64| if number.is_nan() { String::new() } else { exactly(number) };
        columns.push(column(&response.name, "response", unit, &|run| number(run.responses[at])));
        if response.has_error() {
            columns.push(column(&error_name(&response.name), "response", unit, &|run| number(run.errors[at])));
        }
    }
    columns.push(error);
    (0..=collected.runs.len()).map(|line| columns.iter().map(|column| column[line].clone()).collect()).collect()
}

/// Tells whether a file is such a table, as far as its first columns tell.
pub fn is_results_table(path: &Path) -> bool {
    let first = format!("{},", FIRST.join(","));
    let mut found = vec![0; first.len()];
    let read = path.is_file().then(|| File::open(path).and_then(|mut file| file.read_exact(&mut found)));
    read.is_some_and(|read| read.is_ok()) && found == first.as_bytes()
}

/// The unit in which all of some levels are stated, if it is one.
fn stated_unit<'a>(levels: &[&'a Level]) -> Option<&'a str> {
    let unit = |level: &&'a Level| level.split().map(|(_, unit)| unit).filter(|unit| !unit.is_empty());
    let first = unit(levels.first()?)?;
    levels.iter().all(|level| unit(level) == Some(first)).then_some(first)
}

/// Number of runs of such a table that finished; none where it does not say.
pub fn finished(path: &Path) -> Option<usize> {
    let place = FIRST.iter().position(|name| *name == "state")?;
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(path).ok()?;
    let has_finished = |row: &csv::ByteRecord| row.get(place) == Some(RunStatus::Finished.name().as_bytes());
    Some(reader.byte_records().map_while(Result::ok).filter(has_finished).count())
}

/// A number with all its digits.
fn exactly(number: f64) -> String {
    format!("{number:?}")
}

/// Heads of columns, each given once.
#[derive(Default)]
struct Names(BTreeSet<String>);

impl Names {
    /// Name and unit; where that is taken, with what it is behind the name.
    fn head(&mut self, name: &str, what: &str, unit: &str) -> String {
        let behind = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        let mut name = name.to_owned();
        while !self.0.insert(format!("{name}{behind}")) {
            name = format!("{name} ({what})");
        }
        format!("{name}{behind}")
    }
}

#[cfg(test)]
#[path = "../../tests/unit/study/results.rs"]
mod tests;
