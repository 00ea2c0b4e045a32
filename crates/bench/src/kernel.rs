//! One step by instruction set and number of workers.

use plateau_core::engine::kernel::InstructionSet;

use crate::case::{Case, MeshSize};
use crate::document::Benchmark;
use crate::error::BenchError;
use crate::race::{Entry, race};
use crate::session::WorkerOptions;
use crate::stepper::{Setup, Stepper};

/// Measures and reports.
pub fn kernel(options: WorkerOptions) -> Result<(), BenchError> {
    let mut session = options.begin(Benchmark::Kernel)?;
    let case = session.source.case()?;
    let mut entries = Vec::new();
    for workers in &session.workers {
        for instructions in InstructionSet::available() {
            entries.push(entry(instructions.name(), session.mesh, &case, Setup { workers: *workers, instructions })?);
        }
    }
    session.document.measurements = race(entries, session.pace)?;
    session.finish()
}

/// A simulation that takes part in a race.
pub fn entry(name: &str, mesh: MeshSize, case: &Case, setup: Setup) -> Result<Entry, BenchError> {
    Ok(Entry {
        name: name.to_owned(),
        mesh,
        workers: setup.workers,
        instructions: setup.instructions.name().to_owned(),
        runner: Box::new(Stepper::new(case, setup)?),
    })
}
