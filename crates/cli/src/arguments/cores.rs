//! How the cores of a machine are shared among the runs of a study.

use clap::Args;
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
    /// Runs at a time: as many as are asked for, else as there are cores for their workers.
    pub fn runs_at_a_time(&self) -> usize {
        self.jobs.map_or_else(|| (cores() / self.workers()).max(1), |jobs| jobs as usize)
    }

    /// Threads of each run.
    pub fn workers(&self) -> usize {
        self.workers as usize
    }
}
