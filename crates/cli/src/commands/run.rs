//! `plateau run`: simulate a scene and write its run file.

use std::path::{Path, PathBuf};
use std::time::Instant;

use plateau_core::comm::CommError;
use plateau_core::observe::{Extras, Sample, Snapshot};
use plateau_core::scout::{Idle, Scout};
use plateau_core::simulation::{Execution, Simulation, SimulationError};
use plateau_core::state::InitialSurfaces;
use plateau_io::run_file::{End, Header, InputFile, RunFileError, RunWriter, check_place, report_file_size_limit};
use plateau_io::scene::recipe::Scene;
use plateau_io::surface::{self, Loaded};

use super::load_scene;
use crate::arguments::RunArguments;
use crate::drive::{Sink, drive};
use crate::execution::decide;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::job::Job;
use crate::message;
use crate::progress::Progress;
use crate::stability;
use crate::summary::Summary;
use crate::table::print;
use crate::{machine, version};

/// Runs a scene, together with the other processes of the job if there are any.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let mut job = Job::start()?;
    let result = run_scene(arguments, &mut job);
    job.end(result)
}

/// All processes of the job do the same, but only the leading one writes and prints.
fn run_scene(arguments: &RunArguments, job: &mut Job) -> Result<(), Failure> {
    // Where the system takes no handler, a run beyond the file size limit ends by a signal; no reason not to run.
    let _ = report_file_size_limit();
    let scene = load_scene(&arguments.scene)?;
    let path = arguments.output.clone().unwrap_or_else(|| scene.output.file.clone());
    if job.leads() {
        check_place(&path, arguments.force).map_err(Failure::input)?;
    }
    stability::warn(&scene.parameters);
    let loaded = surface::load(&scene).map_err(Failure::input)?;
    refuse_to_replace_inputs(&path, &scene, &loaded)?;
    let schedule = scene.schedule();
    let Loaded { surfaces, inputs, report: surface_report } = loaded;
    let execution = decide(scene.workers, job.ranks(), &arguments.execution, &scene.parameters, &surfaces);
    let execution = execution.map_err(Failure::run)?;
    let mut scout = scout(&scene, &surfaces, execution, job)?;
    let mut simulation = job.simulation(scene.parameters.clone(), surfaces, execution).map_err(Failure::input)?;
    let header = header(&scene, &simulation, scout.is_some(), &inputs, &surface_report, schedule.samples())?;
    job.compare(
        &[&header.scene, &header.source_revision, &format!("{:?}", header.inputs)].map(String::as_str).concat(),
    )?;
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    let writer = job.leads().then(|| RunWriter::create(&path, arguments.force, &header)).transpose();
    let writer = writer.map_err(create_failure)?;

    let start = Instant::now();
    let progress = Progress::new(schedule.end_time(), job.leads());
    let mut recorder = Recorder { writer, progress, interrupt, job, last: Sample::default() };
    let result = drive(&mut simulation, scout.as_mut(), schedule, &scene.output, &mut recorder);
    recorder.progress.finish();
    let Recorder { writer, last, .. } = recorder;
    let Some(writer) = writer else {
        return result.map(drop).map_err(|failure| match failure {
            RunFailure::Stopped(signal) => Failure::Stopped { signal, message: None },
            failure => Failure::run(failure),
        });
    };
    match result {
        Ok(()) => {}
        Err(RunFailure::Stopped(signal)) => {
            let report = writer.finish(&End::Interrupted).map_err(Failure::run)?;
            let (steps, file, samples) = (simulation.steps_done(), path.display(), report.samples);
            let message = format!("stopped by signal {signal} after {steps} steps; {file} holds {samples} samples");
            return Err(Failure::Stopped { signal, message: Some(message) });
        }
        Err(failure) => {
            // The first error is the one to report; a writer that failed has nothing more to say.
            let _ = writer.finish(&End::Failed(failure.to_string()));
            return Err(Failure::run(failure));
        }
    }
    let report = writer.finish(&End::Finished).map_err(Failure::run)?;
    let summary =
        Summary::new(&scene, surface_report, &path, &last, simulation.course(), report, start.elapsed().as_secs_f64());
    summary.warn();
    scout.as_ref().and_then(Scout::idle).into_iter().for_each(warn_of);
    if arguments.scene.json { print(&summary.to_json()?) } else { print(&summary.to_text()) }
}

