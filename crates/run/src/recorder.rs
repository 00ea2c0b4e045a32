//! Recorder of a run: the header of its run file, the way of its samples and maps, what may end it, and warnings of the stiffness that it
//! comes to; and its state in checkpoints, so that it can be gone on with after it was stopped or killed.

use std::io;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use plateau_core::acceleration::scout::Idle;
use plateau_core::model::parameters::{Integrator, Parameters};
use plateau_core::observe::{Sample, Snapshot};
use plateau_core::simulation::{Engine, Simulation, SimulationError};
use plateau_io::number;
use plateau_io::plausibility::Recorded;
use plateau_io::run_file::checkpoint::{self, RunState};
use plateau_io::run_file::{Header, InputFile, RunWriter, Synced};
use plateau_io::scene::Scene;

use crate::assembly::{Assembly, Sink};
use crate::error::RunFailure;
use crate::execution;
use crate::job::{Agreement, Job};
use crate::options::{Observer, Program};

/// The part of the run file that is known before the first step. `surface_files` are those that were read, with their digests;
/// `surfaces` says what was done for the surfaces.
pub fn header(
    scene: &Scene,
    assembly: &Assembly,
    program: &Program,
    surface_files: &[(PathBuf, String)],
    surfaces: Vec<String>,
) -> Header {
    let execution = assembly.simulation.execution();
    Header {
        title: scene.title.clone(),
        mesh: scene.parameters.mesh.clone(),
        pin_base: assembly.simulation.pin_base().to_vec(),
        maps: scene.output.maps.clone(),
        extras: scene.extras(assembly.chooses_acceleration()),
        expected_samples: assembly.schedule.samples(),
        scene: scene.resolved.clone(),
        program: program.name.clone(),
        source_revision: program.revision.clone(),
        host: execution::host(),
        workers: execution.workers,
        decomposition: assembly.simulation.decomposition(),
        instruction_set: execution.means().into(),
        seeds: scene.seeds.clone(),
        inputs: input_files(scene, surface_files),
        surfaces,
    }
}

/// Every file that a scene read, with the digest of what was read; those of surfaces are `surface_files`.
pub fn input_files(scene: &Scene, surface_files: &[(PathBuf, String)]) -> Vec<InputFile> {
    let read = scene.files.iter().chain(surface_files);
    read.map(|(path, sha256)| InputFile { path: path.to_string_lossy().into_owned(), sha256: sha256.clone() }).collect()
}

/// Reason why a run that had started did not end.
#[derive(Debug)]
pub enum Interruption {
    /// Run that failed.
    Failed(RunFailure),
    /// Signal that asked the run to stop.
    Stopped(u8),
}

impl<Error: Into<RunFailure>> From<Error> for Interruption {
    fn from(error: Error) -> Self {
        Self::Failed(error.into())
    }
}

/// Hands what a simulation reports to the writer and to the observer, and does what that asks for.
pub struct Recorder<'a> {
    /// Writer of the run file; none in a process that does not lead.
    pub writer: Option<RunWriter>,
    pub observer: &'a dyn Observer,
    pub job: &'a mut Job,
    pub checkpointer: Checkpointer,
    /// Last agreement of all processes.
    pub agreement: Agreement,
    /// Warnings of the samples so far of the scene.
    pub recorded: Recorded,
    /// Tells whether it is said that the stiffness number is too large for the wear rule.
    pub is_stiff: bool,
}

