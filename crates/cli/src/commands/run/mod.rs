//! `plateau run`: simulate a scene and write its run file.

mod beginning;
mod header;
mod recorder;

use std::path::Path;
use std::time::Instant;

use plateau_core::acceleration::scout::{Idle, Scout};
use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::{Execution, Simulation};
use plateau_io::checkpoint;
use plateau_io::claim::Claim;
use plateau_io::plausibility::{self, Recorded};
use plateau_io::process::report_file_size_limit;
use plateau_io::run_file::{End, RunFile, RunWriter, Synced, WriterReport, check_place};
use plateau_io::scene::recipe::Scene;
use plateau_io::surface::{self, Loaded};

use self::beginning::{Beginning, not_claimed};
use self::header::header;
use self::recorder::{Recorder, RunFailure};
use super::{load_scene, warn_of_scene};
use crate::arguments::{RunArguments, SceneArguments};
use crate::drive::{drive, go_on};
use crate::execution::decide;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::job::{Agreement, Job};
use crate::keeper::{About, Keeper};
use crate::progress::Progress;
use crate::summary::Summary;
use crate::table::print;
use crate::{message, number, stability, version};

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
    // From now on: preparing a large scene takes long enough to be told to stop meanwhile.
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    interrupt.listen_for_save().map_err(Failure::run)?;
    let mut scene = load_scene(&lengthened(arguments))?;
    let path = arguments.output.clone().unwrap_or_else(|| scene.output.file.clone());
    // What a link points to is what is written, and its checkpoints lie beside it.
    let path = if path.is_symlink() { path.canonicalize().unwrap_or(path) } else { path };
    if job.leads() {
        check_place(&path, arguments.force || arguments.resumes()).map_err(Failure::input)?;
        Claim::check(&path).map_err(not_claimed)?;
    }
    stability::warn(&scene.parameters);
    let loaded = surface::load(&scene).map_err(Failure::input)?;
    stop_if_told(&interrupt, job)?;
    refuse_to_replace_inputs(&path, &scene, &loaded)?;
    let implausible = plausibility::of_surfaces(&scene, &loaded);
    warn_of_scene(&mut scene, implausible);
    let mut schedule = scene.schedule();
    let Loaded { surfaces, inputs, report: surface_report, .. } = loaded;
    let execution = decide(&scene, job.ranks(), &arguments.execution, &surfaces);
    let execution = execution.map_err(Failure::run)?;
    let mut scout = scout(&scene, &surfaces, execution, job)?;
    let mut simulation = job.simulation(scene.parameters.clone(), surfaces, execution).map_err(Failure::input)?;
    let header = header(&scene, &simulation, scout.is_some(), &inputs, &surface_report, schedule.samples())?;
    job.compare(
        &[&header.scene, &header.source_revision, &format!("{:?}", header.inputs)].map(String::as_str).concat(),
    )?;
    let about = About { program: version::build(), engine: execution.engine, scene: scene.resolved.clone(), inputs };
    stop_if_told(&interrupt, job)?;
    let beginning = Beginning::of(&path, &header, &about, arguments, schedule.end_time(), job)?;
    // In this order: the claim goes last.
    let Some(Beginning { claim: _claim, writer, state }) = beginning else {
        return Ok(());
    };
    if let Some(state) = &state {
        let kept = (&state.run, state.scout.as_ref());
        go_on(&mut simulation, scout.as_mut(), &mut schedule, kept).map_err(Failure::run)?;
        let (steps, time) = (state.run.steps(), number::short(state.run.time()));
        message::note(format_args!("goes on from step {steps}, t = {time} s"));
    }
    let keeper = Keeper::new(&path, about, scene.output.checkpoint_every, state.as_ref());

    let start = Instant::now();
    let progress = Progress::new(schedule.end_time(), job.leads());
    let agreement = Agreement::default();
    let recorded = Recorded::new(&scene.parameters);
    let mut recorder = Recorder { writer, progress, interrupt, job, keeper, agreement, recorded };
    let result = drive(&mut simulation, scout.as_mut(), schedule, &scene.output, &mut recorder);
    recorder.progress.finish();
    let Recorder { writer, mut keeper, recorded, .. } = recorder;
    keeper.wait();
    let Some(writer) = writer else {
        result.map_err(failure_of)?;
        return keeper.keep(&mut simulation, scout.as_mut(), true, None).map_err(Failure::run);
    };
    let report = close(result, writer, &simulation, &path)?;
    keeper.keep(&mut simulation, scout.as_mut(), true, Some(Synced::already())).map_err(Failure::run)?;
    keeper.wait();
    let contact_area = RunFile::open(&path).and_then(|run| run.last_contact_area()).map_err(Failure::run)?;
    let implausible = recorded.warnings(&scene);
    warn_of_scene(&mut scene, implausible);
    let summary = Summary::new(
        &scene,
        surface_report,
        &path,
        &keeper.last_sample.clone().unwrap_or_default(),
        contact_area,
        simulation.course(),
        report,
        start.elapsed().as_secs_f64(),
    );
    summary.warn();
    scout.as_ref().and_then(Scout::idle).into_iter().for_each(warn_of);
    let text = if arguments.scene.json { summary.to_json()? } else { summary.to_text() };
    print(&text).map_err(|failure| failure.but(format_args!("the run is finished, {} is complete", path.display())))
}

