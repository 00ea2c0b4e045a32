//! Extra runs at places where the responses were foretold, with all seeds of the study.
//!
//! They have a journal of their own, `confirm` in the folder of the results: the fit is never made of them, so they judge it,
//! and asking again makes none twice.

use std::collections::BTreeSet;

use plateau_io::study::collected::{Collected, CollectedRun};
use plateau_io::study::level::Level;
use plateau_io::study::plan::Plan;
use plateau_io::study::{DesignSource, Order, Study};
use plateau_io::{brief, number};
use plateau_present::study::analysis::Analysis;
use plateau_run::{Job, signal_in_words};
use plateau_study::surrogate::Forecast;
use serde::Serialize;

use super::floor::Floor;
use super::progress::Progress;
use super::resolved::{Resolved, ResolvedRun};
use super::unkept::is_whole;
use super::{journal, refuse_unwritable};
use crate::arguments::CoresArguments;
use crate::failure::{Failure, in_job};
use crate::interrupt::Interrupt;
use crate::message;

/// What the extra runs gave of a response.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Confirmed {
    /// Runs that have the response.
    pub runs: usize,
    /// Mean over them, SI.
    pub mean: f64,
    /// Its standard error, from what the runs differ by; none of a single run.
    pub standard_error: Option<f64>,
    /// Whether the mean is within the interval that was foretold for a run; none where there is no interval.
    pub within_run_interval: Option<bool>,
}

/// A place, and what is expected of each response there.
pub type Expected<'a> = (&'a [Level], &'a [Option<Forecast>]);

/// Makes the runs that are not there yet, and looks at each response of the study beside what was expected of it, at each place. The runs of the
/// study itself have the `known` identities.
///
/// # Errors
/// [`Failure::Input`] when a scene cannot be built there, [`Failure::Run`] when no run ends well, [`Failure::Stopped`].
pub fn confirm(
    plan: &Plan,
    known: &[String],
    places: &[Expected<'_>],
    cores: &CoresArguments,
) -> Result<Vec<Vec<Option<Confirmed>>>, Failure> {
    let study = Study {
        source: DesignSource::File(places.iter().map(|(levels, _)| levels.to_vec()).collect()),
        directory: plan.study().directory.join("confirm"),
        order: Order::Standard,
        ..plan.study().clone()
    };
    let extra = Plan::new(study).map_err(Failure::of_study)?;
    let resolved = Resolved::of(&extra)?;
    let identities = resolved.identities();
    resolved.warnings.say("confirming runs");
    warn_of_known(known, &identities);
    in_job(|job| make(&extra, &resolved, cores, job))?;
    let journal = journal(extra.study())?;
    let collected = Collected::new(&extra, &identities, &journal).map_err(Failure::run)?;
    if collected.count("finished") == 0 {
        let place = if places.len() > 1 { "any of these places" } else { "this place" };
        return Err(Failure::run(format_args!("no run at {place} ended well, so nothing is confirmed")));
    }
    let of_place = |(point, (_, expected)): (usize, &Expected<'_>)| {
        let runs: Vec<&CollectedRun> = collected.runs.iter().filter(|run| run.run.point == point).collect();
        let each = expected.iter().enumerate();
        each.map(|(response, expected)| Confirmed::of(&runs, response, *expected)).collect()
    };
    Ok(places.iter().enumerate().map(of_place).collect())
}

/// Warns of confirming runs that are runs of the study: the fit has used them.
fn warn_of_known(known: &[String], extra: &[String]) {
    let number = |identity: &String| known.iter().position(|other| other == identity).map(|at| at + 1);
    let numbers: BTreeSet<usize> = extra.iter().filter_map(number).collect();
    if !numbers.is_empty() {
        let runs = if numbers.len() == 1 { "run" } else { "runs" };
        let list = brief::list(numbers.iter().map(ToString::to_string), ", ");
        message::warning(format_args!(
            "a point of the study is at this place, and its {runs} {list} with the same seeds would be the confirming ones: the fit has used \
             them, so they confirm nothing; ask for another place, or give a study of this place with other seeds"
        ));
    }
}

fn make(plan: &Plan, resolved: &Resolved, cores: &CoresArguments, job: &mut Job) -> Result<(), Failure> {
    if job.ranks() > 1 {
        return Err(Failure::input("confirming runs are made by one process: call this without mpirun"));
    }
    let journal = journal(plan.study())?;
    let is_missing = |(number, run): &(&usize, &ResolvedRun)| {
        let is_there = journal.get(&run.identity).is_some_and(|entry| is_whole(entry, &run.needed));
        !resolved.is_repeat(**number) && !is_there
    };
    let pending: Vec<usize> = resolved.runs.iter().filter(is_missing).map(|(number, _)| *number).collect();
    if pending.is_empty() {
        return Ok(());
    }
    refuse_unwritable(plan.study())?;
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    interrupt.listen_for_save().map_err(Failure::run)?;
    let steps = pending.iter().map(|number| resolved.runs[number].steps).sum();
    let progress = Progress::new(pending.len(), steps, job.leads());
    let floor = Floor::new(plan, Some(resolved), journal, cores.workers(), interrupt, progress);
    let shared = job.share(&pending, cores.runs_at_a_time(), None, &|number| floor.make(number));
    floor.say_warnings();
    let made = floor.end(shared.map_err(Failure::run))?;
    if let Some(signal) = floor.signal() {
        let message = format!("stopped by {}; the same command goes on", signal_in_words(signal));
        return Err(Failure::Stopped { signal, message: Some(message) });
    }
    let failed = made.failed + made.failed_elsewhere;
    if failed > 0 {
        message::warning(format_args!("{} failed and are left out", number::count(failed, "confirming run")));
    }
    Ok(())
}

impl Confirmed {
    /// What the runs of a place say, each of the different ones once.
    fn of(runs: &[&CollectedRun], response: usize, expected: Option<Forecast>) -> Option<Self> {
        let mut counted = BTreeSet::new();
        let different = runs.iter().filter(|run| counted.insert(run.first));
        let values = different.filter_map(|run| run.responses.get(response).copied());
        let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        if values.is_empty() {
            return None;
        }
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let standard_error = (values.len() > 1).then(|| (squares / (count - 1.0) / count).sqrt());
        let interval = expected.and_then(|expected| expected.run_interval);
        let within_run_interval = interval.map(|[low, high]| (low..=high).contains(&mean));
        Some(Self { runs: values.len(), mean, standard_error, within_run_interval })
    }

    /// The cells of a line: name, mean with standard error, runs, and what the interval says.
    pub fn cells(&self, analysis: &Analysis, response: usize) -> Vec<String> {
        let own = &analysis.responses[response];
        let error = self.standard_error.map(|error| own.scale.unit.difference(error));
        let verdict = match self.within_run_interval {
            Some(true) => "within the interval of runs",
            Some(false) => "outside the interval of runs: the model does not hold here",
            None => "there is no interval",
        };
        let mean = number::with_error(own.scale.unit.value(self.mean), error);
        vec![own.head(), mean, self.runs.to_string(), verdict.to_owned()]
    }
}
