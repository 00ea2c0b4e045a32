//! Writer of a run file while a simulation goes on: the calls of the simulation, the queues, and the thread that writes.

use std::path::Path;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossbeam::channel::{self, Receiver, Sender, TrySendError};
use plateau_core::acceleration::Chosen;
use plateau_core::model::mesh::Mesh;
use plateau_core::observe::event::EventRecord;
use plateau_core::observe::{Map, MapValues, Sample, Snapshot};

use super::store::{Store, WriterReport};
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
        // A queue with bounds would keep the questions in it when the thread has ended, and who asked would wait for ever.
        let (sync_sender, syncs) = channel::unbounded();
        let work = move || {
            // Nobody gives a file that could not be made.
            let mut store: Store = given.recv().map_err(|_| RunFileError::stopped())?;
            match append_until_closed(&mut store, &samples, &snapshots, &syncs) {
                Ok(()) => Ok(store),
                Err(error) => {
                    store.abandon();
                    Err(error)
                }
            }
        };
        let thread = thread::Builder::new().name("run file".into()).spawn(work);
        let thread = thread.map_err(|error| {
            let path = path.display();
            RunFileError::Failed(format!(
                "cannot write {path}: the system gives no more threads ({error}); allow more of them, as with ulimit -u 64, or in the \
                 container"
            ))
        })?;
        give.send(make()?).map_err(|_| RunFileError::stopped())?;
        Ok(Self {
            mesh: header.mesh.clone(),
            maps: header.maps.clone(),
            queues: Some(Queues { samples: sample_sender, snapshots: snapshot_sender, syncs: sync_sender }),
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

    /// Tells whether the writer still takes what is sent.
    pub fn check(&mut self) -> Result<(), RunFileError> {
        if self.thread.as_ref().is_some_and(|thread| !thread.is_finished()) { Ok(()) } else { Err(self.stop()) }
    }

    /// Asks for all that was sent so far to be handed to the disk.
    pub fn sync(&self) -> Synced {
        let (answer, answers) = channel::bounded(1);
        if let Some(queues) = &self.queues {
            // Nobody receives any more where the writer has failed.
            let _ = queues.syncs.send(answer);
        }
        Synced { answers }
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
        Ok(WriterReport { waited: self.waited, ..store.seal(end, events, acceleration)? })
    }

    /// Tells whether a snapshot holds the maps of the header on its mesh.
    fn check_maps(&self, snapshot: &Snapshot) -> Result<(), RunFileError> {
        for &map in &self.maps {
            let name = map.name();
            let values = snapshot.maps.iter().find(|(recorded, _)| *recorded == map).map(|(_, values)| values);
            let found = match values {
                Some(MapValues::Float(values)) if !map.is_status() => values.len(),
                Some(MapValues::Status(values)) if map.is_status() => values.len(),
                _ => {
                    return Err(RunFileError::Refused(format!(
                        "a snapshot lacks the map {name}, or has it as another type, though the run file was made for it"
                    )));
                }
            };
            let expected = if map.on_disc() { self.mesh.disc_cells() } else { self.mesh.pin_cells() };
            if found != expected {
                return Err(RunFileError::size(name, found, expected));
            }
        }
        Ok(())
    }

    /// Ends the thread and takes the store back.
    fn join(&mut self) -> Result<Store, RunFileError> {
        self.queues = None;
        let result = match self.thread.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            Some(Err(_)) => Err(RunFileError::stopped()),
            None => Err(self.failure.clone().unwrap_or_else(RunFileError::stopped)),
        };
        if let Err(error) = &result {
            self.failure = Some(error.clone());
        }
        result
    }

    /// The error with which the writer stopped taking anything.
    fn stop(&mut self) -> RunFileError {
        self.join().err().unwrap_or_else(RunFileError::stopped)
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

/// Queues from a simulation to the thread that writes.
#[derive(Debug)]
struct Queues {
    samples: Sender<Sample>,
    snapshots: Sender<Snapshot>,
    syncs: Sender<Sender<Vec<Image>>>,
}

/// Sends and adds to `waited` how long that took if the queue was full; false when nobody receives any more.
fn send<T>(queue: &Sender<T>, value: T, waited: &mut Duration) -> bool {
    match queue.try_send(value) {
        Ok(()) => true,
        Err(TrySendError::Disconnected(_)) => false,
        Err(TrySendError::Full(value)) => {
            let start = Instant::now();
            let sent = queue.send(value).is_ok();
            *waited += start.elapsed();
            sent
        }
    }
}

/// An answer that a writer owes: whether what was sent to it is on the disk.
#[derive(Debug)]
pub struct Synced {
    answers: Receiver<Vec<Image>>,
}

impl Synced {
    /// For a run file that is complete on the disk.
    pub fn already() -> Self {
        let (answer, answers) = channel::bounded(1);
        // There is room for it.
        let _ = answer.send(Vec::new());
        Self { answers }
    }

    /// Waits for the answer: the image of the file as it is on the disk, if it is there; none of a file that is closed.
    pub fn wait(&self) -> Option<Vec<Image>> {
        self.answers.recv().ok()
    }
}

/// Samples written at once, at most: 2 MB.
const BATCH: usize = 8 * 1024;
/// Time for which a sample waits for others before it is written.
const LATENCY: Duration = Duration::from_millis(500);
/// Time for which samples gather in the queue before they are taken out, at least.
const PAUSE: Duration = Duration::from_millis(2);

/// Body of the thread: appends what arrives until both queues are closed and empty.
fn append_until_closed(
    store: &mut Store,
    samples: &Receiver<Sample>,
    snapshots: &Receiver<Snapshot>,
    syncs: &Receiver<Sender<Vec<Image>>>,
) -> Result<(), RunFileError> {
    let mut batch: Vec<Sample> = Vec::new();
    let mut due = channel::never();
    loop {
        let mut is_due = false;
        crossbeam::select! {
            recv(samples) -> sample => {
                let Ok(sample) = sample else { break };
                if batch.is_empty() {
                    due = channel::after(LATENCY);
                }
                batch.push(sample);
                // Not to be woken by every sample of a run that sends many makes sending one cheap.
                thread::sleep(PAUSE);
                batch.extend(samples.try_iter().take(BATCH - batch.len()));
            }
            recv(snapshots) -> snapshot => {
                let Ok(snapshot) = snapshot else { break };
                store.append_snapshot(&snapshot)?;
            }
            recv(syncs) -> answer => {
                let Ok(answer) = answer else { break };
                batch.extend(samples.try_iter());
                snapshots.try_iter().try_for_each(|snapshot| store.append_snapshot(&snapshot))?;
                store.append_samples(&batch)?;
                batch.clear();
                due = channel::never();
                // Who asked may have given up.
                let _ = answer.send(store.sync()?.into_iter().collect());
            }
            recv(due) -> _ => is_due = true,
        }
        if is_due || batch.len() == BATCH {
            store.append_samples(&batch)?;
            batch.clear();
            due = channel::never();
        }
    }
    batch.extend(samples.try_iter());
    snapshots.try_iter().try_for_each(|snapshot| store.append_snapshot(&snapshot))?;
    if batch.is_empty() { Ok(()) } else { store.append_samples(&batch) }
}

#[cfg(test)]
#[path = "../../tests/unit/run_file/writer.rs"]
mod tests;
