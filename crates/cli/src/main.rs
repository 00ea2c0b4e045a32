//! The program `plateau`.

mod accuracy;
mod answer;
mod arguments;
mod called;
mod commands;
mod environment;
mod excerpt;
mod failure;
mod interrupt;
mod little_memory;
mod message;
mod output;
mod output_folder;
mod panic;
mod progress;
mod screen;
mod summary;
mod sweep;
mod table;
mod terminal;
mod version;

use std::process::ExitCode;

use clap::Parser;
use plateau_io::number;
use plateau_io::process::report_file_size_limit;
use plateau_present::csv_table;
use plateau_run::machine;

fn main() -> ExitCode {
    environment::fit();
    interrupt::Interrupt::pass_over_saves();
    if let Err(failure) = little_memory::begin() {
        return failure.report();
    }
    panic::told(answer)
}

/// Does what the command line asks for.
fn answer() -> ExitCode {
    if let Err(failure) = arguments::refuse_odd_characters(std::env::args_os()) {
        return failure.report();
    }
    let arguments = match arguments::Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(answer) => return answer::answered(answer),
    };
    // Where the system takes no handler, what writes beyond the file size limit ends by a signal; no reason not to begin.
    let _ = report_file_size_limit();
    match commands::perform(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
