//! The program `plateau`.

mod accuracy;
mod arguments;
mod commands;
mod csv_table;
mod deflate;
mod drive;
mod execution;
mod failure;
mod figure;
mod interrupt;
mod job;
mod keeper;
mod label;
mod machine;
mod message;
mod number;
mod output;
mod progress;
mod report;
mod resume;
mod stability;
mod summary;
mod sweep;
mod table;
mod version;
mod watch;

use std::process::ExitCode;

use clap::Parser;

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
