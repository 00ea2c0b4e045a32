//! Commands, one file or folder for each.

mod accuracy;
mod check;
mod check_parts;
mod check_report;
mod new;
mod reference;
mod repair;
mod run;
mod runs;
mod surface;
mod sweep;
mod verify;
mod watch;

use crate::arguments::{Arguments, Command};
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
        Command::Summary(arguments) => runs::summary(&arguments),
        Command::Schema => reference::schema(),
        Command::Completions(arguments) => reference::completions(&arguments),
        Command::Man(arguments) => reference::man(&arguments),
    }
}
