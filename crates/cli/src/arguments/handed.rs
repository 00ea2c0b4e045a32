//! Arguments of words that another program answers.

use std::ffi::OsString;

use clap::Args;

/// Arguments that are handed over as they are; `--help` among them tells what they may be.
#[derive(Debug, Args)]
pub struct HandedArguments {
    /// What the answering program takes; --help tells
    #[arg(value_name = "ARGUMENTS", trailing_var_arg = true, allow_hyphen_values = true)]
    pub arguments: Vec<OsString>,
}
