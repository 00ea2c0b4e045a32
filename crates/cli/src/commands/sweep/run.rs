//! `plateau sweep run`: make the runs of a study that are not there yet.

use std::collections::HashSet;
use std::time::Instant;

use plateau_io::study::journal::{Entry, Journal};
use plateau_io::study::plan::Plan;
use plateau_io::text::shown_on_one_line;
use plateau_run::job::Agreement;
use plateau_run::{Job, signal_in_words};
use serde::Serialize;

use crate::arguments::SweepRunArguments;
use crate::failure::{Failure, in_job};
use crate::interrupt::Interrupt;
use crate::sweep::floor::Floor;
use crate::sweep::progress::Progress;
use crate::sweep::resolved::Resolved;
use crate::sweep::unkept::{self, is_whole};
use crate::sweep::{self, journal_folder, left_out, refuse_unwritable, short_tenth, under_way};
use crate::table::{print, table};
use crate::{message, number};

/// Files that are no part of a journal, of which the names are told.
const STRANGE: usize = 10;

/// Makes the runs, together with the other processes of the job if there are any.
pub fn run(arguments: &SweepRunArguments) -> Result<(), Failure> {
    in_job(|job| run_study(arguments, job))
}

fn run_study(arguments: &SweepRunArguments, job: &mut Job) -> Result<(), Failure> {
    let plan = sweep::plan(&arguments.study)?;
    let study = plan.study();
    // The first rank decides what is to be done: another one may see the journal a moment later.
    let numbers = || {
        let own = |place: usize| arguments.task.is_none_or(|task| place % task.count == task.number - 1);
        plan.order().enumerate().filter(move |(place, _)| own(*place)).map(|(_, number)| number)
    };
    let resolved = if job.leads() { Some(Resolved::of_runs(&plan, numbers().collect())?) } else { None };
    let mut journal = Journal::default();
    let mut before = Before::default();
    let mut pending = Vec::new();
    if let Some(resolved) = &resolved {
        resolved.refuse_unrecorded(study)?;
        resolved.warn_of_late_questions(study);
        short_tenth::say(study, &resolved.lengths());
        resolved.warnings.say("runs");
        journal = sweep::journal(study)?;
        if journal.damaged > 0 {
            let lines = number::count(journal.damaged, "damaged line");
            message::warning(format_args!("{}: {lines} passed over", journal_folder(study).display()));
        }
        warn_of_strange(&journal);
        unkept::say(study, resolved, &journal, arguments.retry);
        for number in numbers() {
            // It has the result of the run that it repeats.
            if resolved.is_repeat(number) {
                before.repeats += 1;
                continue;
            }
            let run = &resolved.runs[&number];
            match journal.get(&run.identity) {
                Some(entry) if is_whole(entry, &run.needed) => before.finished += 1,
                Some(Entry { failure: None, .. }) if !arguments.retry => before.finished += 1,
                Some(_) if !arguments.retry => before.failed += 1,
                _ => pending.push(number),
            }
        }
        if arguments.task.is_none() {
            left_out::say(study, resolved, &journal);
            tidy(&plan, resolved, &journal);
        }
    }
    if !pending.is_empty() {
        refuse_unwritable(study)?;
    }
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    // Else a signal that asks runs for a checkpoint would end all of them; these keep theirs by the clock.
    interrupt.listen_for_save().map_err(Failure::run)?;
    let jobs = arguments.cores.runs_at_a_time().min(pending.len().max(1));
    let workers = arguments.cores.workers();
    if job.ranks() > 1 && arguments.cores.jobs.is_some() && job.leads() {
        message::warning("each rank makes one run at a time: --jobs has no effect");
    }
    let steps = resolved.iter().flat_map(|resolved| pending.iter().map(|number| resolved.runs[number].steps)).sum();
    let start = Instant::now();
    let progress = Progress::new(pending.len(), steps, job.leads());
    let floor = Floor::new(&plan, resolved.as_ref(), journal, workers, interrupt, progress);
    let limit = arguments.max_failures.map(|limit| limit as usize);
    let shared = job.share(&pending, jobs, limit, &|number| floor.make(number));
    let made = floor.end(shared.map_err(Failure::run))?;
    floor.say_warnings();
    let (finished, failed) = job.sum(made.finished, made.failed).map_err(Failure::run)?;
    let elsewhere = job.sum(made.finished_elsewhere, made.failed_elsewhere).map_err(Failure::run)?;
    let ended = finished + failed + elsewhere.0 + elsewhere.1;
    let summary = Summary {
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
        wall_time: start.elapsed().as_secs_f64(),
        results: study.directory.display().to_string(),
    };
    if job.leads() {
        summary.print(arguments, if job.ranks() > 1 { job.ranks() } else { jobs })?;
    }
    let own = Agreement { signal: floor.signal(), ..Agreement::default() };
    let signal = job.agree(own).map_err(Failure::run)?.signal;
    if let Some(signal) = signal {
        let message = || {
            format!("stopped by {}; {} runs are left, the same command goes on", signal_in_words(signal), summary.left)
        };
        return Err(Failure::Stopped { signal, message: job.leads().then(message) });
    }
    match summary.failed + summary.failed_elsewhere + summary.failed_before {
        0 => Ok(()),
        failed => Err(Failure::run(format_args!(
            "{} of {} failed; `plateau sweep collect` lists their errors, --retry makes them again",
            failed,
            number::count(summary.runs, "run")
        ))),
    }
}