/// Closes the file of a run that has ended like this.
fn close(
    result: Result<(), RunFailure>,
    writer: RunWriter,
    simulation: &Simulation,
    path: &Path,
) -> Result<WriterReport, Failure> {
    let end = match &result {
        Ok(()) => End::Finished,
        Err(RunFailure::Stopped(_)) => End::Interrupted,
        Err(failure) => End::Failed(failure.to_string()),
    };
    match (result, writer.finish(&end)) {
        (Err(RunFailure::Stopped(signal)), Ok(report)) => {
            let (steps, file, samples) = (simulation.steps_done(), path.display(), report.samples);
            let message = format!(
                "stopped by signal {signal} after {steps} steps; {file} holds {samples} samples, --resume goes on from here"
            );
            Err(Failure::Stopped { signal, message: Some(message) })
        }
        (Ok(()) | Err(RunFailure::Stopped(_)), closed) => closed.map_err(Failure::run),
        // The first error is the one to report; a writer that failed has nothing more to say.
        (Err(failure), _) => Err(failure_of(failure)),
    }
}

/// How a process that has no file to close fails.
fn failure_of(failure: RunFailure) -> Failure {
    match failure {
        RunFailure::Stopped(signal) => Failure::Stopped { signal, message: None },
        failure => Failure::run(failure),
    }
}

/// Ends what is not a run yet when a signal has come to any process of the job.
fn stop_if_told(interrupt: &Interrupt, job: &mut Job) -> Result<(), Failure> {
    let own = Agreement { signal: interrupt.signal(), ..Agreement::default() };
    let Some(signal) = job.agree(own).map_err(Failure::run)?.signal else { return Ok(()) };
    let message = format!("stopped by signal {signal} before the first step");
    Err(Failure::Stopped { signal, message: job.leads().then_some(message) })
}

/// The command line with the duration that `--extend-to` gives.
fn lengthened(arguments: &RunArguments) -> SceneArguments {
    let mut scene = arguments.scene.clone();
    scene.sets.extend(arguments.extend_to.iter().map(|time| format!("operation.duration={time}")));
    scene
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

/// Refuses an output, or a checkpoint of it, that is a file which the run reads: not even `--force` is meant like that.
fn refuse_to_replace_inputs(output: &Path, scene: &Scene, loaded: &Loaded) -> Result<(), Failure> {
    let inputs = scene.files.iter().chain(loaded.inputs.iter().map(|(path, _)| path));
    let inputs: Vec<_> = inputs.filter_map(|input| input.canonicalize().ok()).collect();
    let [last, before] = checkpoint::paths(output);
    for (what, path) in [("output file", output), ("checkpoint", &last), ("checkpoint", &before)] {
        if path.canonicalize().is_ok_and(|path| inputs.contains(&path)) {
            let path = path.display();
            return Err(Failure::input(format_args!(
                "the {what} {path} is an input of this run and is not replaced; write elsewhere with -o FILE"
            )));
        }
    }
    Ok(())
}
