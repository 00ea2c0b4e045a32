//! The command lines of the commands that show, check and mend run files.

use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::Args;

/// Arguments of `plateau watch`.
#[derive(Debug, Args)]
pub struct WatchArguments {
    /// Run file, which need not be there yet
    pub run: PathBuf,
    /// Print the state once and end
    #[arg(long)]
    pub once: bool,
    /// Give up after so many seconds without a new sample; unless given, after 10 s without a file, else never
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = seconds)]
    pub timeout: Option<u64>,
}

/// A value of `--timeout`.
fn seconds(text: &str) -> Result<u64, &'static str> {
    text.parse::<NonZeroU64>().map(NonZeroU64::get).map_err(|_| "expected whole seconds, at least 1")
}

/// Arguments of `plateau verify`.
#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// Run files
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Print one JSON document instead of text: an array with an object for each file
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `plateau repair`.
#[derive(Debug, Args)]
pub struct RepairArguments {
    /// Run files
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Repair also what another machine has written a moment ago, or what another user may still be writing
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `plateau summary`.
#[derive(Debug, Args)]
pub struct SummaryArguments {
    /// Run file, also of a run that goes on or was stopped
    pub run: PathBuf,
    /// Print JSON, as it does anyway
    #[arg(long)]
    pub json: bool,
}