/// What goes before a run that chooses its acceleration, where there is something to choose.
fn scout(scene: &Scene, surfaces: &InitialSurfaces, execution: Execution, job: &Job) -> Result<Option<Scout>, Failure> {
    let Some(adaptive) = &scene.adaptive else { return Ok(None) };
    let simulation = job.simulation(scene.parameters.clone(), surfaces.clone(), execution).map_err(Failure::input)?;
    let scout = Scout::new(simulation, adaptive, scene.duration).map_err(Failure::run)?;
    if let Some(idle) = scout.idle() {
        warn_of(idle);
        return Ok(None);
    }
    Ok(Some(scout))
}

/// Says why the run is not accelerated although it might choose.
pub fn warn_of(idle: Idle) {
    message::warning(format_args!("numerics.time_acceleration: {idle}; see docs/accuracy.md"));
}

/// Refuses an output that is a file which the run reads: not even `--force` is meant like that.
fn refuse_to_replace_inputs(output: &Path, scene: &Scene, loaded: &Loaded) -> Result<(), Failure> {
    let Ok(existing) = output.canonicalize() else { return Ok(()) };
    let mut inputs = scene.files.iter().chain(loaded.inputs.iter().map(|(path, _)| path));
    if inputs.any(|input| input.canonicalize().is_ok_and(|input| input == existing)) {
        let output = output.display();
        return Err(Failure::input(format_args!(
            "the output file {output} is an input of this run and is not replaced; write elsewhere with -o FILE"
        )));
    }
    Ok(())
}

/// The part of the run file that is known before the first step.
fn header(
    scene: &Scene,
    simulation: &Simulation,
    accelerates: bool,
    surface_files: &[(PathBuf, String)],
    surfaces: &[String],
    expected_samples: u64,
) -> Result<Header, Failure> {
    let mut inputs = InputFile::read_all(&scene.files)
        .map_err(|(path, error)| Failure::input(format_args!("{}: {error}", path.display())))?;
    inputs.extend(
        surface_files
            .iter()
            .map(|(path, sha256)| InputFile { path: path.to_string_lossy().into_owned(), sha256: sha256.clone() }),
    );
    Ok(Header {
        title: scene.title.clone(),
        mesh: scene.parameters.mesh.clone(),
        pin_base: simulation.pin_base().to_vec(),
        maps: scene.output.maps.clone(),
        extras: Extras { roughness: scene.output.roughness, acceleration: accelerates },
        expected_samples,
        scene: scene.resolved.clone(),
        program: version::program(),
        source_revision: version::REVISION.into(),
        host: machine::host(),
        workers: simulation.execution().workers,
        instruction_set: simulation.execution().instructions.name().into(),
        seeds: scene.seeds.clone(),
        inputs,
        surfaces: surfaces.to_vec(),
    })
}

/// Whose fault it is that a run file cannot be made.
fn create_failure(error: RunFileError) -> Failure {
    match error {
        RunFileError::SetUp { .. } | RunFileError::Write { .. } => Failure::run(error),
        _ => Failure::input(error),
    }
}

/// Why a run that had started did not end.
#[derive(Debug)]
enum RunFailure {
    Simulation(SimulationError),
    RunFile(RunFileError),
    Comm(CommError),
    /// This signal asked the run to stop.
    Stopped(u8),
}

impl From<SimulationError> for RunFailure {
    fn from(error: SimulationError) -> Self {
        Self::Simulation(error)
    }
}

impl std::fmt::Display for RunFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Simulation(error) => error.fmt(f),
            Self::RunFile(error) => error.fmt(f),
            Self::Comm(error) => error.fmt(f),
            Self::Stopped(signal) => write!(f, "stopped by signal {signal}"),
        }
    }
}

/// Hands what a simulation reports to the writer and shows how far it is.
struct Recorder<'job> {
    /// None in a process that does not lead.
    writer: Option<RunWriter>,
    progress: Progress,
    interrupt: Interrupt,
    job: &'job mut Job,
    last: Sample,
}

impl Sink for Recorder<'_> {
    type Error = RunFailure;

    fn sample(&mut self, sample: Sample) -> Result<(), RunFailure> {
        self.last = sample;
        self.writer.as_mut().map_or(Ok(()), |writer| writer.sample(sample)).map_err(RunFailure::RunFile)
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), RunFailure> {
        self.writer.as_mut().map_or(Ok(()), |writer| writer.snapshot(snapshot)).map_err(RunFailure::RunFile)
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, RunFailure> {
        self.progress.show(simulation);
        let (signal, steps) = self.job.agree(self.interrupt.signal(), steps).map_err(RunFailure::Comm)?;
        signal.map_or(Ok(steps), |signal| Err(RunFailure::Stopped(signal)))
    }
}
