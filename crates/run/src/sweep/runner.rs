//! Runs of a study made several at a time, and their results kept as they end.

use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use plateau_io::dataset_file::now;
use plateau_io::memory::AtWork;
use plateau_io::scene::Scene;
use plateau_io::study::journal::{Journal, Shard};
use plateau_io::study::plan::Plan;
use plateau_io::study::record::{Digests, Identity, Outcome, Record};
use plateau_io::study::response::NoAnswer;
use plateau_io::surface::Loaded;
use plateau_io::{number, text};

use super::earlier::{is_whole, journal_folder};
use super::error::SweepError;
use super::make::{MadeRun, Request, Watcher, make};
use super::observer::SweepObserver;
use super::resolved::{Resolved, needed};
use super::under_way::{self, Others, UnderWay};
use super::warnings::{SceneWarnings, of_questions, of_surfaces};
use crate::execution;
use crate::job::PieceEnd;

/// Time between two looks at a run that another process makes.
const LOOK: Duration = Duration::from_millis(200);

/// State that the runs that are made at the same time share.
pub struct Runner<'a> {
    plan: &'a Plan,
    workers: usize,
    program: String,
    observer: &'a dyn SweepObserver,
    /// The runs, when it was decided which of them are to be made; none in a process that decides nothing.
    decided: Option<&'a Resolved>,
    /// Time at which runs ended that failed before, by their identities; as far as is known of a process that decides nothing, none did.
    failed_before: HashMap<String, String>,
    digests: Digests,
    /// All results, as far as they were seen.
    journal: Mutex<Journal>,
    /// Locks of other processes.
    others: Mutex<Others>,
    /// Runs that another process was making when they were looked at.
    waiting: Mutex<BTreeSet<usize>>,
    says_that_it_waits: AtomicBool,
    /// Made with the first record.
    shard: Mutex<Option<Shard>>,
    made: Mutex<Made>,
    /// Runs that read other files than were there when it was decided to make them.
    changed: Mutex<BTreeSet<usize>>,
    /// Warnings of the surfaces of the runs.
    warnings: Mutex<SceneWarnings>,
    /// Questions of the study that runs give no answer to.
    unanswered: Mutex<SceneWarnings>,
    /// Reason why no result can be kept any more.
    broken: Mutex<Option<SweepError>>,
}

/// Numbers of runs that were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Made {
    /// Finished here.
    pub finished: usize,
    /// Failed here.
    pub failed: usize,
    /// Finished meanwhile in other processes.
    pub finished_elsewhere: usize,
    /// Failed meanwhile in other processes.
    pub failed_elsewhere: usize,
}

/// Lock of a mutex, also after a run has panicked: it is whole at any time.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Watcher for Runner<'_> {
    fn steps(&self, count: u64) -> bool {
        self.observer.steps(count);
        self.observer.asked_to_stop().is_some()
    }

    fn surfaces(&self, scene: &Scene, loaded: &Loaded) {
        lock(&self.warnings).add(of_surfaces(scene, loaded));
    }

    fn goes_on(&self, steps: u64) {
        self.observer.steps(steps);
        self.observer.note(&format_args!("a run that was stopped goes on from step {steps}"));
    }
}

