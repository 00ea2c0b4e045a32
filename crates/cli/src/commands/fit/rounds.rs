//! The runs of a fit: those of the study's design first, then further ones where they teach most.

use std::collections::BTreeSet;
use std::io::IsTerminal as _;
use std::path::PathBuf;

use plateau_io::study::collected::{Collected, CollectedRun};
use plateau_io::study::factor::{Factor, Level, Values};
use plateau_io::study::journal::{Entry, Journal};
use plateau_io::study::measured::Measured;
use plateau_io::study::plan::Plan;
use plateau_io::study::{DesignSource, Order, Study};
use plateau_present::study::place::shortened;
use plateau_run::Job;
use plateau_run::job::Agreement;
use plateau_study::design::Setting;
use plateau_study::effects::{EffectsError, Observation};
use plateau_study::fit::{Fit, FitError, Key, Measurement, ObservedSeries};
use plateau_study::surrogate::gaussian_process::GaussianProcessError;

use crate::arguments::FitArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::sweep::floor::Floor;
use crate::sweep::progress::Progress;
use crate::sweep::resolved::Resolved;
use crate::sweep::{journal, journal_folder};
use crate::{message, number};

/// Points that are added before the next fit: as many runs can be made at a time, each with all seeds.
const AT_A_TIME: usize = 4;

/// What is fitted: keys, and the responses that were measured.
pub struct Task {
    /// Keys, in SI units.
    pub keys: Vec<Key>,
    /// The responses that were measured, by their place in the study.
    pub responses: Vec<usize>,
    /// What was measured of each.
    pub measurements: Vec<Measurement>,
    /// The responses of which a whole series was measured, by their place in the study.
    pub series: Vec<usize>,
}

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

impl Task {
    /// What a study is to fit.
    ///
    /// # Errors
    /// [`Failure::Input`] when nothing was measured, or a factor has no range.
    pub fn of(study: &Study) -> Result<Self, Failure> {
        let at = study.path.display();
        let measured = study.fit.measured.iter().enumerate();
        let measured: Vec<(usize, Measured)> = measured.filter_map(|(at, of)| Some((at, (*of)?))).collect();
        let of_series = |at: &usize| study.responses[*at].measured_series().is_some();
        let series: Vec<usize> = (0..study.responses.len()).filter(of_series).collect();
        if measured.is_empty() && series.is_empty() {
            return Err(Failure::input(format_args!(
                "{at}: nothing was measured: give a [[response]] what was measured of it, such as measured = 0.70, \
                 uncertainty = 0.02, or measured_file = \"FILE.csv\" for a whole series"
            )));
        }
        if let Some((imported, _)) = measured.iter().find(|(at, _)| study.responses[*at].is_imported()) {
            let name = &study.responses[*imported].name;
            return Err(Failure::input(format_args!(
                "{at}: response \"{name}\" is imported; a fit compares what runs of a scene give with what was measured"
            )));
        }
        let key = |factor: &Factor| match &factor.values {
            Values::Range { low, high, logarithmic } => {
                let (low, high) = low.number.zip(high.number)?;
                Some(Key { name: factor.name.clone(), low, high, logarithmic: *logarithmic })
            }
            Values::Levels(_) => None,
        };
        let keys = study
            .factors
            .iter()
            .map(|factor| key(factor).ok_or_else(|| Failure::input(format_args!("{at}: {}", not_a_range(factor)))));
        Ok(Self {
            keys: keys.collect::<Result<_, _>>()?,
            responses: measured.iter().map(|(at, _)| *at).collect(),
            measurements: measured
                .iter()
                .map(|(_, of)| Measurement { value: of.value, uncertainty: of.uncertainty })
                .collect(),
            series,
        })
    }

    /// Refuses a series that goes on after the end of the runs.
    ///
    /// # Errors
    /// [`Failure::Input`].
    pub fn check_times(&self, plan: &Plan) -> Result<(), Failure> {
        let study = plan.study();
        let end = plan.scene(&plan.run(1)).map_err(Failure::input)?.duration;
        for file in self.series.iter().filter_map(|at| study.responses[*at].measured_series()) {
            if let Some(late) = file.series.times().last().filter(|last| **last > end * (1.0 + 1e-9)) {
                return Err(Failure::input(format_args!(
                    "{}:{}: the time is {late} s, and the runs end at {end} s: make them longer, with set = \
                     [\"operation.duration = '{late} s'\"], or leave out the lines after their end",
                    file.path.display(),
                    file.last_line
                )));
            }
        }
        Ok(())
    }

