//! What a step must move against what caches and memory give.

use crate::bandwidth::{Effort, bandwidth, places};
use crate::document::{Benchmark, StepTraffic};
use crate::error::BenchError;
use crate::kernel::entry;
use crate::race::race;
use crate::session::WorkerOptions;
use crate::stepper::Setup;
use crate::traffic::step_traffic;

/// Measures and reports.
pub fn roofline(options: WorkerOptions) -> Result<(), BenchError> {
    let mut session = options.begin(Benchmark::Roofline)?;
    let effort = Effort { repeats: session.pace.repeats, block: session.pace.block / 10 };
    let cores = session.document.machine.cores;
    let threads = if cores > 1 { vec![1, cores] } else { vec![1] };
    for threads in threads {
        for (place, bytes) in places(&session.document.machine, threads) {
            // A look does not need the slowest place in full.
            let bytes = if session.quick { bytes.min(1 << 20) } else { bytes };
            eprintln!("bandwidth: {place}, threads: {threads}");
            session.document.bandwidths.push(bandwidth(place, bytes, threads, effort));
        }
    }

    let mut entries = Vec::new();
    let mut traffic = Vec::new();
    for mesh in session.meshes() {
        let case = session.source.on(mesh)?.case()?;
        for workers in &session.workers {
            traffic.push(step_traffic(&case.parameters));
            entries.push(entry("step", mesh, &case, Setup::of(*workers))?);
        }
    }
    session.document.measurements = race(entries, session.pace)?;
    for (step, traffic) in session.document.measurements.iter().zip(traffic) {
        let working_set_bytes = traffic.held as usize;
        eprintln!("bandwidth: working set of {}, threads: {}", step.mesh, step.workers);
        let roof = bandwidth(step.mesh.to_string(), working_set_bytes / step.workers, step.workers, effort);
        let microseconds_per_step = step.microseconds_per_step.median;
        let moved = (traffic.read + traffic.written) / (microseconds_per_step * 1e3);
        session.document.traffic.push(StepTraffic {
            mesh: step.mesh,
            workers: step.workers,
            read_bytes: traffic.read,
            written_bytes: traffic.written,
            working_set_bytes,
            microseconds_per_step,
            moved,
            bandwidth: roof.update.median,
            fraction: moved / roof.update.median,
        });
        session.document.bandwidths.push(roof);
    }
    session.finish()
}
