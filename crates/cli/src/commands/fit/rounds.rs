//! The runs of a fit: those of the study's design first, then further ones where they teach most.

use std::collections::BTreeSet;
use std::io::IsTerminal as _;
use std::path::PathBuf;

use plateau_io::study::collected::Collected;
use plateau_io::study::factor::Factor;
use plateau_io::study::journal::Journal;
use plateau_io::study::level::Level;
use plateau_io::study::plan::Plan;
use plateau_io::study::{DesignSource, Order, Study};
use plateau_present::study::place::shortened;
use plateau_run::job::Agreement;
use plateau_run::{Job, signal_in_words};
use plateau_study::design::Setting;
use plateau_study::fit::{Fit, Key};

use super::task::Task;
use crate::arguments::FitArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::sweep::floor::Floor;
use crate::sweep::progress::Progress;
use crate::sweep::resolved::{Resolved, ResolvedRun};
use crate::sweep::unkept::{self, is_whole};
use crate::sweep::{journal, journal_folder, refuse_unwritable};
use crate::{message, number};

/// Points that are added before the next fit: as many runs can be made at a time, each with all seeds.
const AT_A_TIME: usize = 4;

/// A fit and the runs that it rests on.
pub struct Fitted {
    /// All runs.
    pub plan: Plan,
    /// Their results.
    pub collected: Collected,
    /// The fit.
    pub fit: Fit,
    /// Fits that were made one after the other.
    pub rounds: usize,
    /// Points of the study's design.
    pub first_points: usize,
    /// Why no more runs were made.
    pub end: End,
    /// The study, its tables, its scenes and what they read.
    pub inputs: Vec<PathBuf>,
}

/// Why no more runs were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// They would change little.
    Settled,
    /// As many runs were made as the study allows.
    Budget,
    /// Every place that counts was run.
    NowhereElse,
    /// All that the study allows besides would hardly make the forecasts better.
    NoGain,
}

/// Makes runs and fits in turn until more runs would change little, or as many were made as the study allows. Everything is
/// the same whenever it is done again, so runs that are in the journal are not made again. All processes of a job make runs; the
/// first one fits and tells the others where the next runs are. Gives nothing in a process that does not lead.
///
/// # Errors
/// [`Failure::Input`] when scenes cannot be built, [`Failure::Run`] when runs fail, [`Failure::Stopped`] after a signal.
pub fn fitted(plan: Plan, task: &Task, arguments: &FitArguments, job: &mut Job) -> Result<Option<Fitted>, Failure> {
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    interrupt.listen_for_save().map_err(Failure::run)?;
    let (study, seeds) = (plan.study().clone(), plan.replicates());
    let mut points: Vec<Vec<Level>> = (0..plan.points()).map(|point| plan.run(1 + point * seeds).levels).collect();
    let first_points = points.len();
    let mut tried = BTreeSet::new();
    let mut shares = Vec::new();
    for round in 1.. {
        let source = DesignSource::File(points.clone());
        let plan = Plan::new(Study { source, order: Order::Standard, ..study.clone() }).map_err(Failure::of_study)?;
        let Some((collected, scenes)) = made(&plan, arguments, job, &interrupt, &mut tried, round == 1)? else {
            let next = job.first_says(&[]).map_err(Failure::run)?;
            if next.is_empty() {
                return Ok(None);
            }
            for place in next.chunks(task.keys.len()) {
                points.push(levels(&study, &place.iter().copied().map(f64::from_bits).collect::<Vec<_>>())?);
            }
            continue;
        };
        let fit = task.fit(&study, &collected)?;
        let affordable = study.fit.runs.saturating_sub(plan.runs()) / seeds;
        let next = fit.next_points(AT_A_TIME.min(affordable), seeds);
        let end = match (fit.is_settled(), affordable, next.is_empty()) {
            (true, ..) => Some(End::Settled),
            (_, 0, _) => Some(End::Budget),
            (.., true) => Some(End::NowhereElse),
            _ => (!fit.is_worth_more(&shares, affordable, seeds)).then_some(End::NoGain),
        };
        shares.push(fit.surrogate_share());
        let told: Vec<u64> = next.iter().filter(|_| end.is_none()).flatten().map(|coded| coded.to_bits()).collect();
        job.first_says(&told).map_err(Failure::run)?;
        if let Some(end) = end {
            let inputs = study.inputs().into_iter().chain(scenes).collect();
            return Ok(Some(Fitted { plan, collected, fit, rounds: round, first_points, end, inputs }));
        }
        note_to_terminal(format_args!(
            "{} of at most {}: {}; {} more",
            plan.runs(),
            number::count(study.fit.runs, "run"),
            so_far(&study, &task.keys, &fit),
            number::count(next.len() * seeds, "run")
        ));
        for place in &next {
            points.push(levels(&study, place)?);
        }
    }
    Err(Failure::run("the fit did not end"))
}

