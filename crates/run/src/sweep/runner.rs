//! Runs of a study: which are to be made, made several at a time, and their results kept as they end.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use plateau_io::dataset_file::now;
use plateau_io::memory::AtWork;
use plateau_io::number;
use plateau_io::scene::{Origin, Problem};
use plateau_io::study::journal::{Journal, Shard};
use plateau_io::study::plan::Plan;
use plateau_io::study::record::{Digests, Identity, Outcome, Record};
use plateau_io::study::response::NoAnswer;
use plateau_io::study::{Study, StudyError};
use plateau_io::text::{self, shown_on_one_line};
use serde::Serialize;

use crate::error::Failure;
use crate::execution;
use crate::job::{Agreement, Job, PieceEnd};
use crate::options::SweepOptions;
use crate::sweep::earlier::{is_whole, journal, journal_folder, refuse_unwritable, say_left_out, say_unkept};
use crate::sweep::kept_file;
use crate::sweep::make::{Request, make};
use crate::sweep::resolved::{Resolved, file_of, needed, note_short_tenths};
use crate::sweep::shared_surfaces::SharedSurfaces;
use crate::sweep::under_way::{self, Ended, Others, UnderWay};
use crate::sweep::warnings::{SceneWarnings, SweepObserver, of_questions};

/// Files that are no part of a journal, of which the names are told.
const STRANGE: usize = 10;

/// Runs of a study that are to be made.
#[derive(Debug)]
pub struct Sweep<'a> {
    plan: &'a Plan,
    options: SweepOptions,
    /// Runs, resolved; none in a process that decides nothing.
    resolved: Option<Resolved>,
    journal: Journal,
    /// Summary, as far as it is known before runs are made.
    summary: SweepSummary,
    pending: Vec<usize>,
}

/// Result of a sweep: how many runs ended, when and where.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SweepSummary {
    /// Title of the study.
    pub study: String,
    /// Number of runs of the study.
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

impl SweepSummary {
    /// Fails where runs have failed, now or before.
    pub fn check(&self) -> Result<(), Failure> {
        match self.failed + self.failed_elsewhere + self.failed_before {
            0 => Ok(()),
            failed => Err(Failure::run(format_args!(
                "{failed} of {} failed; `plateau sweep collect` lists their errors, --retry makes them again",
                number::count(self.runs, "run")
            ))),
        }
    }
}

/// Reads a study and makes its design. Its results are in that `directory`, if one is given, in place of the one that it names.
pub fn load(path: &Path, directory: Option<&Path>) -> Result<Plan, StudyError> {
    let mut study = Study::load(path)?;
    if let Some(directory) = directory {
        if directory.exists() && !directory.is_dir() {
            let (origin, key, system) = (Origin::File(directory.into()), None, None);
            let message = "this is no folder, expected one for the results of the study".to_owned();
            return Err(StudyError(vec![Problem { origin, key, message, system }]));
        }
        (study.directory, study.is_elsewhere) = (directory.to_owned(), true);
    }
    Plan::new(study)
}

