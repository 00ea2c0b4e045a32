//! The program `plateau`.

mod arguments;
mod commands;
mod drive;
mod failure;
mod machine;
mod number;
mod progress;
mod table;
mod version;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    match commands::perform(arguments::Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
