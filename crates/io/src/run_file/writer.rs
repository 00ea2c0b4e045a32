//! Writes a run file while a simulation goes on: what a simulation calls.

use std::path::Path;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crossbeam::channel::{self, Sender};
use plateau_core::acceleration::Chosen;
use plateau_core::model::mesh::Mesh;
use plateau_core::observe::event::EventRecord;
use plateau_core::observe::{Map, MapValues, Sample, Snapshot};

use super::store::Store;
use super::writer_queue::{Queues, Synced, send};
use super::writer_thread::write;
use super::{Earlier, End, Header, Image, RunFileError};

/// Samples in the queue, at most: 3 MB, as many as come while a batch is written.
const QUEUED_SAMPLES: usize = 16 * 1024;
/// Snapshots in the queue, at most; with the one that is being written two are under way.
const QUEUED_SNAPSHOTS: usize = 1;

/// Writes a run file from a thread of its own. Who makes one holds the [`Claim`](crate::claim::Claim) of its path, and of the
/// checkpoints beside it, until both are complete.
///
/// A writer that is dropped without [`finish`](Self::finish) leaves a file whose state is `failed`.
#[derive(Debug)]
pub struct RunWriter {
    mesh: Mesh,
    maps: Vec<Map>,
    queues: Option<Queues>,
    thread: Option<JoinHandle<Result<Store, RunFileError>>>,
    failure: Option<RunFileError>,
    waited: Duration,
}

/// What a finished run file holds and what writing it cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriterReport {
    /// How long the simulation waited for the queue, in all.
    pub waited: Duration,
    /// Samples in the file.
    pub samples: usize,
    /// Moments of which there are maps in the file.
    pub snapshots: usize,
    /// Size of the file.
    pub bytes: u64,
}

impl RunWriter {
    /// Makes the run file at `path` and starts its writer.
    ///
    /// The file appears under its name only once it is set up, with `state` = `running`, and readers can follow it from
    /// then on. An existing file is replaced only with `overwrite`, and only by that complete new file.
    ///
    /// # Errors
    /// [`RunFileError`] when the path cannot be written, when something is there already, or when the header does not
    /// fit its mesh. Nothing is left behind.
    pub fn create(path: &Path, overwrite: bool, header: &Header) -> Result<Self, RunFileError> {
        Self::start(path, header, || Store::create(path, overwrite, header))
    }

    /// Starts the thread before the file is made: where there is none, nothing is touched.
    fn start(
        path: &Path,
        header: &Header,
        make: impl FnOnce() -> Result<Store, RunFileError>,
    ) -> Result<Self, RunFileError> {
        let (give, given) = channel::bounded(1);
        let (sample_sender, samples) = channel::bounded(QUEUED_SAMPLES);
        let (snapshot_sender, snapshots) = channel::bounded(QUEUED_SNAPSHOTS);
        let (sync_sender, syncs) = channel::bounded(1);
        let (life, alive) = channel::bounded(0);
        let work = move || {
            let _life: Sender<()> = life;
            // Nobody gives a file that could not be made.
            write(given.recv().map_err(|_| RunFileError::Stopped)?, &samples, &snapshots, &syncs)
        };
        let thread = thread::Builder::new().name("run file".into()).spawn(work);
        let thread = thread.map_err(|error| RunFileError::NoThread { path: path.into(), reason: error.to_string() })?;
        give.send(make()?).map_err(|_| RunFileError::Stopped)?;
        Ok(Self {
            mesh: header.mesh.clone(),
            maps: header.maps.clone(),
            queues: Some(Queues { samples: sample_sender, snapshots: snapshot_sender, syncs: sync_sender, alive }),
            thread: Some(thread),
            failure: None,
            waited: Duration::ZERO,
        })
    }

    /// Goes on with the run file at `path`, of a run that was stopped: what is in it beyond `earlier` is done once more.
    ///
    /// A file that was not closed is taken as it was when one of the images was taken, if one is of it. The file that takes its
    /// place has another image: `keep` is given that before it does, to be kept in a checkpoint.
    ///
    /// # Errors
    /// [`RunFileError`] when the file cannot be read, holds less than that, or cannot be written anew; it is then as it was.
    pub fn resume(
        path: &Path,
        header: &Header,
        earlier: Earlier,
        images: &[Image],
        keep: impl FnOnce(Image),
    ) -> Result<Self, RunFileError> {
        Self::start(path, header, || Store::resume(path, header, earlier, images, keep))
    }

