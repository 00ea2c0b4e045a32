//! The program `plateau`.

mod accuracy;
mod arguments;
mod commands;
mod drive;
mod execution;
mod failure;
mod interrupt;
mod job;
mod keeper;
mod machine;
mod message;
mod output;
mod progress;
mod resume;
mod screen;
mod stability;
mod summary;
mod sweep;
mod table;
mod version;

use std::process::ExitCode;

use clap::Parser;
use plateau_present::{csv_table, number};

fn main() -> ExitCode {
    failure::end_where_memory_does();
    let arguments = match arguments::Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(answer) => return failure::answer(answer),
    };
    match commands::perform(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
