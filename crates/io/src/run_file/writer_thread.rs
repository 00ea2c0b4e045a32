//! The thread that writes a run file: it appends what arrives in its queues.

use std::thread;
use std::time::Duration;

use crossbeam::channel::{self, Receiver, Sender};
use plateau_core::observe::{Sample, Snapshot};

use super::store::Store;
use super::{Image, RunFileError};

/// Samples written at once, at most: 2 MB.
const BATCH: usize = 8 * 1024;
/// How long a sample waits for others before it is written.
const LATENCY: Duration = Duration::from_millis(500);
/// How long samples gather in the queue before they are taken out, at least.
const PAUSE: Duration = Duration::from_millis(2);

/// Body of the thread: appends what arrives until both queues are closed and empty.
pub(super) fn write(
    mut store: Store,
    samples: &Receiver<Sample>,
    snapshots: &Receiver<Snapshot>,
    syncs: &Receiver<Sender<Vec<Image>>>,
) -> Result<Store, RunFileError> {
    match append_all(&mut store, samples, snapshots, syncs) {
        Ok(()) => Ok(store),
        Err(error) => {
            store.abandon();
            Err(error)
        }
    }
}

fn append_all(
    store: &mut Store,
    samples: &Receiver<Sample>,
    snapshots: &Receiver<Snapshot>,
    syncs: &Receiver<Sender<Vec<Image>>>,
) -> Result<(), RunFileError> {
    let mut batch: Vec<Sample> = Vec::new();
    let mut due = channel::never();
    loop {
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
                for snapshot in snapshots.try_iter() {
                    store.append_snapshot(&snapshot)?;
                }
                store.append_samples(&batch)?;
                batch.clear();
                due = channel::never();
                // Who asked may have given up.
                let _ = answer.send(store.sync()?.into_iter().collect());
            }
            recv(due) -> _ => {
                store.append_samples(&batch)?;
                batch.clear();
                due = channel::never();
            }
        }
        if batch.len() == BATCH {
            store.append_samples(&batch)?;
            batch.clear();
            due = channel::never();
        }
    }
    batch.extend(samples.try_iter());
    for snapshot in snapshots.try_iter() {
        store.append_snapshot(&snapshot)?;
    }
    if batch.is_empty() { Ok(()) } else { store.append_samples(&batch) }
}