    /// Whether the writer still takes what is sent.
    ///
    /// # Errors
    /// The error with which it has ended.
    pub fn check(&mut self) -> Result<(), RunFileError> {
        if self.thread.as_ref().is_some_and(|thread| !thread.is_finished()) { Ok(()) } else { Err(self.stop()) }
    }

    /// Asks for all that was sent so far to be handed to the disk.
    pub fn sync(&self) -> Synced {
        let (answer, answers) = channel::bounded(1);
        let alive = self.queues.as_ref().map_or_else(|| channel::bounded(0).1, |queues| queues.alive.clone());
        if let Some(queues) = &self.queues {
            // Nobody receives any more where the writer has failed.
            let _ = queues.syncs.send(answer);
        }
        Synced::new(answers, alive)
    }

    /// Sends a sample; readers see it within a second. Waits only when the queue is full.
    ///
    /// # Errors
    /// The error of the writer once it has failed; no more is written then.
    pub fn sample(&mut self, sample: Sample) -> Result<(), RunFileError> {
        let sent = self.queues.as_ref().is_some_and(|queues| send(&queues.samples, sample, &mut self.waited));
        if sent { Ok(()) } else { Err(self.stop()) }
    }

    /// Sends maps. Waits only when the queue is full.
    ///
    /// # Errors
    /// [`RunFileError::Map`] or [`RunFileError::Size`] when they are not the maps of the header on its mesh; otherwise
    /// as [`sample`](Self::sample).
    pub fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), RunFileError> {
        self.check_maps(&snapshot)?;
        let sent = self.queues.as_ref().is_some_and(|queues| send(&queues.snapshots, snapshot, &mut self.waited));
        if sent { Ok(()) } else { Err(self.stop()) }
    }

    /// Writes what is still in the queue, states how the run ended, what happened in the events of its cycle and what the
    /// acceleration that it chose was like, and closes the file.
    ///
    /// # Errors
    /// The error of the writer if it has failed, now or before; `state` then still is `running`, as if the program had
    /// been killed.
    pub fn finish(
        mut self,
        end: &End,
        events: &[EventRecord],
        acceleration: Option<Chosen>,
    ) -> Result<WriterReport, RunFileError> {
        let store = self.join()?;
        let written = store.seal(end, events, acceleration)?;
        Ok(WriterReport {
            waited: self.waited,
            samples: written.samples,
            snapshots: written.snapshots,
            bytes: written.bytes,
        })
    }

    /// Whether a snapshot holds the maps of the header on its mesh.
    fn check_maps(&self, snapshot: &Snapshot) -> Result<(), RunFileError> {
        for &map in &self.maps {
            let name = map.name();
            let values = snapshot.maps.iter().find(|(recorded, _)| *recorded == map).map(|(_, values)| values);
            let found = match values {
                Some(MapValues::Float(values)) if !map.is_status() => values.len(),
                Some(MapValues::Status(values)) if map.is_status() => values.len(),
                _ => return Err(RunFileError::Map { name }),
            };
            let expected = if map.on_disc() { self.mesh.disc_cells() } else { self.mesh.pin_cells() };
            if found != expected {
                return Err(RunFileError::Size { name, found, expected });
            }
        }
        Ok(())
    }

    /// Ends the thread and takes the store back.
    fn join(&mut self) -> Result<Store, RunFileError> {
        self.queues = None;
        let result = match self.thread.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            Some(Err(_)) => Err(RunFileError::Stopped),
            None => Err(self.failure.clone().unwrap_or(RunFileError::Stopped)),
        };
        if let Err(error) = &result {
            self.failure = Some(error.clone());
        }
        result
    }

    /// The error with which the writer stopped taking anything.
    fn stop(&mut self) -> RunFileError {
        self.join().err().unwrap_or(RunFileError::Stopped)
    }
}

impl Drop for RunWriter {
    fn drop(&mut self) {
        if self.thread.is_some()
            && let Ok(store) = self.join()
        {
            let _ = store.seal(&End::Failed("the program stopped before the run was done".into()), &[], None);
        }
    }
}
