//! `plateau run`: simulate a scene and write its run file.

use plateau_io::process::report_file_size_limit;
use plateau_run::{Job, RunOptions, StartMode};

use super::load_scene;
use crate::arguments::{RunArguments, SceneArguments};
use crate::failure::{Failure, in_job};
use crate::table::print;
use crate::terminal::Terminal;
use crate::{message, summary, version};

/// Runs a scene, together with the other processes of the job if there are any.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    in_job(|job| run_scene(arguments, job))
}

/// All processes of the job do the same, but only the leading one writes and prints.
fn run_scene(arguments: &RunArguments, job: &mut Job) -> Result<(), Failure> {
    // Where the system takes no handler, a run beyond the file size limit ends by a signal; no reason not to run.
    let _ = report_file_size_limit();
    // From now on: preparing a large scene takes long enough to be told to stop meanwhile.
    let mut terminal = Terminal::listen_for_save(job.leads()).map_err(Failure::run)?;
    // Of several processes, too, each ends by itself: nothing is written yet.
    terminal.end_while_preparing();
    let scene = load_scene(&lengthened(arguments))?;
    let mode = match (arguments.resume, &arguments.extend_to) {
        (_, Some(_)) => StartMode::Extend,
        (true, None) => StartMode::Resume,
        (false, None) => StartMode::New,
    };
    let options = RunOptions {
        output: arguments.output.clone(),
        replace: arguments.force,
        mode,
        execution: arguments.execution.options(),
        program: version::this(),
    };
    let finished = plateau_run::run(scene, &options, job, &mut terminal).map_err(Failure::of)?;
    let Some(summary) = finished else { return Ok(()) };
    let text = if arguments.scene.json { summary::json(&summary)? } else { summary::text(&summary) };
    if message::is_quiet() && !arguments.scene.json {
        return Ok(());
    }
    let file = summary.file.display();
    print(&text).map_err(|failure| failure.but(format_args!("the run is finished, {file} is complete")))
}

/// The command line with the duration that `--extend-to` gives.
fn lengthened(arguments: &RunArguments) -> SceneArguments {
    let mut scene = arguments.scene.clone();
    scene.sets.extend(arguments.extend_to.iter().map(|time| format!("operation.duration={time}")));
    scene
}
