//! The command lines of the commands that show, check, mend and export run files.

use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `plateau report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// Run files, also of runs that go on or were stopped; at most 8, of which the others are compared with the first
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Page to write; named like the run file, or "report.html" for several, unless given
    #[arg(short, long, value_name = "HTML")]
    pub output: Option<PathBuf>,
    /// Replace the page if it exists
    #[arg(long)]
    pub force: bool,
}

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

/// Arguments of `plateau export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Run file, also of a run that goes on or was stopped
    pub run: PathBuf,
    /// Format of the files
    #[arg(long, value_name = "FORMAT", alias = "format")]
    pub to: ExportFormat,
    /// File to write, for vtk the folder, made if it is not there; named like the run file unless given
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Write the maps too; for csv, as the other formats have them anyway
    #[arg(long)]
    pub maps: bool,
    /// Replace files that exist
    #[arg(long)]
    pub force: bool,
}

/// A format of other programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ExportFormat {
    /// Comma-separated values: the series; with --maps the maps
    Csv,
    /// NumPy archive: series and maps as arrays
    Npz,
    /// ParaView: maps on the cells of ring and pin, as a time series
    Vtk,
}
