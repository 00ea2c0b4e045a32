//! A run from its scene to its run file.

use std::error::Error as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use plateau_io::claim::Claim;
use plateau_io::number;
use plateau_io::plausibility::{self, Recorded};
use plateau_io::run_file::checkpoint::{self, RunState};
use plateau_io::run_file::{End, Header, RunFile, RunFileError, RunWriter, State, Synced, WriterReport, check_output};
use plateau_io::scene::{Scene, Warning};
use plateau_io::surface::{self, Loaded};

use crate::assembly::Assembly;
use crate::error::{InputError, Progress, RunError, RunFailure, Stopped};
use crate::execution::{check_ranks, decide};
use crate::job::{Agreement, Job};
use crate::options::{Observer, RunOptions};
use crate::recorder::{
    Checkpointer, Interruption, Recorder, RunIdentity, header, idle_warning, is_stiff, stiffness_warning,
};
use crate::start::{Request, Start};
use crate::summary::RunSummary;

/// Runs a scene, together with the other processes of the job if there are any: makes its surfaces, takes its steps and writes
/// its run file, with checkpoints beside it from which a run that was stopped or killed goes on.
///
/// Gives what came of it; nothing where the run was finished before, and in a process that writes no file.
pub fn run(
    scene: Scene,
    options: &RunOptions,
    job: &mut Job,
    observer: &dyn Observer,
) -> Result<Option<RunSummary>, RunError> {
    let prepared = Prepared::new(scene, options, job, observer)?;
    stop_if_asked(observer, job)?;
    observer.prepared();
    let Prepared { path, header, identity, assembly, .. } = &prepared;
    let request = Request { path, header, identity, options, end: assembly.schedule.end_time() };
    let Some(Start { claim, writer, state }) = request.start(job, observer)? else { return Ok(None) };
    let summary = prepared.carry_out(writer, state, job, observer);
    // Nothing is written any more.
    drop(claim);
    summary
}

/// Starts the threads that make surfaces, unless the caller has some. Left to its first use, rayon starts them, too, and panics where there
/// are none.
fn start_threads() -> Result<(), RunError> {
    if rayon::current_thread_index().is_some() {
        return Ok(());
    }
    match rayon::ThreadPoolBuilder::new().build_global() {
        // Only what the system says is an error of another kind: the threads are there already.
        Err(error) if error.source().is_some() => Err(error.into()),
        _ => Ok(()),
    }
}

/// A scene with its surfaces made, before anything is written.
struct Prepared {
    scene: Scene,
    path: PathBuf,
    assembly: Assembly,
    header: Header,
    identity: RunIdentity,
}

impl Prepared {
    fn new(mut scene: Scene, options: &RunOptions, job: &mut Job, observer: &dyn Observer) -> Result<Self, RunError> {
        check_ranks(&scene, job.ranks(), options.execution.pin)?;
        let path = options.output.clone().unwrap_or_else(|| scene.output.file.clone());
        // What a link points to is what is written, and its checkpoints lie beside it.
        let path = if path.is_symlink() { path.canonicalize().unwrap_or(path) } else { path };
        if job.leads() {
            if let Err(error) = check_output(&path, options.replace || options.mode.resumes()) {
                return Err(if_unfinished(error, &path)?.into());
            }
            Claim::check(&path)?;
        }
        stiffness_warning(&scene.parameters).iter().for_each(|warning| observer.warning(warning));
        start_threads()?;
        let loaded = surface::load(&scene).map_err(InputError::from)?;
        // Large surfaces take long enough to be told to stop meanwhile.
        stop_if_asked(observer, job)?;
        refuse_to_replace_inputs(&path, &scene, &loaded)?;
        // A wrong unit of a surface is the cause of what the scene is warned of then.
        loaded.warnings().for_each(|warning| observer.warning(&warning));
        let implausible = plausibility::of_surfaces(&scene, &loaded);
        warn_of_scene(&mut scene, implausible, observer);
        let Loaded { surfaces, inputs, report, .. } = loaded;
        report.iter().for_each(|step| observer.detail(step));
        let execution = decide(&scene, job.ranks(), options.execution, &surfaces, observer)?;
        let on_job = |parameters, surfaces, execution| job.simulation(parameters, surfaces, execution);
        let assembly = Assembly::made_by(on_job, &scene, surfaces, execution)?;
        assembly.idle().into_iter().for_each(|idle| observer.warning(&idle_warning(idle)));
        let header = header(&scene, &assembly, &options.program, &inputs, report);
        job.compare(
            &[&header.scene, &header.source_revision, &format!("{:?}", header.inputs)].map(String::as_str).concat(),
        )?;
        let (program, engine) = (options.program.build(), execution.engine);
        // With another content of the cycle it is another run.
        let cycle = scene.cycle.as_ref().and_then(|operation| operation.file.clone());
        let inputs = inputs.into_iter().chain(cycle).collect();
        let identity = RunIdentity { program, engine, scene: scene.resolved.clone(), inputs };
        Ok(Self { scene, path, assembly, header, identity })
    }

