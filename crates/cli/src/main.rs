//! The program `plateau`.

mod accuracy;
mod arguments;
mod commands;
mod failure;
mod hand_over;
mod interrupt;
mod invocation;
mod message;
mod output;
mod scene;
mod screen;
mod startup;
mod summary;
mod table;
mod terminal;
mod version;
mod watch;

use std::process::ExitCode;

use clap::{CommandFactory as _, Parser};
use plateau_io::process::report_file_size_limit;

use failure::Failure;

fn main() -> ExitCode {
    startup::fit_environment();
    interrupt::Interrupt::pass_over_saves();
    if let Err(failure) = startup::refuse_little_memory() {
        return failure.report();
    }
    startup::catch_panics(perform)
}

/// Hands a first word that is none of this program's to the program of its name, if there is one.
fn other_program() -> Option<ExitCode> {
    let mut arguments = std::env::args_os().skip(1);
    let word = arguments.next().filter(|word| hand_over::is_word(word))?.into_string().ok()?;
    let is_own = word == "help" || arguments::Arguments::command().find_subcommand(&word).is_some();
    let handed = !is_own && hand_over::answering(&word).is_some();
    handed.then(|| hand_over::hand_over(&word, arguments).map_or_else(Failure::report, |()| ExitCode::SUCCESS))
}

/// Does what the command line asks for.
fn perform() -> ExitCode {
    if let Err(failure) = arguments::refuse_odd_characters(std::env::args_os()) {
        return failure.report();
    }
    let arguments = match arguments::Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(answer) => return other_program().unwrap_or_else(|| invocation::answered(answer)),
    };
    // Where the system takes no handler, what writes beyond the file size limit ends by a signal; no reason not to begin.
    let _ = report_file_size_limit();
    match commands::perform(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
