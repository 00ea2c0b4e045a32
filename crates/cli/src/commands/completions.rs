//! `plateau completions`: scripts with which shells complete the command line.

use clap::CommandFactory;

use crate::arguments::{Arguments, CompletionsArguments};
use crate::failure::Failure;
use crate::table;

/// Prints the script of a shell.
pub fn completions(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "plateau", &mut script);
    table::print(&String::from_utf8_lossy(&script))
}
