//! The command line.

use clap::{Parser, Subcommand};

use crate::costs::{CostOptions, costs};
use crate::error::BenchError;
use crate::peers::peers;
use crate::report::{ReportOptions, give_out, report};
use crate::session::{Options, WorkerOptions};
use crate::steps::{kernel, parts, scaling};

/// How long a step of Plateau takes, and why.
#[derive(Debug, Parser)]
#[command(name = "plateau-bench", version, max_term_width = 100, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Time a step for every instruction set and number of workers
    #[command(after_help = "Example:\n  plateau-bench kernel --json kernel.json")]
    Kernel(WorkerOptions),
    /// Time a step for every number of workers on meshes from the scene's to a full pad
    #[command(after_help = "Example:\n  plateau-bench scaling --workers 1,2 --json scaling.json")]
    Scaling(WorkerOptions),
    /// Time a step with optional parts of the model and of the output on and off
    #[command(after_help = "Example:\n  plateau-bench parts --json parts.json")]
    Parts(Options),
    /// Run the program with optional parts and outputs on and off: time, memory and size of the run file
    #[command(after_help = "Example:\n  plateau-bench costs --json costs.json")]
    Costs(CostOptions),
    /// Time the same step written in Python, as loops that Numba compiles
    #[command(
        after_help = "Installs Numba into .venv-peers in the checkout.\n\nExample:\n  plateau-bench peers --json peers.json"
    )]
    Peers(Options),
    /// Make Markdown tables from results
    #[command(after_help = "Example:\n  plateau-bench report --into docs/performance.md kernel.json scaling.json")]
    Report(ReportOptions),
}

impl Arguments {
    /// Does what is asked for.
    pub fn perform(self) -> Result<(), BenchError> {
        let session = match self.command {
            Command::Kernel(options) => kernel(options)?,
            Command::Scaling(options) => scaling(options)?,
            Command::Parts(options) => parts(options)?,
            Command::Peers(options) => peers(options)?,
            Command::Costs(options) => {
                let json = options.json.clone();
                return give_out(&costs(options)?, json.as_deref());
            }
            Command::Report(options) => return report(&options),
        };
        give_out(&session.document, session.json.as_deref())
    }
}
