//! The program `extremes`.

use std::process::ExitCode;

use clap::Parser;
use plateau_bench::extremes::Arguments;

fn main() -> ExitCode {
    match Arguments::parse().perform() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("extremes: {error}");
            ExitCode::FAILURE
        }
    }
}
