//! `plateau sweep`: studies of many runs.

mod collect;
mod effects;
mod effects_files;
mod plan;
mod run;
mod sensitivity;
mod sensitivity_document;
mod slurm;

use crate::arguments::SweepCommand;
use crate::failure::Failure;

/// Does what the command line asks for.
pub fn sweep(command: SweepCommand) -> Result<(), Failure> {
    match command {
        SweepCommand::Plan(arguments) => plan::plan(&arguments),
        SweepCommand::Run(arguments) => run::run(&arguments),
        SweepCommand::Slurm(arguments) => slurm::slurm(&arguments),
        SweepCommand::Collect(arguments) => collect::collect(&arguments),
        SweepCommand::Effects(arguments) => effects::effects(&arguments),
        SweepCommand::Sensitivity(arguments) => sensitivity::sensitivity(&arguments),
    }
}
