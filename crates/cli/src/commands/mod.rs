//! One file per command.

mod accuracy;
mod check;
mod check_cycle;
mod check_files;
mod check_outline;
mod check_pulse;
mod check_report;
mod completions;
mod man;
mod new;
mod repair;
mod run;
mod runs;
mod schema;
mod summary;
mod surface;
mod sweep;
mod verify;
mod watch;

use plateau_io::plausibility;
use plateau_io::scene::{self, Scene};

use crate::arguments::{Arguments, Command, SceneArguments};
use crate::failure::Failure;
use crate::hand_over::hand_over;
use crate::message;

/// Does what the command line asks for.
pub fn perform(arguments: Arguments) -> Result<(), Failure> {
    message::set_level(arguments.quiet, arguments.verbose);
    match arguments.command {
        Command::New(arguments) => new::new(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Plot(handed) => hand_over("plot", handed.arguments),
        Command::Report(handed) => hand_over("report", handed.arguments),
        Command::Watch(arguments) => watch::watch(&arguments),
        Command::Export(handed) => hand_over("export", handed.arguments),
        Command::Accuracy(arguments) => accuracy::accuracy(&arguments),
        Command::Sweep(command) => sweep::sweep(command),
        Command::Fit(handed) => hand_over("fit", handed.arguments),
        Command::Compare(handed) => hand_over("compare", handed.arguments),
        Command::Surface(arguments) => surface::surface(&arguments),
        Command::Verify(arguments) => verify::verify(&arguments),
        Command::Repair(arguments) => repair::repair(&arguments),
        Command::Summary(arguments) => summary::summary(&arguments),
        Command::Schema => schema::schema(),
        Command::Completions(arguments) => completions::completions(&arguments),
        Command::Man(arguments) => man::man(&arguments),
    }
}

/// Reads the scene with the changes of the command line; what it can hardly mean goes to standard error.
fn load_scene(arguments: &SceneArguments) -> Result<Scene, Failure> {
    let mut sets = arguments.sets.clone();
    sets.extend(arguments.workers.iter().map(|workers| format!("numerics.workers={workers}")));
    let mut scene = scene::load(&arguments.scene, &sets).map_err(Failure::of_scene)?;
    scene.warnings.extend(plausibility::of_scene(&scene));
    scene.warnings.iter().for_each(message::warning);
    Ok(scene)
}
