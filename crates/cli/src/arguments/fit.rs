//! The command line of `plateau fit`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `plateau fit`.
#[derive(Debug, Args)]
pub struct FitArguments {
    /// Study file (TOML) with measured values in its responses
    pub study: PathBuf,
    /// Say what is fitted to what and what it will cost, without running any
    #[arg(long)]
    pub plan: bool,
    /// Runs at a time; as many as there are cores for their workers unless given
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub jobs: Option<u32>,
    /// Threads of each run
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "1", value_parser = clap::value_parser!(u32).range(1..))]
    pub workers: u32,
    /// Make runs again that failed before
    #[arg(long)]
    pub retry: bool,
    /// Folder for tables and figures; "fit" in the study's own unless given
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}