/// Names files in the journal that are no part of it.
fn warn_of_strange(journal: &Journal) {
    if journal.strange.is_empty() {
        return;
    }
    let names = journal.strange.iter().filter_map(|path| path.file_name());
    let names: Vec<_> =
        names.take(STRANGE).map(|name| shown_on_one_line(&name.to_string_lossy()).into_owned()).collect();
    let more = if journal.strange.len() > STRANGE { ", …" } else { "" };
    message::warning(format_args!(
        "no journals of this program, or damaged ones: {}{more}; they stay as they are, move them away if nobody needs them",
        names.join(", ")
    ));
}

/// Removes what killed processes left of runs that have ended, and says what is of no use to this study.
fn tidy(plan: &Plan, resolved: &Resolved, journal: &Journal) {
    let results = &plan.study().directory;
    let runs: HashSet<&str> = resolved.runs.values().map(|run| run.identity.as_str()).collect();
    let has_ended = |identity: &str| journal.get(identity).is_some_and(|entry| entry.failure.is_none());
    let strangers = under_way::tidy(results, |identity| runs.contains(identity), has_ended);
    if strangers > 0 {
        message::note(format_args!(
            "{} of runs that the study no longer has, or of another generation of the program; nothing needs what is older than that in {}",
            number::count(strangers, "state"),
            results.join("under-way").display()
        ));
    }
}

/// Runs that ended before this process began.
#[derive(Debug, Default)]
struct Before {
    finished: usize,
    failed: usize,
    /// Not made, for they repeat another run.
    repeats: usize,
}

/// What `plateau sweep run` reports.
#[derive(Debug, Serialize)]
struct Summary {
    study: String,
    runs: usize,
    finished_before: usize,
    failed_before: usize,
    /// Runs that have the result of another one.
    repeats: usize,
    finished: usize,
    failed: usize,
    /// Made meanwhile by other processes of the study.
    finished_elsewhere: usize,
    failed_elsewhere: usize,
    left: usize,
    wall_time: f64,
    results: String,
}

impl Summary {
    fn print(&self, arguments: &SweepRunArguments, jobs: usize) -> Result<(), Failure> {
        if arguments.json {
            return print(&(serde_json::to_string_pretty(self).map_err(Failure::run)? + "\n"));
        }
        let task = arguments.task.map(|task| format!("task {} of {}", task.number, task.count));
        let mut rows = vec![("runs of the study", self.runs.to_string())];
        rows.extend(task.map(|task| ("made here", task)));
        if self.repeats > 0 {
            rows.push(("repeats of others", self.repeats.to_string()));
        }
        rows.push(("finished before", self.finished_before.to_string()));
        rows.push((
            "finished now",
            format!("{}, {jobs} at a time, in {}", self.finished, number::duration(self.wall_time)),
        ));
        if self.finished_elsewhere > 0 {
            rows.push(("by other processes", format!("{} meanwhile", self.finished_elsewhere)));
        }
        if self.failed + self.failed_elsewhere + self.failed_before > 0 {
            rows.push((
                "failed",
                format!("{} now, {} before", self.failed + self.failed_elsewhere, self.failed_before),
            ));
        }
        if self.left > 0 {
            rows.push(("left", self.left.to_string()));
        }
        rows.push(("results", self.results.clone()));
        print(&table(&self.study, &rows))
    }
}
