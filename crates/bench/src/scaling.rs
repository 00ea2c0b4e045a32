//! Number of workers against size of the mesh.

use crate::document::Benchmark;
use crate::error::BenchError;
use crate::kernel::entry;
use crate::race::race;
use crate::session::WorkerOptions;
use crate::stepper::Setup;

/// Name of what is measured on meshes that do not depend on the number of workers.
pub const STRONG: &str = "strong";
/// Name of what is measured on meshes that are longer the more workers there are.
pub const WEAK: &str = "weak";

/// Measures and reports.
///
/// Strong scaling: every number of workers on every mesh. Weak scaling: W workers on a mesh whose pin and ring have W
/// times the columns, so that every worker has as many cells as one has on the first mesh.
pub fn scaling(options: WorkerOptions) -> Result<(), BenchError> {
    let mut session = options.begin(Benchmark::Scaling)?;
    let mut entries = Vec::new();
    for mesh in session.meshes() {
        let case = session.source.on(mesh)?.case()?;
        for workers in &session.workers {
            entries.push(entry(STRONG, mesh, &case, Setup::of(*workers))?);
        }
    }
    for workers in session.workers.iter().filter(|workers| **workers > 1) {
        let mesh = session.mesh.longer(*workers);
        entries.push(entry(WEAK, mesh, &session.source.on(mesh)?.case()?, Setup::of(*workers))?);
    }
    session.document.measurements = race(entries, session.pace)?;
    session.finish()
}
