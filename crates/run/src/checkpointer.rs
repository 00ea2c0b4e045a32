//! Writes the state of a run to its checkpoints, so that it can be gone on with after it was stopped or killed.

use std::io;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use plateau_core::observe::Sample;
use plateau_core::simulation::{Engine, SimulationError};
use plateau_io::run_file::Synced;
use plateau_io::run_file::checkpoint::{self, RunState};

use crate::assembly::Assembly;
use crate::options::Observer;

/// Identity of a run: only a run of which this is the same goes on from a checkpoint.
#[derive(Debug, Clone)]
pub struct RunIdentity {
    /// Name, version and revision of the program.
    pub program: String,
    /// Engine that takes its steps.
    pub engine: Engine,
    /// The whole resolved scene.
    pub scene: String,
    /// The surface files with their digests.
    pub inputs: Vec<(PathBuf, String)>,
}

/// Writes checkpoints beside a run file, one at a time, while the run goes on.
#[derive(Debug)]
pub struct Checkpointer {
    run_file: PathBuf,
    identity: RunIdentity,
    every: Duration,
    /// Time at which the last one was begun.
    last: Instant,
    start: Instant,
    /// Wall time of the run before this process.
    earlier: f64,
    /// The last sample of the run, in this process or before.
    pub last_sample: Option<Sample>,
    /// Samples and maps that were sent to the run file.
    sent: [usize; 2],
    writing: Option<JoinHandle<io::Result<()>>>,
}

impl Checkpointer {
    /// For a run that begins, or that goes on from a state.
    pub fn new(run_file: &Path, identity: RunIdentity, every: f64, earlier: Option<&RunState>) -> Self {
        let now = Instant::now();
        Self {
            run_file: run_file.to_owned(),
            identity,
            every: Duration::try_from_secs_f64(every).unwrap_or(Duration::MAX),
            last: now,
            start: now,
            earlier: earlier.map_or(0.0, |state| state.wall_time),
            last_sample: earlier.and_then(|state| state.last.clone()),
            sent: earlier.map_or([0, 0], |state| [state.samples, state.snapshots]),
            writing: None,
        }
    }

    /// A sample was sent to the run file.
    pub fn sampled(&mut self, sample: Sample) {
        self.sent[0] += 1;
        self.last_sample = Some(sample);
    }

    /// Maps were sent to the run file.
    pub fn mapped(&mut self) {
        self.sent[1] += 1;
    }

    /// Tells whether it is time for a checkpoint, and the one before is on the disk: no step waits for a slow one.
    pub fn is_due(&self) -> bool {
        self.last.elapsed() >= self.every && self.writing.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Takes the state of a run between two steps, and writes it as soon as what was sent to the run file is on the disk,
    /// which `synced` tells. All processes of a job must call this together; those that write nothing give no `synced`.
    pub fn write(
        &mut self,
        assembly: &mut Assembly,
        finished: bool,
        synced: Option<Synced>,
        observer: &mut dyn Observer,
    ) -> Result<(), SimulationError> {
        self.last = Instant::now();
        let simulation = assembly.checkpoint()?;
        let Some(synced) = synced else { return Ok(()) };
        let RunIdentity { program, scene, inputs, .. } = self.identity.clone();
        let mut state = RunState {
            program,
            scene,
            inputs,
            samples: self.sent[0],
            last: self.last_sample.clone(),
            snapshots: self.sent[1],
            wall_time: self.earlier + self.start.elapsed().as_secs_f64(),
            finished,
            simulation,
            images: Vec::new(),
        };
        self.wait(observer);
        let run_file = self.run_file.clone();
        let write = move || {
            // Without an answer the run file is not complete; its writer says why.
            let Some(images) = synced.wait() else { return Ok(()) };
            state.images = images;
            checkpoint::write(&run_file, &state)
        };
        let thread = std::thread::Builder::new().name("checkpoint".into()).spawn(write);
        self.writing = thread.map_err(|error| warn(observer, &error)).ok();
        Ok(())
    }

    /// Waits until the checkpoint that is being written is on the disk; says so if it cannot be.
    pub fn wait(&mut self, observer: &mut dyn Observer) {
        match self.writing.take().map(JoinHandle::join) {
            Some(Ok(Err(error))) => warn(observer, &error),
            Some(Err(_)) => warn(observer, &io::Error::other("its thread panicked")),
            Some(Ok(Ok(()))) | None => {}
        }
    }
}

impl Drop for Checkpointer {
    /// Nothing is written when the claim on the run file ends.
    fn drop(&mut self) {
        // Who has not waited has a worse error to tell.
        let _ = self.writing.take().map(JoinHandle::join);
    }
}

fn warn(observer: &mut dyn Observer, error: &io::Error) {
    observer.warning(&format_args!(
        "cannot write a checkpoint: {error}; the run file is not touched by that, the last checkpoint still holds"
    ));
}
