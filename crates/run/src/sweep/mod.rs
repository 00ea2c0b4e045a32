//! Runs of a study, as a library: [`load`] reads it, [`Sweep::prepare`] decides which of its runs are to be made, [`Sweep::run`] makes
//! them and keeps their results in its journal.
//!
//! ```no_run
//! use plateau_run::Job;
//! use plateau_run::sweep::{self, Sweep, SweepOptions};
//!
//! let plan = sweep::load("study.toml".as_ref())?;
//! let mut job = Job::start()?;
//! // `()` observes nothing.
//! let summary = Sweep::prepare(&plan, SweepOptions::default(), &job, &())?.run(&mut job, &())?;
//! println!("{} runs finished, {} failed", summary.finished, summary.failed);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | content |
//! |---|---|
//! | `resolved.rs` | scenes of the runs, built before any run is made |
//! | `run_length.rs` | length of the runs |
//! | `estimate.rs` | cost of the runs |
//! | `warnings.rs` | warnings of several runs, each kind once |
//! | `earlier.rs` | the journal: results of before, those that are left out, series that were not kept |
//! | `make.rs` | one run, from its scene to its record |
//! | `under_way.rs` | runs that are under way: one process makes each, and keeps the state from which it continues |
//! | `runner.rs` | several runs at a time |
//! | `observer.rs`, `error.rs` | who follows the runs, and their failure as a whole |

mod earlier;
mod error;
mod estimate;
mod make;
mod observer;
mod resolved;
mod run_length;
mod runner;
mod under_way;
mod warnings;

use std::collections::HashSet;
use std::path::Path;
use std::time::Instant;

use earlier::{is_whole, refuse_unwritable};
use plateau_io::number;
use plateau_io::study::Study;
use plateau_io::study::journal::{Entry, Journal};
use plateau_io::study::plan::Plan;
use plateau_io::text::shown_on_one_line;
use runner::Runner;
use serde::Serialize;

use crate::job::{Agreement, Job};
use crate::options::Program;

pub use earlier::{journal, journal_folder, say_left_out, say_unkept};
pub use error::SweepError;
pub use estimate::Estimate;
pub use observer::SweepObserver;
pub use resolved::{Resolved, ResolvedRun};
pub use run_length::{RunLength, note_short_tenths};
pub use warnings::{SceneWarnings, of_questions};

/// Files that are no part of a journal, of which the names are told.
const STRANGE: usize = 10;

/// Options of a sweep: the runs of a study that are made, and their execution.
#[derive(Debug, Clone)]
pub struct SweepOptions {
    /// Tells whether runs that failed before, or did not keep a series that is needed now, are made again.
    pub retry: bool,
    /// The part of the runs that this process makes; all of them if none.
    pub part: Option<Part>,
    /// Runs at a time, at most.
    pub jobs: usize,
    /// Threads of each run.
    pub workers: usize,
    /// Failures after which no more runs begin; as many as there are if none.
    pub most_failures: Option<usize>,
    /// The program, as records and states name it.
    pub program: Program,
}

impl Default for SweepOptions {
    /// All runs that are not there yet, one at a time on one thread.
    fn default() -> Self {
        Self { retry: false, part: None, jobs: 1, workers: 1, most_failures: None, program: Program::default() }
    }
}

/// One of several equal parts of the runs of a study: of `count` tasks the one with this number, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Its number, from 1.
    pub number: usize,
    /// Number of parts.
    pub count: usize,
}

/// Runs of a study that are to be made.
#[derive(Debug)]
pub struct Sweep<'a> {
    plan: &'a Plan,
    options: SweepOptions,
    /// None in a process that decides nothing.
    resolved: Option<Resolved>,
    journal: Journal,
    before: Before,
    pending: Vec<usize>,
}

/// Runs that ended before this process began.
#[derive(Debug, Clone, Copy, Default)]
struct Before {
    finished: usize,
    failed: usize,
    /// Not made, for they repeat another run.
    repeats: usize,
}