/// A note for those who look on, as the bar of the runs is.
fn note_to_terminal(note: std::fmt::Arguments<'_>) {
    if std::io::stderr().is_terminal() {
        message::note(note);
    }
}

/// The most likely values so far, in words.
fn so_far(study: &Study, keys: &[Key], fit: &Fit) -> String {
    let label = |((factor, key), value): ((&Factor, &Key), f64)| {
        let level = factor.at(Setting::Coded(key.coded(value).clamp(-1.0, 1.0)));
        let label = level.map_or_else(|| number::short(value), |level| shortened(&level));
        format!("{} {label}", factor.name)
    };
    study.factors.iter().zip(keys).zip(fit.best()).map(label).collect::<Vec<_>>().join(", ")
}

/// The values of a place in coded units.
fn levels(study: &Study, place: &[f64]) -> Result<Vec<Level>, Failure> {
    let level = |(factor, coded): (&Factor, &f64)| {
        let level = factor.at(Setting::Coded(*coded));
        level.ok_or_else(|| Failure::run(format_args!("\"{}\" has no value at {coded}", factor.name)))
    };
    study.factors.iter().zip(place).map(level).collect()
}

/// Makes the runs that are not there yet, and gives the results of all with the files of their scenes, in the process that leads.
/// What the scenes can hardly mean is said if they are the first ones: further runs lie between them.
fn made(
    plan: &Plan,
    arguments: &FitArguments,
    job: &mut Job,
    interrupt: &Interrupt,
    tried: &mut BTreeSet<String>,
    are_first: bool,
) -> Result<Option<(Collected, BTreeSet<PathBuf>)>, Failure> {
    let warns = are_first && job.leads();
    let study = plan.study();
    // The first rank decides what is to be done: another one may see the journal a moment later.
    let resolved = if job.leads() { Some(Resolved::of(plan)?) } else { None };
    let known = if job.leads() { journal(study)? } else { Journal::default() };
    let mut pending = Vec::new();
    if let Some(resolved) = &resolved {
        if are_first {
            resolved.refuse_unrecorded(study)?;
            resolved.warnings.say("runs to begin with");
        }
        // What fails, and what lacks a series, is made again once each time that the command is given.
        let tried_before = |run: &ResolvedRun| tried.contains(&run.identity);
        let is_pending = |number: &usize| {
            let run = &resolved.runs[number];
            match known.get(&run.identity) {
                None => true,
                Some(entry) => arguments.retry && !is_whole(entry, &run.needed) && !tried_before(run),
            }
        };
        pending = plan.order().filter(|number| !resolved.is_repeat(*number)).filter(is_pending).collect();
        if are_first {
            unkept::say(study, resolved, &known, arguments.retry);
        }
    }
    let is_complete = job.first_says(&[pending.len() as u64]).map_err(Failure::run)? == [0];
    let known = if is_complete {
        known
    } else {
        let runs = || resolved.iter().flat_map(|resolved| pending.iter().map(|number| &resolved.runs[number]));
        tried.extend(runs().map(|run| run.identity.clone()));
        let (jobs, workers) = (arguments.cores.runs_at_a_time(), arguments.cores.workers());
        let steps = runs().map(|run| run.steps).sum();
        if !pending.is_empty() {
            refuse_unwritable(plan.study())?;
        }
        let own = Interrupt::listen().map_err(Failure::run)?;
        let progress = Progress::new(pending.len(), steps, job.leads());
        let floor = Floor::new(plan, resolved.as_ref(), known, workers, own, progress);
        let shared = job.share(&pending, jobs, None, &|number| floor.make(number));
        if warns {
            floor.say_warnings();
        }
        floor.end(shared.map_err(Failure::run))?;
        // Every result is on the disk when all have come here.
        let own = Agreement { signal: interrupt.signal(), ..Agreement::default() };
        if let Some(signal) = job.agree(own).map_err(Failure::run)?.signal {
            let message = || format!("stopped by {}; the same command goes on", signal_in_words(signal));
            return Err(Failure::Stopped { signal, message: job.leads().then(message) });
        }
        if job.leads() { journal(plan.study())? } else { Journal::default() }
    };
    let Some(resolved) = resolved else { return Ok(None) };
    let folder = || journal_folder(plan.study());
    let collected = Collected::new(plan, &resolved.identities(), &known)
        .map_err(|error| Failure::run(format_args!("{}: {error}", folder().display())))?;
    Ok(Some((collected, resolved.files)))
}
