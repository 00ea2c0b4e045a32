//! The program `plateau`.

mod arguments;
/// Commands, one file or folder for each.
mod commands {
    pub mod accuracy;
    pub mod check;
    pub mod new;
    pub mod reference;
    pub mod repair;
    pub mod run;
    pub mod runs;
    pub mod surface;
    pub mod sweep {
        pub mod collect;
        pub mod plan;
        pub mod run;
    }
    pub mod verify;
    pub mod watch;
}
mod failure;
mod hand_over;
mod invocation;
mod look;
mod message;
mod output;
mod program;
mod terminal;

use std::process::ExitCode;

use clap::{CommandFactory as _, Parser};
use plateau_io::process::report_file_size_limit;

use arguments::{Arguments, Command, HandedArguments, SweepCommand};
use commands::{accuracy, check, new, reference, repair, run, runs, surface, sweep, verify, watch};
use failure::{Failure, report};
use hand_over::hand_over;

fn main() -> ExitCode {
    program::fit_environment();
    terminal::Interrupt::pass_over_saves();
    if let Err(failure) = program::refuse_little_memory() {
        return report(failure);
    }
    program::catch_panics(answer)
}

/// Hands a first word that is none of this program's to the program of its name, if there is one.
fn other_program() -> Option<ExitCode> {
    let mut arguments = std::env::args_os().skip(1);
    let word = arguments.next().filter(|word| hand_over::is_word(word))?.into_string().ok()?;
    let is_own = word == "help" || Arguments::command().find_subcommand(&word).is_some();
    let handed = !is_own && hand_over::answering(&word).is_some();
    handed.then(|| hand_over(&word, arguments).map_or_else(report, |()| ExitCode::SUCCESS))
}

/// Reads the command line and does what it asks for.
fn answer() -> ExitCode {
    if let Err(failure) = arguments::refuse_odd_characters(std::env::args_os()) {
        return report(failure);
    }
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(answer) => return other_program().unwrap_or_else(|| invocation::answered(answer)),
    };
    // Where the system takes no handler, what writes beyond the file size limit ends by a signal; no reason not to begin.
    let _ = report_file_size_limit();
    match perform(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => report(failure),
    }
}

/// Does what the command line asks for.
fn perform(arguments: Arguments) -> Result<(), Failure> {
    message::set_level(arguments.quiet, arguments.verbose);
    match arguments.command {
        Command::New(arguments) => new::new(&arguments),
        Command::Cycle(handed) => hand_over("cycle", handed.arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Plot(handed) => hand_over("plot", handed.arguments),
        Command::Report(handed) => hand_over("report", handed.arguments),
        Command::Watch(arguments) => watch::watch(&arguments),
        Command::Export(handed) => hand_over("export", handed.arguments),
        Command::Accuracy(arguments) => accuracy::accuracy(&arguments),
        Command::Sweep(command) => perform_sweep(command),
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

/// Does what `plateau sweep` asks for.
fn perform_sweep(command: SweepCommand) -> Result<(), Failure> {
    let answered =
        |word: &str, handed: HandedArguments| hand_over("sweep", std::iter::once(word.into()).chain(handed.arguments));
    match command {
        SweepCommand::Plan(arguments) => sweep::plan::plan(&arguments),
        SweepCommand::Run(arguments) => sweep::run::run(&arguments),
        SweepCommand::Scene(arguments) => sweep::run::scene(&arguments),
        SweepCommand::Slurm(arguments) => sweep::run::slurm(&arguments),
        SweepCommand::Collect(arguments) => sweep::collect::collect(&arguments),
        SweepCommand::Effects(handed) => answered("effects", handed),
        SweepCommand::Predict(handed) => answered("predict", handed),
        SweepCommand::Optimize(handed) => answered("optimize", handed),
        SweepCommand::Sensitivity(handed) => answered("sensitivity", handed),
        SweepCommand::Import(handed) => answered("import", handed),
    }
}
