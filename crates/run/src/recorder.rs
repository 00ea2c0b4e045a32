//! Recorder of a run: the header of its run file, the way of its samples and maps, what may end it, and warnings of the stiffness that it
//! comes to.

use std::path::PathBuf;

use plateau_core::acceleration::scout::Idle;
use plateau_core::engine::comm::CommError;
use plateau_core::model::parameters::{Integrator, Parameters};
use plateau_core::observe::{Sample, Snapshot};
use plateau_core::simulation::{Simulation, SimulationError};
use plateau_io::number;
use plateau_io::plausibility::Recorded;
use plateau_io::run_file::{Header, InputFile, RunFileError, RunWriter};
use plateau_io::scene::Scene;

use crate::assembly::Assembly;
use crate::checkpointer::Checkpointer;
use crate::error::RunFailure;
use crate::execution;
use crate::job::{Agreement, Job};
use crate::options::{Observer, Program};
use crate::time_loop::Sink;

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
    /// It failed.
    Failed(RunFailure),
    /// This signal asked it to stop.
    Stopped(u8),
}

impl From<SimulationError> for Interruption {
    fn from(error: SimulationError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<RunFileError> for Interruption {
    fn from(error: RunFileError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<CommError> for Interruption {
    fn from(error: CommError) -> Self {
        Self::Failed(error.into())
    }
}

/// Hands what a simulation reports to the writer and to the observer, and does what that asks for.
pub struct Recorder<'a> {
    /// None in a process that does not lead.
    pub writer: Option<RunWriter>,
    /// Told of every sample, and asked whether to go on.
    pub observer: &'a mut dyn Observer,
    /// The processes that take the steps together.
    pub job: &'a mut Job,
    /// Writes the state now and then.
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
            self.observer.warning(&grown_stiffness_warning(stiffness_number, simulation.time()));
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

/// Says where that is so at the temperature with which a run begins.
pub fn stiffness_warning(parameters: &Parameters) -> Option<String> {
    let stiffness_number = parameters.first_stiffness_number();
    is_stiff(parameters, stiffness_number).then(|| in_words("the stiffness number is", stiffness_number))
}

/// Says that it has become so.
pub fn grown_stiffness_warning(stiffness_number: f64, time: f64) -> String {
    let time = number::rounded(time, 4);
    in_words(
        &format!("with the wear rates of the temperature after {time} s the stiffness number is"),
        stiffness_number,
    )
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