    /// Where a run has the keys.
    fn settings(&self, run: &CollectedRun) -> Vec<Setting> {
        self.keys.iter().zip(&run.run.levels).map(|(key, level)| setting(key, level)).collect()
    }

    /// The fit to what the runs gave.
    fn fit(&self, study: &Study, collected: &Collected) -> Result<Fit, Failure> {
        let observe = |response: usize| {
            let observation = |run: &CollectedRun| Observation {
                settings: self.settings(run),
                replicate: run.run.replicate,
                run: run.first,
                response: run.responses[response],
            };
            collected.runs.iter().map(observation).collect::<Vec<_>>()
        };
        let observations: Vec<Vec<Observation>> = self.responses.iter().map(|at| observe(*at)).collect();
        let of_series = |at: &usize| {
            let run = |run: &CollectedRun| ObservedSeries {
                settings: self.settings(run),
                replicate: run.run.replicate,
                run: run.first,
                values: run.at_measured_times[*at].clone(),
            };
            let file = study.responses[*at].measured_series()?;
            Some((file.series.clone(), collected.runs.iter().map(run).collect()))
        };
        let series: Vec<_> = self.series.iter().filter_map(of_series).collect();
        let unfinished = |response: usize, error: &dyn std::fmt::Display| {
            let name = &study.responses[response].name;
            Failure::run(format_args!(
                "response \"{name}\": {error}; {} of {} finished",
                collected.count("finished"),
                number::count(collected.runs.len(), "run")
            ))
        };
        let fit = Fit::with_series(&self.keys, &self.measurements, &observations, &series, study.fit.confidence);
        fit.map_err(|error| match &error {
            FitError::Response { index, error } => unfinished(self.responses[*index], error),
            FitError::Series { index, error: GaussianProcessError::Observations(EffectsError::Response { .. }) } => {
                let file = study.responses[self.series[*index]].measured_series().map(|file| file.path.display());
                let file = file.map_or_else(String::new, |file| format!(" in {file}"));
                Failure::input(format_args!(
                    "{}: response \"{}\": what was measured and what runs give differ by too many times the uncertainty for a number \
                     to hold; look at units, uncertainties and correlation time{file}",
                    study.path.display(),
                    study.responses[self.series[*index]].name
                ))
            }
            FitError::Series { index, error } => unfinished(self.series[*index], error),
            FitError::NoRun(index) => {
                unfinished(self.series[*index], &"no run has values at all of the measured times")
            }
            FitError::NoLikelihood => Failure::input(format_args!(
                "{}: {error}: {}; look at the units and the uncertainties",
                study.path.display(),
                self.far_off(study, collected)
            )),
            error => Failure::input(format_args!("{}: {error}", study.path.display())),
        })
    }

    /// What was measured beside what the runs gave, of the response of which the two are farthest from each other, or the uncertainty
    /// is most unlike what the runs differ by.
    fn far_off(&self, study: &Study, collected: &Collected) -> String {
        let of = |(at, measured): (&usize, &Measurement)| {
            let values = collected.runs.iter().map(|run| run.responses[*at]).filter(|value| value.is_finite());
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
            let distance = (low - measured.value).max(measured.value - high).max(0.0);
            let off = (distance / measured.uncertainty).max((high - low) / measured.uncertainty);
            let far = off.max(measured.uncertainty / (high - low));
            let unit = study.responses[*at].unit(plateau_io::study::collected::unit_of(&study.responses[*at].series));
            let number = |value: f64| with_unit(value, unit);
            let said = format!(
                "response \"{}\" was measured as {} ± {}, and runs give {} to {}",
                study.responses[*at].name,
                number(measured.value),
                number(measured.uncertainty),
                number(low),
                number(high)
            );
            (far, said)
        };
        let all = self.responses.iter().zip(&self.measurements).map(of);
        let series = || self.series.iter().map(|at| format!("response \"{}\"", study.responses[*at].name));
        let worst = all.max_by(|one, other| one.0.total_cmp(&other.0));
        worst.map_or_else(|| series().collect::<Vec<_>>().join(", "), |(_, said)| said)
    }
}

