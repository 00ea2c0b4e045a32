//! How the cores of a machine are shared among the runs of a study.

use clap::{Arg, Args};
use plateau_run::execution::cores;

/// Runs at a time and threads of each.
#[derive(Debug, Args)]
pub struct CoresArguments {
    /// Runs at a time; as many as there are cores for their workers unless given
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub jobs: Option<u32>,
    /// Threads of each run
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "1", value_parser = clap::value_parser!(u32).range(1..))]
    pub workers: u32,
}

impl CoresArguments {
    /// For a command that makes runs only to confirm what it says: without `--confirm` they would do nothing.
    pub(super) fn for_confirming(argument: Arg) -> Arg {
        match argument.get_id().as_str() {
            "jobs" | "workers" => argument.requires("confirm"),
            _ => argument,
        }
    }

    /// Runs at a time: as many as are asked for, else as there are cores for their workers.
    pub fn runs_at_a_time(&self) -> usize {
        self.jobs.map_or_else(|| (cores() / self.workers()).max(1), |jobs| jobs as usize)
    }

    /// Threads of each run.
    pub fn workers(&self) -> usize {
        self.workers as usize
    }
}