impl<'a> Sweep<'a> {
    /// Builds the scene of every run, and decides which runs are to be made: those of which the journal has no result. Of several
    /// processes of a job the first decides.
    ///
    /// # Errors
    /// A wrong input when scenes cannot be built, responses ask for series that no run records, or results could not be kept;
    /// a failed run when the journal cannot be read. Nothing was made then.
    pub fn prepare(
        plan: &'a Plan,
        options: SweepOptions,
        job: &Job,
        observer: &dyn SweepObserver,
    ) -> Result<Self, Failure> {
        let study = plan.study();
        let summary = SweepSummary {
            study: study.title.clone(),
            runs: plan.runs(),
            results: study.directory.display().to_string(),
            ..SweepSummary::default()
        };
        let mut sweep =
            Self { plan, options, resolved: None, journal: Journal::default(), summary, pending: Vec::new() };
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
        if sweep.options.keep_files {
            kept_file::renumber(study, &resolved);
        }
        let mut pending = Vec::new();
        for number in sweep.numbers() {
            // It has the result of the run that it repeats.
            if resolved.is_repeat(number) {
                sweep.summary.repeats += 1;
                continue;
            }
            let run = &resolved.runs[&number];
            let retry = sweep.options.retry;
            match journal.get(&run.identity) {
                Some(entry) if entry.failure.is_some() && !retry => sweep.summary.failed_before += 1,
                Some(entry)
                    if (is_whole(entry, &run.needed) || !retry)
                        && (!sweep.options.keep_files || kept_file::is_finished(&run.file)) =>
                {
                    sweep.summary.finished_before += 1;
                }
                _ => pending.push(number),
            }
        }
        if sweep.options.part.is_none() {
            say_left_out(study, &resolved, &journal, observer);
            kept_file::say_strange(study, &resolved, observer);
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

    /// Number of steps of all of them together.
    pub fn steps(&self) -> u64 {
        let steps = |resolved: &Resolved| self.pending.iter().map(|number| resolved.runs[number].steps).sum::<u64>();
        self.resolved.as_ref().map_or(0, steps)
    }

    /// Makes the runs, together with the other processes of the job if there are any. A run that fails ends by itself; a signal leaves
    /// the state of each run, and the rest to the next sweep.
    pub fn run(self, job: &mut Job, observer: &dyn SweepObserver) -> Result<SweepSummary, Failure> {
        let Self { plan, options, resolved, journal, summary, pending } = self;
        let jobs = options.jobs.min(pending.len().max(1));
        let start = Instant::now();
        let runner = Runner::new(plan, resolved.as_ref(), journal, &options, observer);
        let shared = job.share(&pending, jobs, options.most_failures, &|number| runner.make(number));
        let made = runner.end(shared.map_err(Failure::run))?;
        runner.say_warnings();
        let (finished, failed) = job.sum(made.finished, made.failed).map_err(Failure::run)?;
        let elsewhere = job.sum(made.finished_elsewhere, made.failed_elsewhere).map_err(Failure::run)?;
        let ended = finished + failed + elsewhere.0 + elsewhere.1;
        let wall_time = start.elapsed().as_secs_f64();
        let own = Agreement { signal: runner.signal(), ..Agreement::default() };
        let signal = job.agree(own).map_err(Failure::run)?.signal;
        Ok(SweepSummary {
            finished,
            failed,
            finished_elsewhere: elsewhere.0,
            failed_elsewhere: elsewhere.1,
            left: pending.len() - ended.min(pending.len()),
            wall_time,
            jobs: if job.ranks() > 1 { job.ranks() } else { jobs },
            signal,
            ..summary
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

/// Time between two looks at a run that another process makes.
const LOOK: Duration = Duration::from_millis(200);

/// State that the runs that are made at the same time share.
pub struct Runner<'a> {
    plan: &'a Plan,
    options: &'a SweepOptions,
    observer: &'a dyn SweepObserver,
    /// The runs, when it was decided which of them are to be made; none in a process that decides nothing.
    decided: Option<&'a Resolved>,
    /// Time at which runs ended that failed before, by their identities; as far as is known of a process that decides nothing, none did.
    failed_before: HashMap<String, String>,
    digests: Digests,
    /// Surfaces that runs have in common.
    surfaces: SharedSurfaces,
    /// All results, as far as they were seen.
    journal: Mutex<Journal>,
    /// Locks of other processes.
    others: Mutex<Others>,
    /// Runs that another process was making when they were looked at.
    waiting: Mutex<BTreeSet<usize>>,
    says_that_it_waits: AtomicBool,
    /// Shard of the journal, made with the first record.
    shard: Mutex<Option<Shard>>,
    /// Numbers of runs that were made, here and elsewhere.
    made: Mutex<SweepSummary>,
    /// Runs that read other files than were there when it was decided to make them.
    changed: Mutex<BTreeSet<usize>>,
    /// Warnings of the surfaces of the runs.
    warnings: Mutex<SceneWarnings>,
    /// Questions of the study that runs give no answer to.
    unanswered: Mutex<SceneWarnings>,
    /// Reason why no result can be kept any more.
    broken: Mutex<Option<Failure>>,
}

/// Lock of a mutex, also after a run has panicked: it is whole at any time.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<'a> Runner<'a> {
    /// Makes a runner for runs of a plan; `journal` has the results that are there.
    pub fn new(
        plan: &'a Plan,
        decided: Option<&'a Resolved>,
        journal: Journal,
        options: &'a SweepOptions,
        observer: &'a dyn SweepObserver,
    ) -> Self {
        let failed = journal.entries().filter(|(_, entry)| entry.failure.is_some());
        let failed_before = failed.map(|(identity, entry)| (identity.to_owned(), entry.last.clone())).collect();
        Self {
            plan,
            options,
            observer,
            decided,
            failed_before,
            digests: Digests::default(),
            surfaces: SharedSurfaces::default(),
            journal: Mutex::new(journal),
            others: Mutex::default(),
            waiting: Mutex::default(),
            says_that_it_waits: AtomicBool::default(),
            shard: Mutex::new(None),
            made: Mutex::default(),
            changed: Mutex::default(),
            warnings: Mutex::default(),
            unanswered: Mutex::default(),
            broken: Mutex::new(None),
        }
    }

    /// The signal that ended the runs, if there was one.
    pub fn signal(&self) -> Option<u8> {
        self.observer.asked_to_stop()
    }

    /// Says what the surfaces of the runs that were made can hardly be meant to be, and which questions they do not answer.
    pub fn say_warnings(&self) {
        for warnings in [&self.warnings, &self.unanswered] {
            lock(warnings).say("runs that were made now", self.observer);
        }
    }

    /// Completes the journal and counts what was made.
    pub fn end(&self, shared: Result<(), Failure>) -> Result<SweepSummary, Failure> {
        self.observer.ends();
        let shard = lock(&self.shard).take();
        let closed = shard.map_or(Ok(()), Shard::close);
        under_way::end(&self.plan.study().directory);
        shared?;
        if let Some(failure) = lock(&self.broken).take() {
            return Err(failure);
        }
        closed.map_err(|error| Failure::run(format!("cannot complete the journal: {error}")))?;
        let changed = lock(&self.changed);
        if !changed.is_empty() && self.signal().is_none() {
            return Err(Failure::run(format!(
                "{}: files that the runs read were changed meanwhile; {} read others than were there at the beginning, and count as what they read: \
                 {}; the same command makes what is missing with the files as they are now",
                self.plan.study().path.display(),
                number::count(changed.len(), "run"),
                text::list(changed.iter().map(ToString::to_string), ", ")
            )));
        }
        Ok(lock(&self.made).clone())
    }

    /// Makes a run and keeps its result, unless another process has done that or is about to.
    pub fn make(&self, number: usize) -> PieceEnd {
        if self.signal().is_some() {
            return PieceEnd::Stopped;
        }
        let _at_work = AtWork::begin();
        let study = self.plan.study();
        let found = self.plan.scene(&self.plan.run(number)).map_err(|error| error.to_string()).and_then(|scene| {
            let expected = Identity::expected(&scene, &self.digests);
            let cannot = |(path, error): (PathBuf, std::io::Error)| format!("cannot read {}: {error}", path.display());
            expected.map_err(cannot).map(|expected| (scene, expected))
        });
        let (scene, expected) = match found {
            Ok(found) => found,
            // It could be built a moment ago.
            Err(error) => {
                lock(&self.changed).insert(number);
                self.observer.warning(&format_args!("run {number} cannot be made any more: {error}"));
                return PieceEnd::Failed;
            }
        };
        let (identity, needed) = (expected.name(), needed(study, &scene));
        let file = self.options.keep_files.then(|| file_of(study, &expected, number, &scene));
        let ended_elsewhere = || self.ended_elsewhere(&identity, &needed, file.as_deref());
        if lock(&self.waiting).contains(&number) {
            thread::sleep(LOOK);
        }
        // Another process may have made it since the journal was read; what it is making now comes later.
        if let Some(end) = ended_elsewhere() {
            return end;
        }
        let Some(mut under_way) = UnderWay::take(&study.directory, &identity, &self.others, self.observer) else {
            if !lock(&self.waiting).insert(number) && !self.says_that_it_waits.swap(true, Ordering::Relaxed) {
                let words = "all other runs are made; waits for those that other processes are making, and makes those that they leave";
                self.observer.note(&words);
            }
            return PieceEnd::Later;
        };
        if let Err(error) = lock(&self.journal).read_on(&journal_folder(study)) {
            return self.break_off(format_args!("cannot read {}: {error}", journal_folder(study).display()));
        }
        if let Some(end) = ended_elsewhere() {
            under_way.forget();
            return end;
        }
        under_way.keep_every(scene.output.checkpoint_every);
        let start = Instant::now();
        let before = lock(&self.journal).get(&identity).map(|entry| entry.kept.clone()).unwrap_or_default();
        let request = Request {
            study,
            options: self.options,
            observer: self.observer,
            shared: &self.surfaces,
            warnings: &self.warnings,
            number,
            scene: &scene,
            expected: &expected,
            besides: &before,
        };
        let (outcome, made_of) = match make(&request, &mut under_way) {
            Ok(made) => made,
            Err(Ended::Unkept(error)) => {
                return self.break_off(format_args!("{error}; what was finished before is safe"));
            }
            Err(_) => return PieceEnd::Stopped,
        };
        let of = made_of.unwrap_or(expected);
        if let Some(series) = outcome.series() {
            let answers = study.responses.iter().map(|response| response.of(&series));
            // That a time is after the end is said before any run is made.
            let is_new = |(_, reason): &(usize, NoAnswer)| !matches!(reason, NoAnswer::Ended { .. });
            let unanswered = answers.enumerate().filter_map(|(place, answer)| Some((place, answer.err()?)));
            let unanswered: Vec<_> = unanswered.filter(is_new).collect();
            lock(&self.unanswered).add(of_questions(study, &unanswered));
        }
        let failure = if let Outcome::Failed { error } = &outcome { Some(error.clone()) } else { None };
        let record = Record {
            identity: of.name(),
            of,
            run: number,
            outcome,
            wall_time: start.elapsed().as_secs_f64(),
            host: execution::host(),
            end_time: now(),
        };
        if let Err(error) = self.keep(&record) {
            let folder = journal_folder(study);
            return self.break_off(format_args!(
                "cannot write to {}: {error}; what was finished before is safe",
                folder.display()
            ));
        }
        under_way.forget();
        let decided = self.decided.and_then(|resolved| resolved.runs.get(&number));
        if record.identity != *decided.map_or(&identity, |run| &run.identity) {
            lock(&self.changed).insert(number);
        }
        self.observer.run_ended(failure.is_some());
        match failure {
            None => {
                lock(&self.made).finished += 1;
                PieceEnd::Done
            }
            Some(error) => {
                lock(&self.made).failed += 1;
                self.observer.warning(&format_args!("run {number} failed: {error}"));
                PieceEnd::Failed
            }
        }
    }

    /// End of a run that another process has made since it was decided to make it.
    fn ended_elsewhere(&self, identity: &str, needed: &BTreeSet<String>, file: Option<&Path>) -> Option<PieceEnd> {
        let journal = lock(&self.journal);
        let entry = journal.get(identity)?;
        let is_new = || self.decided.is_some() && self.failed_before.get(identity) != Some(&entry.last);
        let has_failed = entry.failure.is_some() && is_new();
        let has_finished = is_whole(entry, needed) && file.is_none_or(kept_file::is_finished);
        if !has_finished && !has_failed {
            return None;
        }
        let mut made = lock(&self.made);
        *(if has_failed { &mut made.failed_elsewhere } else { &mut made.finished_elsewhere }) += 1;
        self.observer.run_ended(has_failed);
        Some(if has_failed { PieceEnd::Failed } else { PieceEnd::Done })
    }

    /// Ends all runs, for nothing can be kept any more.
    fn break_off(&self, why: std::fmt::Arguments<'_>) -> PieceEnd {
        *lock(&self.broken) = Some(Failure::run(why.to_string()));
        PieceEnd::Stopped
    }

    fn keep(&self, record: &Record) -> std::io::Result<()> {
        let mut shard = lock(&self.shard);
        if shard.is_none() {
            *shard = Some(Shard::create(&journal_folder(self.plan.study()), &execution::host())?);
        }
        shard.as_mut().map_or(Ok(()), |shard| shard.append(record))
    }
}