/// Why a factor with levels is not fitted, and what to do.
fn not_a_range(factor: &Factor) -> String {
    let (name, keys) = (&factor.name, factor.keys.join(", "));
    let said = format!("factor \"{name}\" ({keys}) has levels, and a fit looks for numbers between two ends");
    match &factor.values {
        Values::Levels(levels) if levels.iter().any(|level| level.number.is_none()) => {
            let levels: Vec<&str> = levels.iter().map(|level| level.text.as_str()).collect();
            let first = levels.first().copied().unwrap_or_default().replace('"', "'");
            format!(
                "{said}: these are words, {}. Make one study for each word, with set = [\"{}={first}\"] in place of this \
                 factor, fit each, and compare what they say of the misfit: the word with the least misfit fits best",
                levels.join(", "),
                factor.keys[0]
            )
        }
        _ if factor.is_whole() => {
            format!("{said}: this key holds whole numbers; make one study for each number, and compare the misfits")
        }
        _ => format!("{said}: give range = [lower, upper] in place of levels"),
    }
}

/// A number of at most four digits with its unit.
fn with_unit(value: f64, unit: &str) -> String {
    let value = number::rounded(value, 4);
    if ["", "1"].contains(&unit) { value } else { format!("{value} {unit}") }
}

fn setting(key: &Key, level: &Level) -> Setting {
    Setting::Coded(level.number.map_or(0.0, |value| key.coded(value)))
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
        let plan = Plan::new(Study { source, order: Order::Standard, ..study.clone() }).map_err(Failure::input)?;
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
        let label = level.map_or_else(|| number::short(value), |level| shortened(&level.label));
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
    let resolved = Resolved::of(plan)?;
    let warns = are_first && job.leads();
    if warns {
        resolved.warnings.say("runs to begin with");
    }
    // The first rank decides what is to be done: another one may see the journal a moment later.
    let known = if job.leads() { journal(plan.study())? } else { Journal::default() };
    let is_pending = |number: &usize| match known.get(&resolved.identities[number - 1]) {
        Some(Entry { failure: None, .. }) => false,
        // Once each time that the command is given.
        Some(_) => arguments.retry && !tried.contains(&resolved.identities[number - 1]),
        None => true,
    };
    let mut pending: Vec<usize> =
        plan.order().filter(|number| !resolved.is_repeat(number - 1)).filter(is_pending).collect();
    pending.retain(|_| job.leads());
    let is_complete = job.first_says(&[pending.len() as u64]).map_err(Failure::run)? == [0];
    let known = if is_complete {
        known
    } else {
        tried.extend(pending.iter().map(|number| resolved.identities[number - 1].clone()));
        let (jobs, workers) = (arguments.cores.runs_at_a_time(), arguments.cores.workers());
        let steps = pending.iter().map(|number| resolved.steps[number - 1]).sum();
        let own = Interrupt::listen().map_err(Failure::run)?;
        let floor = Floor::new(plan, &resolved, workers, own, Progress::new(pending.len(), steps, job.leads()));
        let shared = job.share(&pending, jobs, None, &|number| floor.make(number));
        if warns {
            floor.warn_of_surfaces();
        }
        floor.end(shared.map_err(Failure::run))?;
        // Every result is on the disk when all have come here.
        let own = Agreement { signal: interrupt.signal(), ..Agreement::default() };
        if let Some(signal) = job.agree(own).map_err(Failure::run)?.signal {
            let message = || format!("stopped by signal {signal}; the same command goes on");
            return Err(Failure::Stopped { signal, message: job.leads().then(message) });
        }
        if job.leads() { journal(plan.study())? } else { Journal::default() }
    };
    if !job.leads() {
        return Ok(None);
    }
    let folder = || journal_folder(plan.study());
    let collected = Collected::new(plan, &resolved.identities, &known)
        .map_err(|error| Failure::run(format_args!("{}: {error}", folder().display())))?;
    Ok(Some((collected, resolved.files)))
}
