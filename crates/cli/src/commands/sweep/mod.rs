//! `plateau sweep`: studies of many runs.

mod analysed;
mod collect;
mod effects;
mod effects_document;
mod effects_files;
mod import;
mod optimize;
mod optimize_limits;
mod optimize_search;
mod plan;
mod predict;
mod prediction_table;
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
        SweepCommand::Predict(arguments) => predict::predict(&arguments),
        SweepCommand::Optimize(arguments) => optimize::optimize(&arguments),
        SweepCommand::Import(arguments) => import::import(&arguments),
    }
}
