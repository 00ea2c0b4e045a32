//! The command line of `plateau fit`.

use std::path::PathBuf;

use clap::Args;

use super::cores::CoresArguments;

/// Arguments of `plateau fit`.
#[derive(Debug, Args)]
pub struct FitArguments {
    /// Study file (TOML) with measured values in its responses
    pub study: PathBuf,
    /// Say what is fitted to what and what it will cost, without running any
    #[arg(long)]
    pub plan: bool,
    #[command(flatten)]
    pub cores: CoresArguments,
    /// Make runs again that failed before
    #[arg(long)]
    pub retry: bool,
    /// Folder for tables and figures; "fit" in the study's own unless given
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace files in that folder that are of another study, of another command or of somebody else
    #[arg(long)]
    pub force: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}