    /// Takes the steps that are left and closes the file.
    fn carry_out(
        self,
        writer: Option<RunWriter>,
        state: Option<RunState>,
        job: &mut Job,
        observer: &dyn Observer,
    ) -> Result<Option<RunSummary>, RunError> {
        let Self { mut scene, path, mut assembly, header, identity } = self;
        if let Some(state) = &state {
            assembly.restore(&state.simulation)?;
            let (steps, time) = (state.simulation.run.steps(), number::short(state.simulation.reached));
            observer.note(&format_args!("goes on from step {steps}, t = {time} s"));
        }
        let checkpointer = Checkpointer::new(&path, identity, scene.output.checkpoint_every, state.as_ref());

        let began = (Instant::now(), assembly.simulation.course().steps);
        observer.starts("", assembly.schedule.end_time());
        let (agreement, recorded) = (Agreement::default(), Recorded::new(&scene.parameters));
        let is_stiff = is_stiff(&scene.parameters, scene.parameters.first_stiffness_number());
        let mut recorder = Recorder { writer, observer, job, checkpointer, agreement, recorded, is_stiff };
        let result = assembly.run_to_end(&mut recorder);
        let Recorder { writer, mut checkpointer, recorded, .. } = recorder;
        observer.ends();
        checkpointer.wait(observer);
        let Some(writer) = writer else {
            result.map_err(without_file)?;
            checkpointer.write(&mut assembly, true, None, observer)?;
            return Ok(None);
        };
        let report = close(result, writer, &assembly, &path)?;
        checkpointer.write(&mut assembly, true, Some(Synced::already()), observer)?;
        checkpointer.wait(observer);
        let implausible = recorded.warnings(&scene);
        warn_of_scene(&mut scene, implausible, observer);
        let last = checkpointer.last_sample.clone().unwrap_or_default();
        let summary = RunSummary::new(&scene, header.surfaces, path, &last, &assembly, report, began);
        let summary = summary.map_err(RunFailure::Read)?;
        summary.inexact_load().iter().for_each(|warning| observer.warning(warning));
        // Why there was no scout from the start is said already.
        let idle = assembly.idle().filter(|_| assembly.chooses_acceleration());
        idle.into_iter().for_each(|idle| observer.warning(&idle_warning(idle)));
        Ok(Some(summary))
    }
}

/// Closes the file of a run that has ended like this.
fn close(
    result: Result<(), Interruption>,
    writer: RunWriter,
    assembly: &Assembly,
    path: &Path,
) -> Result<WriterReport, RunError> {
    let end = match &result {
        Ok(()) => End::Finished,
        Err(Interruption::Stopped(_)) => End::Interrupted,
        Err(Interruption::Failed(failure)) => End::Failed(failure.to_string()),
    };
    match (result, writer.finish(&end, assembly.events(), assembly.chosen_acceleration())) {
        (Err(Interruption::Stopped(signal)), Ok(report)) => {
            let (steps, times) =
                (assembly.simulation.steps_done(), [assembly.simulation.time(), assembly.schedule.end_time()]);
            let progress = Progress::Saved { times, steps, file: path.to_owned(), samples: report.samples };
            Err(Stopped { signal, progress }.into())
        }
        (Ok(()) | Err(Interruption::Stopped(_)), closed) => Ok(closed.map_err(RunFailure::RunFile)?),
        // The first error is the one to report; a writer that failed has nothing more to say.
        (Err(failure), _) => Err(without_file(failure)),
    }
}

/// The refusal of a run file that is there, with what is known of it: it may be one to go on with.
fn if_unfinished(error: RunFileError, path: &Path) -> Result<InputError, RunError> {
    if !matches!(error, RunFileError::Exists { .. }) {
        return Ok(InputError::RunFile(error));
    }
    Claim::check(path)?;
    // Of a run that was killed the file says that it is running, and nobody has the claim.
    let is_stopped = RunFile::open(path).is_ok_and(|run| run.state() != State::Finished);
    let has_checkpoint = checkpoint::paths(path).iter().any(|checkpoint| checkpoint.exists());
    if !is_stopped || !has_checkpoint {
        return Ok(InputError::RunFile(error));
    }
    Ok(InputError::Refused(format!(
        "{} exists, and its run was stopped before its end; --resume goes on with it if the scene is the same, --force begins \
         again, -o FILE writes elsewhere",
        path.display()
    )))
}

/// Failure of a process that has no file to close.
fn without_file(interruption: Interruption) -> RunError {
    match interruption {
        Interruption::Stopped(signal) => Stopped { signal, progress: Progress::Elsewhere }.into(),
        Interruption::Failed(failure) => failure.into(),
    }
}

/// Ends what is not a run yet when any process of the job is asked to stop.
fn stop_if_asked(observer: &dyn Observer, job: &mut Job) -> Result<(), RunError> {
    let own = Agreement { signal: observer.asked_to_stop(), ..Agreement::default() };
    let Some(signal) = job.agree(own)?.signal else { return Ok(()) };
    let progress = if job.leads() { Progress::NotStarted } else { Progress::Elsewhere };
    Err(Stopped { signal, progress }.into())
}

/// Says what else the scene can hardly mean, and keeps it with what was said of it before.
fn warn_of_scene(scene: &mut Scene, warnings: Vec<Warning>, observer: &dyn Observer) {
    warnings.iter().for_each(|warning| observer.warning(warning));
    scene.warnings.extend(warnings);
}

/// Refuses an output, or a checkpoint of it, that is a file which the run reads: not even to be replaced is meant like that.
fn refuse_to_replace_inputs(output: &Path, scene: &Scene, loaded: &Loaded) -> Result<(), InputError> {
    let inputs = scene.files.iter().chain(&loaded.inputs).map(|(path, _)| path);
    let inputs: Vec<_> = inputs.filter_map(|input| input.canonicalize().ok()).collect();
    let [last, before] = checkpoint::paths(output);
    for (what, path) in [("output file", output), ("checkpoint", &last), ("checkpoint", &before)] {
        if path.canonicalize().is_ok_and(|path| inputs.contains(&path)) {
            let path = path.display();
            return Err(InputError::Refused(format!(
                "the {what} {path} is an input of this run and is not replaced; write elsewhere with -o FILE"
            )));
        }
    }
    Ok(())
}