impl Sink for Recorder<'_> {
    type Error = Interruption;

    fn sample(&mut self, sample: Sample) -> Result<(), Interruption> {
        self.recorded.add(&sample);
        self.checkpointer.sampled(sample.clone());
        self.observer.sample(&sample);
        Ok(self.writer.as_mut().map_or(Ok(()), |writer| writer.sample(sample))?)
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), Interruption> {
        self.checkpointer.mapped();
        Ok(self.writer.as_mut().map_or(Ok(()), |writer| writer.snapshot(snapshot))?)
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, Interruption> {
        self.observer.progress(simulation);
        let stiffness_number = simulation.course().largest_stiffness_number;
        if !self.is_stiff && is_stiff(simulation.parameters(), stiffness_number) {
            self.is_stiff = true;
            let time = number::rounded(simulation.time(), 4);
            let what = format!("with the wear rates of the temperature after {time} s the stiffness number is");
            self.observer.warning(&in_words(&what, stiffness_number));
        }
        // Samples may be rare: the run is not to go on for hours beside a file that is lost.
        self.writer.as_mut().map_or(Ok(()), RunWriter::check)?;
        let save = self.observer.asked_to_save() || (self.writer.is_some() && self.checkpointer.is_due());
        let own = Agreement { signal: self.observer.asked_to_stop(), save: save || self.agreement.save, steps };
        self.agreement = self.job.agree(own)?;
        Ok(self.agreement.steps)
    }

    fn rest(&mut self, assembly: &mut Assembly) -> Result<(), Interruption> {
        let Agreement { signal, save, .. } = self.agreement;
        if save || signal.is_some() {
            self.agreement.save = false;
            self.checkpointer.write(assembly, false, self.writer.as_ref().map(RunWriter::sync), self.observer)?;
        }
        let Some(signal) = signal else { return Ok(()) };
        self.checkpointer.wait(self.observer);
        Err(Interruption::Stopped(signal))
    }
}

/// Π above which the explicit rule errs noticeably.
const LARGE_STIFFNESS_NUMBER: f64 = 0.1;

/// Tells whether the wear rule of a scene is out of its depth with a stiffness number (model section 8).
pub fn is_stiff(parameters: &Parameters, stiffness_number: f64) -> bool {
    parameters.integrator == Integrator::Explicit && stiffness_number > LARGE_STIFFNESS_NUMBER
}

/// Warns where the wear rule is out of its depth at the temperature with which a run begins.
pub fn stiffness_warning(parameters: &Parameters) -> Option<String> {
    let stiffness_number = parameters.first_stiffness_number();
    is_stiff(parameters, stiffness_number).then(|| in_words("the stiffness number is", stiffness_number))
}

fn in_words(what: &str, stiffness_number: f64) -> String {
    let found = number::short(stiffness_number);
    format!(
        "{what} {found}: above {LARGE_STIFFNESS_NUMBER} the explicit rule errs, above 1 it overshoots, \
         above 2 it is unstable; lower numerics.time_acceleration or set numerics.integrator = \"exponential\""
    )
}

/// Says why a run is not accelerated although it might choose.
pub fn idle_warning(idle: Idle) -> String {
    format!("numerics.time_acceleration: {idle}; see docs/evidence/accuracy.md")
}

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
    /// Wall time of the run before this process, s.
    earlier: f64,
    /// The last sample of the run, in this process or before.
    pub last_sample: Option<Sample>,
    /// Numbers of samples and maps that were sent to the run file.
    sent: [usize; 2],
    writing: Option<JoinHandle<io::Result<()>>>,
}

impl Checkpointer {
    /// Makes one for a run that begins, or that goes on from a state; `every` is the wall time between two checkpoints, s.
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

    /// Notes that a sample was sent to the run file.
    pub fn sampled(&mut self, sample: Sample) {
        self.sent[0] += 1;
        self.last_sample = Some(sample);
    }

    /// Notes that maps were sent to the run file.
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
        observer: &dyn Observer,
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
    pub fn wait(&mut self, observer: &dyn Observer) {
        match self.writing.take().map(JoinHandle::join) {
            Some(Ok(Err(error))) => warn(observer, &error),
            Some(Err(_)) => warn(observer, &io::Error::other("its thread panicked")),
            Some(Ok(Ok(()))) | None => {}
        }
    }
}

impl Drop for Checkpointer {
    /// Waits, so that nothing is being written when the claim on the run file ends.
    fn drop(&mut self) {
        // Who has not waited has a worse error to tell.
        let _ = self.writing.take().map(JoinHandle::join);
    }
}

fn warn(observer: &dyn Observer, error: &io::Error) {
    observer.warning(&format_args!(
        "cannot write a checkpoint: {error}; the run file is not touched by that, the last checkpoint still holds"
    ));
}
