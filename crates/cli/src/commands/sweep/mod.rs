//! `plateau sweep`: studies of many runs.

mod collect;
mod plan;
mod run;
mod slurm;

use crate::arguments::{HandedArguments, SweepCommand};
use crate::failure::Failure;
use crate::hand_over::hand_over;

/// Does what the command line asks for.
pub fn sweep(command: SweepCommand) -> Result<(), Failure> {
    let answered =
        |word: &str, handed: HandedArguments| hand_over("sweep", std::iter::once(word.into()).chain(handed.arguments));
    match command {
        SweepCommand::Plan(arguments) => plan::plan(&arguments),
        SweepCommand::Run(arguments) => run::run(&arguments),
        SweepCommand::Slurm(arguments) => slurm::slurm(&arguments),
        SweepCommand::Collect(arguments) => collect::collect(&arguments),
        SweepCommand::Effects(handed) => answered("effects", handed),
        SweepCommand::Predict(handed) => answered("predict", handed),
        SweepCommand::Optimize(handed) => answered("optimize", handed),
        SweepCommand::Sensitivity(handed) => answered("sensitivity", handed),
        SweepCommand::Import(handed) => answered("import", handed),
    }
}