/// Result of a sweep: how many runs ended, when and where.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepSummary {
    /// Title of the study.
    pub study: String,
    /// Its runs.
    pub runs: usize,
    /// Runs that finished before.
    pub finished_before: usize,
    /// Runs that failed before.
    pub failed_before: usize,
    /// Runs that have the result of another one.
    pub repeats: usize,
    /// Runs that finished now.
    pub finished: usize,
    /// Runs that failed now.
    pub failed: usize,
    /// Runs that other processes of the study finished meanwhile.
    pub finished_elsewhere: usize,
    /// Runs that failed meanwhile in other processes of the study.
    pub failed_elsewhere: usize,
    /// Runs that are still to be made.
    pub left: usize,
    /// Wall time, s.
    pub wall_time: f64,
    /// Folder of the results.
    pub results: String,
    /// Runs at a time.
    #[serde(skip)]
    pub jobs: usize,
    /// The signal that stopped the runs, if one did.
    #[serde(skip)]
    pub signal: Option<u8>,
}

/// Reads a study and makes its design.
pub fn load(path: &Path) -> Result<Plan, SweepError> {
    Ok(Study::load(path).and_then(Plan::new)?)
}

impl<'a> Sweep<'a> {
    /// Builds the scene of every run, and decides which runs are to be made: those of which the journal has no result. Of several
    /// processes of a job the first decides.
    ///
    /// # Errors
    /// [`SweepError::Input`] when scenes cannot be built, responses ask for series that no run records, or results could not be kept;
    /// [`SweepError::Failed`] when the journal cannot be read. Nothing was made then.
    pub fn prepare(
        plan: &'a Plan,
        options: SweepOptions,
        job: &Job,
        observer: &dyn SweepObserver,
    ) -> Result<Self, SweepError> {
        let study = plan.study();
        let mut sweep = Self {
            plan,
            options,
            resolved: None,
            journal: Journal::default(),
            before: Before::default(),
            pending: Vec::new(),
        };
        // The first rank decides what is to be done: another one may see the journal a moment later.
        if !job.leads() {
            return Ok(sweep);
        }
        let resolved = Resolved::of_runs(plan, sweep.numbers().collect())?;
        resolved.refuse_unrecorded(study, observer)?;
        resolved.warn_of_late_questions(study, observer);
        note_short_tenths(study, &resolved.lengths(), observer);
        resolved.warnings.say("runs", observer);
        let journal = journal(study)?;
        if journal.damaged > 0 {
            let lines = number::count(journal.damaged, "damaged line");
            observer.warning(&format_args!("{}: {lines} passed over", journal_folder(study).display()));
        }
        warn_of_strange(&journal, observer);
        say_unkept(study, &resolved, &journal, sweep.options.retry, observer);
        let mut pending = Vec::new();
        for number in sweep.numbers() {
            // It has the result of the run that it repeats.
            if resolved.is_repeat(number) {
                sweep.before.repeats += 1;
                continue;
            }
            let run = &resolved.runs[&number];
            match journal.get(&run.identity) {
                Some(entry) if is_whole(entry, &run.needed) => sweep.before.finished += 1,
                Some(Entry { failure: None, .. }) if !sweep.options.retry => sweep.before.finished += 1,
                Some(_) if !sweep.options.retry => sweep.before.failed += 1,
                _ => pending.push(number),
            }
        }
        if sweep.options.part.is_none() {
            say_left_out(study, &resolved, &journal, observer);
            tidy(plan, &resolved, &journal, observer);
        }
        if !pending.is_empty() {
            refuse_unwritable(study)?;
        }
        (sweep.resolved, sweep.journal, sweep.pending) = (Some(resolved), journal, pending);
        Ok(sweep)
    }

