//! `plateau run`: simulate a scene and write its run file.

use std::path::{Path, PathBuf};
use std::time::Instant;

use plateau_core::comm::CommError;
use plateau_core::observe::{Extras, Sample, Snapshot};
use plateau_core::scout::{Idle, Scout};
use plateau_core::simulation::{Execution, Simulation, SimulationError};
use plateau_core::state::InitialSurfaces;
use plateau_io::checkpoint::{self, RunState};
use plateau_io::run_file::{
    End, Header, InputFile, RunFile, RunFileError, RunWriter, State, check_place, report_file_size_limit,
};
use plateau_io::scene::recipe::Scene;
use plateau_io::surface::{self, Loaded};
use plateau_io::temporary::Temporary;

use super::load_scene;
use crate::arguments::{RunArguments, SceneArguments};
use crate::drive::{Sink, drive};
use crate::execution::decide;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::job::{Agreement, Job};
use crate::keeper::{About, Keeper};
use crate::message;
use crate::number;
use crate::progress::Progress;
use crate::resume;
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
    let scene = load_scene(&lengthened(arguments))?;
    let path = arguments.output.clone().unwrap_or_else(|| scene.output.file.clone());
    if job.leads() {
        check_place(&path, arguments.force || arguments.resumes()).map_err(Failure::input)?;
    }
    stability::warn(&scene.parameters);
    let loaded = surface::load(&scene).map_err(Failure::input)?;
    refuse_to_replace_inputs(&path, &scene, &loaded)?;
    let mut schedule = scene.schedule();
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
    interrupt.listen_for_save().map_err(Failure::run)?;
    let about = About { program: version::build(), scene: scene.resolved.clone(), inputs };
    let mut states = if arguments.resumes() { earlier(&path, &about, arguments)? } else { Vec::new() };
    let steps: Vec<u64> = states.iter().map(|state| state.run.steps()).collect();
    job.compare(&format!("{steps:?}"))?;
    if states.first().is_some_and(|state| state.finished && arguments.extend_to.is_none()) {
        message::note(format_args!("{} is finished; --extend-to TIME goes on beyond its end", path.display()));
        return Ok(());
    }
    if job.leads() {
        for target in [&path].into_iter().chain(&checkpoint::paths(&path)) {
            Temporary::remove_abandoned(target);
        }
    }
    let (writer, place) = if !job.leads() {
        (None, 0)
    } else if states.is_empty() {
        // What is there is of another run.
        checkpoint::remove(&path).map_err(Failure::run)?;
        let replaces = arguments.force || arguments.resumes();
        (Some(RunWriter::create(&path, replaces, &header).map_err(create_failure)?), 0)
    } else {
        let (writer, place) = resume::writer(&path, &header, &states)?;
        (Some(writer), place)
    };
    // The first rank has seen which of the states holds.
    let (place, _) = job.sum(place, 0)?;
    let state = (!states.is_empty()).then(|| states.swap_remove(place));
    if let Some(state) = &state {
        simulation.restore(&state.run).map_err(Failure::run)?;
        if let (Some(scout), Some(kept)) = (&mut scout, &state.scout) {
            scout.restore(kept).map_err(Failure::run)?;
        }
        schedule.go_on(state.run.clock());
        message::note(format_args!(
            "goes on from step {}, t = {} s",
            state.run.steps(),
            number::short(state.run.time())
        ));
    }
    let keeper = Keeper::new(&path, about, scene.output.checkpoint_every, state.as_ref());

    let start = Instant::now();
    let progress = Progress::new(schedule.end_time(), job.leads());
    let agreement = Agreement::default();
    let mut recorder = Recorder { writer, progress, interrupt, job, last: Sample::default(), keeper, agreement };
    let result = drive(&mut simulation, scout.as_mut(), schedule, &scene.output, &mut recorder);
    recorder.progress.finish();
    let Recorder { writer, last, mut keeper, .. } = recorder;
    keeper.wait();
    if result.is_ok() && keeper.keeps_the_end() && writer.is_none() {
        keeper.keep(&mut simulation, scout.as_mut(), true, None).map_err(Failure::run)?;
    }
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
            let message = format!(
                "stopped by signal {signal} after {steps} steps; {file} holds {samples} samples, --resume goes on from here"
            );
            return Err(Failure::Stopped { signal, message: Some(message) });
        }
        Err(failure) => {
            // The first error is the one to report; a writer that failed has nothing more to say.
            let _ = writer.finish(&End::Failed(failure.to_string()));
            return Err(Failure::run(failure));
        }
    }
    let report = writer.finish(&End::Finished).map_err(Failure::run)?;
    if keeper.keeps_the_end() {
        keeper.keep(&mut simulation, scout.as_mut(), true, Some(Keeper::synced())).map_err(Failure::run)?;
        keeper.wait();
    }
    let summary =
        Summary::new(&scene, surface_report, &path, &last, simulation.course(), report, start.elapsed().as_secs_f64());
    summary.warn();
    scout.as_ref().and_then(Scout::idle).into_iter().for_each(warn_of);
    if arguments.scene.json { print(&summary.to_json()?) } else { print(&summary.to_text()) }
}

/// The command line with the duration that `--extend-to` gives.
fn lengthened(arguments: &RunArguments) -> SceneArguments {
    let mut scene = arguments.scene.clone();
    scene.sets.extend(arguments.extend_to.iter().map(|time| format!("operation.duration={time}")));
    scene
}

/// The states that a run can go on from; none, which is said, where it begins from the beginning.
fn earlier(path: &Path, about: &About, arguments: &RunArguments) -> Result<Vec<RunState>, Failure> {
    let states = resume::states(path, about, arguments.extend_to.is_some())?;
    if !states.is_empty() {
        return Ok(states);
    }
    if path.exists() && !arguments.force {
        let there = RunFile::open(path).map_err(Failure::input)?;
        if there.state() == State::Finished {
            return Err(Failure::input(format_args!(
                "{} is finished and has no checkpoint to go on from; --force makes the run again",
                path.display()
            )));
        }
    }
    message::note("there is no checkpoint yet: begins from the beginning");
    Ok(states)
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
    keeper: Keeper,
    /// What all processes settled last.
    agreement: Agreement,
}

impl Sink for Recorder<'_> {
    type Error = RunFailure;

    fn sample(&mut self, sample: Sample) -> Result<(), RunFailure> {
        self.last = sample;
        self.keeper.sampled();
        self.writer.as_mut().map_or(Ok(()), |writer| writer.sample(sample)).map_err(RunFailure::RunFile)
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), RunFailure> {
        self.keeper.mapped();
        self.writer.as_mut().map_or(Ok(()), |writer| writer.snapshot(snapshot)).map_err(RunFailure::RunFile)
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, RunFailure> {
        self.progress.show(simulation);
        let save = self.interrupt.save() || (self.writer.is_some() && self.keeper.is_due());
        let own = Agreement { signal: self.interrupt.signal(), save: save || self.agreement.save, steps };
        self.agreement = self.job.agree(own).map_err(RunFailure::Comm)?;
        Ok(self.agreement.steps)
    }

    fn rest(&mut self, simulation: &mut Simulation, scout: Option<&mut Scout>) -> Result<(), RunFailure> {
        let Agreement { signal, save, .. } = self.agreement;
        if save || signal.is_some() {
            self.agreement.save = false;
            self.keeper.keep(simulation, scout, false, self.writer.as_ref().map(RunWriter::sync))?;
        }
        let Some(signal) = signal else { return Ok(()) };
        self.keeper.wait();
        Err(RunFailure::Stopped(signal))
    }
}
