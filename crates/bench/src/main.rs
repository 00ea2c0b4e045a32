//! The program `plateau-bench`: how long a step of the model takes, and why.
//!
//! ```text
//! kernel, scaling, parts, roofline, peers   one benchmark each: what is set against what
//! case       scene -> parameters and surfaces, on meshes of several sizes
//! stepper    a simulation as something that can be timed: the only calls of core's time loop
//! race       times several things in turn
//! bandwidth  what the caches and the memory give          traffic    what a step must move
//! document   results as JSON                              tables     the tables made from them
//! ```

mod arguments;
mod bandwidth;
mod build;
mod case;
mod document;
mod error;
mod kernel;
mod machine;
mod parts;
mod peer;
mod peers;
mod race;
mod report;
mod roofline;
mod scaling;
mod session;
mod stepper;
mod table;
mod tables;
mod traffic;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    match arguments::Arguments::parse().perform() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("plateau-bench: {error}");
            ExitCode::FAILURE
        }
    }
}
