//! The program `plateau-bench`.

use std::process::ExitCode;

use clap::Parser;
use plateau_bench::arguments::Arguments;

fn main() -> ExitCode {
    match Arguments::parse().perform() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("plateau-bench: {error}");
            ExitCode::FAILURE
        }
    }
}
