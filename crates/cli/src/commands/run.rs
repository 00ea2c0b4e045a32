//! `plateau run`: simulate a scene and write its run file.

use std::path::Path;

use plateau_io::plausibility;
use plateau_io::scene::{self, Scene};
use plateau_run::{Job, RunOptions, StartMode};

use crate::arguments::{RunArguments, SceneArguments};
use crate::commands::runs;
use crate::failure::{Failure, in_job, of_scene};
use crate::output::{json, print};
use crate::terminal::Terminal;
use crate::{invocation, message, output, program};

/// Runs a scene, together with the other processes of the job if there are any.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    in_job(|job| run_scene(arguments, job))
}

/// All processes of the job do the same, but only the leading one writes and prints.
fn run_scene(arguments: &RunArguments, job: &mut Job) -> Result<(), Failure> {
    let terminal = Terminal::listen_for_run(job.leads()).map_err(Failure::run)?;
    if let Some(output) = &arguments.output {
        refuse_other_format("-o", output)?;
    }
    let mut changed = arguments.scene.clone();
    changed.sets.extend(arguments.extend_to.iter().map(|time| format!("operation.duration={time}")));
    let scene = load_scene(&changed)?;
    if arguments.output.is_none() {
        refuse_other_format("output.file", &scene.output.file)?;
    }
    let mode = match (arguments.resume, &arguments.extend_to) {
        (_, Some(_)) => StartMode::Extend,
        (true, None) => StartMode::Resume,
        (false, None) => StartMode::New,
    };
    let options = RunOptions {
        output: arguments.output.clone(),
        replace: arguments.force,
        mode,
        execution: arguments.execution.execution(),
        program: program::this(),
    };
    make(scene, &options, arguments.scene.json, job, terminal)
}

/// Makes a run and prints what came of it.
pub fn make(
    scene: Scene,
    options: &RunOptions,
    as_json: bool,
    job: &mut Job,
    terminal: Terminal,
) -> Result<(), Failure> {
    let finished = plateau_run::run(scene, options, job, &terminal)?;
    let Some(summary) = finished else { return Ok(()) };
    let text = if as_json { json(&summary)? } else { runs::text(&summary) };
    if message::is_quiet() && !as_json {
        return Ok(());
    }
    let file = summary.file.display();
    print(&text).map_err(|failure| failure.but(format_args!("the run is finished, {file} is complete")))
}

/// Endings of what `export`, `plot` and `report` make of a run file, with the call that does so.
const MADE_OF_RUNS: [(&str, &str); 8] = [
    ("csv", "export RUN.h5 --to csv"),
    ("npz", "export RUN.h5 --to npz"),
    ("pvd", "export RUN.h5 --to vtk"),
    ("vtk", "export RUN.h5 --to vtk"),
    ("png", "plot RUN.h5"),
    ("svg", "plot RUN.h5"),
    ("pdf", "plot RUN.h5"),
    ("html", "report RUN.h5"),
];

/// Refuses a name that says that a run file is what it is not; `given` says where it is from.
fn refuse_other_format(given: &str, file: &Path) -> Result<(), Failure> {
    let ending = output::ending(file);
    match MADE_OF_RUNS.iter().find(|(other, _)| *other == ending) {
        None => Ok(()),
        Some((_, call)) => Err(Failure::input(format!(
            "{given} {}: a run file is HDF5, expected a name such as {}; afterwards `{} {call}` makes .{ending} of it",
            file.display(),
            file.with_extension("h5").display(),
            invocation::program()
        ))),
    }
}

/// Reads the scene with the changes of the command line; what it can hardly mean goes to standard error.
pub fn load_scene(arguments: &SceneArguments) -> Result<Scene, Failure> {
    Ok(warned(scene::load(&arguments.scene, &sets(arguments)).map_err(of_scene)?))
}

/// A scene of which it is said what it can hardly mean.
pub fn warned(mut scene: Scene) -> Scene {
    scene.warnings.extend(plausibility::of_scene(&scene));
    scene.warnings.iter().for_each(message::warning);
    scene
}

/// All changes of a scene on the command line, as after `--set`.
pub fn sets(arguments: &SceneArguments) -> Vec<String> {
    let workers = arguments.workers.iter().map(|workers| format!("numerics.workers={workers}"));
    let decomposition = arguments.decomposition.iter().map(|kind| format!("numerics.decomposition={kind}"));
    arguments.sets.iter().cloned().chain(workers).chain(decomposition).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/commands/run.rs"]
mod tests;
