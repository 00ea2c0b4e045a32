//! Where runs of a study are made, several at a time, and their results kept as they end.

use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use plateau_io::dataset_file::now;
use plateau_io::memory::AtWork;
use plateau_io::scene::Scene;
use plateau_io::study::journal::Shard;
use plateau_io::study::plan::Plan;
use plateau_io::study::record::{Outcome, Record};
use plateau_io::study::response::NoAnswer;
use plateau_io::surface::Loaded;
use plateau_run::job::PieceEnd;

use super::journal_folder;
use super::make::make;
use super::progress::Progress;
use super::resolved::Resolved;
use super::scene_warnings::{SceneWarnings, of_questions, of_surfaces};
use super::under_way::UnderWay;
use super::watcher::{Stopped, Watcher};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::{machine, message};

/// What the runs that are made at the same time share.
pub struct Floor<'a> {
    plan: &'a Plan,
    resolved: &'a Resolved,
    workers: usize,
    interrupt: Interrupt,
    progress: Progress,
    /// Made with the first record.
    shard: Mutex<Option<Shard>>,
    finished: AtomicUsize,
    failed: AtomicUsize,
    /// What the surfaces of the runs can hardly be meant to be.
    warnings: Mutex<SceneWarnings>,
    /// Questions of the study that runs give no answer to.
    unanswered: Mutex<SceneWarnings>,
    /// Why no result can be kept any more.
    broken: Mutex<Option<Failure>>,
}

/// How many runs were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Made {
    pub finished: usize,
    pub failed: usize,
}

impl Watcher for Floor<'_> {
    fn steps(&self, count: u64) -> Option<u8> {
        self.progress.steps(count);
        self.interrupt.signal()
    }

    fn surfaces(&self, scene: &Scene, loaded: &Loaded) {
        self.warnings.lock().unwrap_or_else(PoisonError::into_inner).add(of_surfaces(scene, loaded));
    }

    fn goes_on(&self, steps: u64) {
        self.progress.steps(steps);
        self.progress.say(|| message::note(format_args!("a run that was stopped goes on from step {steps}")));
    }
}

impl<'a> Floor<'a> {
    /// For runs of a plan, each with so many workers.
    pub fn new(
        plan: &'a Plan,
        resolved: &'a Resolved,
        workers: usize,
        interrupt: Interrupt,
        progress: Progress,
    ) -> Self {
        Self {
            plan,
            resolved,
            workers,
            interrupt,
            progress,
            shard: Mutex::new(None),
            finished: AtomicUsize::new(0),
            failed: AtomicUsize::new(0),
            warnings: Mutex::default(),
            unanswered: Mutex::default(),
            broken: Mutex::new(None),
        }
    }

    /// The signal that ended the runs, if there was one.
    pub fn signal(&self) -> Option<u8> {
        self.interrupt.signal()
    }

    /// Says what the surfaces of the runs that were made can hardly be meant to be, and which questions they do not answer.
    pub fn say_warnings(&self) {
        for warnings in [&self.warnings, &self.unanswered] {
            warnings.lock().unwrap_or_else(PoisonError::into_inner).say("runs that were made now");
        }
    }

    /// Completes the journal and counts what was made.
    ///
    /// # Errors
    /// How the runs were shared, if that failed; [`Failure::Run`] when results could not be kept.
    pub fn end(&self, shared: Result<(), Failure>) -> Result<Made, Failure> {
        self.progress.finish();
        let shard = self.shard.lock().unwrap_or_else(PoisonError::into_inner).take();
        let closed = shard.map_or(Ok(()), Shard::close);
        shared?;
        if let Some(failure) = self.broken.lock().unwrap_or_else(PoisonError::into_inner).take() {
            return Err(failure);
        }
        closed.map_err(|error| Failure::run(format_args!("cannot complete the journal: {error}")))?;
        let [finished, failed] = [&self.finished, &self.failed].map(|count| count.load(Ordering::Relaxed));
        Ok(Made { finished, failed })
    }

    /// Makes a run and keeps its result.
    pub fn make(&self, number: usize) -> PieceEnd {
        if self.interrupt.signal().is_some() {
            return PieceEnd::Stopped;
        }
        let _at_work = AtWork::begin();
        let start = Instant::now();
        let run = self.plan.run(number);
        let (study, identity) = (self.plan.study(), &self.resolved.identities[number - 1]);
        let mut under_way = UnderWay::new(&study.directory, identity);
        let outcome = match self.plan.scene(&run) {
            Ok(scene) => {
                under_way.keep_every(scene.output.checkpoint_every);
                make(study, &scene, self.workers, self, &mut under_way)
            }
            // It could be built a moment ago.
            Err(error) => Ok(Outcome::Failed { error: error.to_string() }),
        };
        let Ok(outcome) = outcome.map_err(|Stopped(_)| ()) else { return PieceEnd::Stopped };
        if let Some(series) = outcome.series() {
            let answers = study.responses.iter().map(|response| response.of(&series));
            // That a time is after the end is said before any run is made.
            let is_new = |(_, reason): &(usize, NoAnswer)| !matches!(reason, NoAnswer::Ended { .. });
            let unanswered = answers.enumerate().filter_map(|(place, answer)| Some((place, answer.err()?)));
            let unanswered: Vec<_> = unanswered.filter(is_new).collect();
            self.unanswered.lock().unwrap_or_else(PoisonError::into_inner).add(of_questions(study, &unanswered));
        }
        let failure = if let Outcome::Failed { error } = &outcome { Some(error.clone()) } else { None };
        let record = Record {
            identity: identity.clone(),
            run: number,
            outcome,
            wall_time: start.elapsed().as_secs_f64(),
            host: machine::host(),
            end_time: now(),
        };
        if let Err(error) = self.keep(&record) {
            let folder = journal_folder(self.plan.study());
            let message = format!("cannot write to {}: {error}; what was finished before is safe", folder.display());
            *self.broken.lock().unwrap_or_else(PoisonError::into_inner) = Some(Failure::run(message));
            return PieceEnd::Stopped;
        }
        under_way.forget();
        self.progress.ended(failure.is_some());
        match failure {
            None => {
                self.finished.fetch_add(1, Ordering::Relaxed);
                PieceEnd::Done
            }
            Some(error) => {
                self.failed.fetch_add(1, Ordering::Relaxed);
                self.progress.say(|| message::warning(format_args!("run {number} failed: {error}")));
                PieceEnd::Failed
            }
        }
    }

    fn keep(&self, record: &Record) -> std::io::Result<()> {
        let mut shard = self.shard.lock().unwrap_or_else(PoisonError::into_inner);
        if shard.is_none() {
            *shard = Some(Shard::create(&journal_folder(self.plan.study()), &machine::host())?);
        }
        shard.as_mut().map_or(Ok(()), |shard| shard.append(record))
    }
}
