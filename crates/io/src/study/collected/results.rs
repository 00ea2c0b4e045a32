//! The results of the runs of a study, as far as there are any.

use std::io;

use thiserror::Error;

use super::super::identity::firsts;
use super::super::journal::{Entry, Journal};
use super::super::plan::{Plan, Run};
use super::super::record::Series;
use super::super::response::NoAnswer;
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
    /// How it ended, if it did.
    pub state: State,
    /// Answers to the questions of the study, in their order; NaN where there is none.
    pub responses: Vec<f64>,
    /// Why a finished run gives no answer to a question, with its place.
    pub unanswered: Vec<(usize, NoAnswer)>,
    /// Standard errors of these; NaN where there is none.
    pub errors: Vec<f64>,
    /// Wall time, s; NaN if it has not ended.
    pub wall_time: f64,
    pub(super) entry: Option<Entry>,
    /// Times of its samples, if it finished.
    pub(super) time: Vec<f64>,
    /// Names of its series.
    pub(super) series: Vec<String>,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum State {
    /// All steps were taken.
    Finished,
    /// It failed for this reason.
    Failed(String),
    /// It was not made yet, or with other files or numbers of the program.
    Missing,
}

impl State {
    /// One word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Failed(_) => "failed",
            Self::Missing => "missing",
        }
    }
}

/// Why results cannot be collected.
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
    ///
    /// # Errors
    /// [`CollectError::Read`].
    pub fn new(plan: &Plan, identities: &[String], journal: &Journal) -> Result<Self, CollectError> {
        let responses = &plan.study().responses;
        let run = |((number, identity), first): ((usize, &String), usize)| {
            let mut collected = CollectedRun {
                run: plan.run(number),
                first,
                state: State::Missing,
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
                collected.state = entry.failure.clone().map_or(State::Finished, State::Failed);
                let series = series(entry)?;
                if series.is_none() && collected.state == State::Finished {
                    collected.state = State::Failed(NO_SERIES.to_owned());
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

    /// How many runs repeat another one: they tell nothing that it does not.
    pub fn repeats(&self) -> usize {
        self.runs.iter().enumerate().filter(|(place, run)| run.first != *place).count()
    }

    /// How many runs ended like this.
    pub fn count(&self, state: &str) -> usize {
        self.runs.iter().filter(|run| run.state.name() == state).count()
    }
}

/// What is known of a run whose record is whole and whose series are not.
const NO_SERIES: &str = "its record in the journal holds no series; move the journal away, and make the runs again";

/// The series of a record; none of a run that failed, and none where the record does not hold what it says.
pub(super) fn series(entry: &Entry) -> Result<Option<Series>, CollectError> {
    Ok(entry.record()?.outcome.series())
}