    /// The runs of the study that this process may make, in the order in which they are made.
    fn numbers(&self) -> impl Iterator<Item = usize> + use<'a> {
        let part = self.options.part;
        let own = move |place: usize| part.is_none_or(|part| place % part.count == part.number - 1);
        self.plan.order().enumerate().filter(move |(place, _)| own(*place)).map(|(_, number)| number)
    }

    /// Runs that are to be made, by their numbers; none in a process that decides nothing.
    pub fn pending(&self) -> &[usize] {
        &self.pending
    }

    /// Steps of all of them together.
    pub fn steps(&self) -> u64 {
        let steps = |resolved: &Resolved| self.pending.iter().map(|number| resolved.runs[number].steps).sum::<u64>();
        self.resolved.as_ref().map_or(0, steps)
    }

    /// Makes the runs, together with the other processes of the job if there are any. A run that fails ends by itself; a signal leaves
    /// the state of each run, and the rest to the next sweep.
    pub fn run(self, job: &mut Job, observer: &dyn SweepObserver) -> Result<SweepSummary, SweepError> {
        let Self { plan, options, resolved, journal, before, pending } = self;
        let study = plan.study();
        let jobs = options.jobs.min(pending.len().max(1));
        let start = Instant::now();
        let runner = Runner::new(plan, resolved.as_ref(), journal, options.workers, options.program.build(), observer);
        let shared = job.share(&pending, jobs, options.most_failures, &|number| runner.make(number));
        let made = runner.end(shared.map_err(SweepError::failed))?;
        runner.say_warnings();
        let (finished, failed) = job.sum(made.finished, made.failed).map_err(SweepError::failed)?;
        let elsewhere = job.sum(made.finished_elsewhere, made.failed_elsewhere).map_err(SweepError::failed)?;
        let ended = finished + failed + elsewhere.0 + elsewhere.1;
        let wall_time = start.elapsed().as_secs_f64();
        let own = Agreement { signal: runner.signal(), ..Agreement::default() };
        let signal = job.agree(own).map_err(SweepError::failed)?.signal;
        Ok(SweepSummary {
            study: study.title.clone(),
            runs: plan.runs(),
            finished_before: before.finished,
            failed_before: before.failed,
            repeats: before.repeats,
            finished,
            failed,
            finished_elsewhere: elsewhere.0,
            failed_elsewhere: elsewhere.1,
            left: pending.len() - ended.min(pending.len()),
            wall_time,
            results: study.directory.display().to_string(),
            jobs: if job.ranks() > 1 { job.ranks() } else { jobs },
            signal,
        })
    }
}

/// Names files in the journal that are no part of it.
fn warn_of_strange(journal: &Journal, observer: &dyn SweepObserver) {
    if journal.strange.is_empty() {
        return;
    }
    let names = journal.strange.iter().filter_map(|path| path.file_name());
    let names: Vec<_> =
        names.take(STRANGE).map(|name| shown_on_one_line(&name.to_string_lossy()).into_owned()).collect();
    let more = if journal.strange.len() > STRANGE { ", …" } else { "" };
    observer.warning(&format_args!(
        "no journals of this program, or damaged ones: {}{more}; they stay as they are, move them away if nobody needs them",
        names.join(", ")
    ));
}

/// Removes what killed processes left of runs that have ended, and says what is of no use to this study.
fn tidy(plan: &Plan, resolved: &Resolved, journal: &Journal, observer: &dyn SweepObserver) {
    let results = &plan.study().directory;
    let runs: HashSet<&str> = resolved.runs.values().map(|run| run.identity.as_str()).collect();
    let has_ended = |identity: &str| journal.get(identity).is_some_and(|entry| entry.failure.is_none());
    let strangers = under_way::tidy(results, |identity| runs.contains(identity), has_ended);
    if strangers > 0 {
        observer.note(&format_args!(
            "{} of runs that the study no longer has, or of another generation of the program; nothing needs what is older than that in {}",
            number::count(strangers, "state"),
            results.join("under-way").display()
        ));
    }
}