impl<'a> Runner<'a> {
    /// For runs of a plan, each with so many workers; `journal` has the results that are there.
    pub fn new(
        plan: &'a Plan,
        decided: Option<&'a Resolved>,
        journal: Journal,
        workers: usize,
        program: String,
        observer: &'a dyn SweepObserver,
    ) -> Self {
        let failed = journal.entries().filter(|(_, entry)| entry.failure.is_some());
        let failed_before = failed.map(|(identity, entry)| (identity.to_owned(), entry.last.clone())).collect();
        Self {
            plan,
            workers,
            program,
            observer,
            decided,
            failed_before,
            digests: Digests::default(),
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
    pub fn end(&self, shared: Result<(), SweepError>) -> Result<Made, SweepError> {
        self.observer.ends();
        let shard = lock(&self.shard).take();
        let closed = shard.map_or(Ok(()), Shard::close);
        under_way::end(&self.plan.study().directory);
        shared?;
        if let Some(failure) = lock(&self.broken).take() {
            return Err(failure);
        }
        closed.map_err(|error| SweepError::Failed(format!("cannot complete the journal: {error}")))?;
        let changed = lock(&self.changed);
        if !changed.is_empty() && self.signal().is_none() {
            return Err(SweepError::Failed(format!(
                "{}: files that the runs read were changed meanwhile; {} read others than were there at the beginning, and count as what they read: \
                 {}; the same command makes what is missing with the files as they are now",
                self.plan.study().path.display(),
                number::count(changed.len(), "run"),
                text::list(changed.iter().map(ToString::to_string), ", ")
            )));
        }
        Ok(*lock(&self.made))
    }

    /// Makes a run and keeps its result, unless another process has done that or is about to.
    pub fn make(&self, number: usize) -> PieceEnd {
        if self.observer.asked_to_stop().is_some() {
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
        if lock(&self.waiting).contains(&number) {
            thread::sleep(LOOK);
        }
        // Another process may have made it since the journal was read; what it is making now comes later.
        if let Some(end) = self.ended_elsewhere(&identity, &needed) {
            return end;
        }
        let Ok(mut under_way) = UnderWay::take(&study.directory, &identity, &self.others, self.observer) else {
            if !lock(&self.waiting).insert(number) && !self.says_that_it_waits.swap(true, Ordering::Relaxed) {
                let words = "all other runs are made; waits for those that other processes are making, and makes those that they leave";
                self.observer.note(&words);
            }
            return PieceEnd::Later;
        };
        if let Err(error) = lock(&self.journal).read_on(&journal_folder(study)) {
            return self.break_off(format_args!("cannot read {}: {error}", journal_folder(study).display()));
        }
        if let Some(end) = self.ended_elsewhere(&identity, &needed) {
            under_way.forget();
            return end;
        }
        under_way.keep_every(scene.output.checkpoint_every);
        let start = Instant::now();
        let before = lock(&self.journal).get(&identity).map(|entry| entry.kept.clone()).unwrap_or_default();
        let request = Request {
            study,
            scene: &scene,
            expected: &expected,
            besides: &before,
            workers: self.workers,
            program: self.program.clone(),
        };
        let Ok(MadeRun { outcome, of }) = make(&request, self, &mut under_way) else { return PieceEnd::Stopped };
        let of = of.unwrap_or(expected);
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
        let expected = self.decided.and_then(|resolved| resolved.runs.get(&number));
        if record.identity != *expected.map_or(&identity, |run| &run.identity) {
            lock(&self.changed).insert(number);
        }
        let mut made = lock(&self.made);
        match failure {
            None => made.finished += 1,
            Some(_) => made.failed += 1,
        }
        drop(made);
        self.observer.run_ended(failure.is_some());
        match failure {
            None => PieceEnd::Done,
            Some(error) => {
                self.observer.warning(&format_args!("run {number} failed: {error}"));
                PieceEnd::Failed
            }
        }
    }

    /// End of a run that another process has made since it was decided to make it.
    fn ended_elsewhere(&self, identity: &str, needed: &BTreeSet<String>) -> Option<PieceEnd> {
        let journal = lock(&self.journal);
        let entry = journal.get(identity)?;
        let is_new = || self.decided.is_some() && self.failed_before.get(identity) != Some(&entry.last);
        let has_failed = entry.failure.is_some() && is_new();
        if !is_whole(entry, needed) && !has_failed {
            return None;
        }
        let mut made = lock(&self.made);
        *(if has_failed { &mut made.failed_elsewhere } else { &mut made.finished_elsewhere }) += 1;
        self.observer.run_ended(has_failed);
        Some(if has_failed { PieceEnd::Failed } else { PieceEnd::Done })
    }

    /// Ends all runs, for nothing can be kept any more.
    fn break_off(&self, why: std::fmt::Arguments<'_>) -> PieceEnd {
        *lock(&self.broken) = Some(SweepError::Failed(why.to_string()));
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
