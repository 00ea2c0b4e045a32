//! Benchmarks of a step: by instruction set and workers, by size of the mesh, and with optional parts on and off.

use std::time::{Duration, Instant};

use plateau_core::engine::kernel::InstructionSet;
use plateau_core::observe::Map;

use crate::case::{
    Case, DISC_WEAR, FASTER_DEBRIS, MeshSize, NO_DESTRUCTION, ONE_POOL, POOL_PER_TRACK, POOLED_FRACTION, SOFTER_DEBRIS,
};
use crate::document::{Benchmark, STRONG, WEAK};
use crate::error::BenchError;
use crate::race::{Entry, Runner, race};
use crate::session::{Options, Session, WorkerOptions};
use crate::stepper::{Setup, Stepper};

/// Times a step for every instruction set and number of workers.
pub fn kernel(options: WorkerOptions) -> Result<Session, BenchError> {
    let mut session = options.begin(Benchmark::Kernel)?;
    let case = session.source.case()?;
    let mut entries = Vec::new();
    for workers in &session.workers {
        for instructions in InstructionSet::available() {
            entries.push(entry(instructions.name(), session.mesh, &case, Setup { workers: *workers, instructions })?);
        }
    }
    session.document.measurements = race(entries, session.pace)?;
    Ok(session)
}

/// Times a step for every number of workers on meshes of several sizes.
///
/// Strong scaling: every number of workers on every mesh. Weak scaling: W workers on a mesh whose pin and ring have W
/// times the columns, so that every worker has as many cells as one has on the first mesh.
pub fn scaling(options: WorkerOptions) -> Result<Session, BenchError> {
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
    Ok(session)
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

/// Changes of a scene that switch one part on or off.
struct Variant {
    name: &'static str,
    sets: &'static [&'static str],
}

/// The first is what the others are compared with; it takes part twice, so that the difference of a scene from itself
/// shows what can be told apart.
const VARIANTS: &[Variant] = &[
    Variant { name: "the scene", sets: &[] },
    Variant { name: "the scene once more", sets: &[] },
    Variant { name: "no formation", sets: &["plateaus.formation=false"] },
    Variant { name: "no resin", sets: &["pin.base.uniform=primary"] },
    Variant { name: "wear of fibres alone", sets: &["plateaus.formation=false", "pin.base.uniform=primary"] },
    Variant { name: "exponential wear", sets: &["numerics.integrator=exponential"] },
    Variant { name: "one debris pool", sets: &[ONE_POOL, POOLED_FRACTION] },
    Variant { name: "one debris pool, no destruction", sets: &[ONE_POOL, POOLED_FRACTION, NO_DESTRUCTION] },
    Variant { name: "one debris pool per track", sets: &[POOL_PER_TRACK, POOLED_FRACTION] },
    Variant { name: "wear of the disc", sets: &[DISC_WEAR] },
    Variant { name: "materials of their own for build-ups", sets: &[SOFTER_DEBRIS, FASTER_DEBRIS] },
    Variant { name: "wear of the disc and such materials", sets: &[DISC_WEAR, SOFTER_DEBRIS, FASTER_DEBRIS] },
    Variant { name: "time acceleration 100", sets: &["numerics.time_acceleration=100"] },
];

/// Times a step with optional parts of the model and of the output on and off.
pub fn parts(options: Options) -> Result<Session, BenchError> {
    let mut session = options.begin(Benchmark::Parts)?;
    let setup = Setup::of(1);
    let mut entries = Vec::new();
    for Variant { name, sets } in VARIANTS {
        let source = session.source.with(sets.iter().map(|set| (*set).to_owned()));
        entries.push(entry(name, session.mesh, &source.case()?, setup)?);
    }
    let revolution = session.mesh.disc_columns as u64;
    let case = session.source.case()?;
    for (name, every, maps) in [
        ("a sample every revolution", revolution, false),
        ("a sample every step", 1, false),
        ("all maps every revolution", revolution, true),
    ] {
        let stepper = Stepper::new(&case, setup)?;
        let runner = Box::new(Observed { stepper, every, maps, steps: 0 });
        let instructions = setup.instructions.name().to_owned();
        entries.push(Entry { name: name.to_owned(), mesh: session.mesh, workers: 1, instructions, runner });
    }
    session.document.measurements = race(entries, session.pace)?;
    Ok(session)
}

/// A simulation that is looked at now and then.
struct Observed {
    stepper: Stepper,
    every: u64,
    maps: bool,
    steps: u64,
}

impl Runner for Observed {
    fn advance(&mut self, steps: u64) -> Result<Duration, BenchError> {
        let start = Instant::now();
        let end = self.steps + steps;
        while self.steps < end {
            let next = (self.steps / self.every + 1) * self.every;
            self.stepper.run(next.min(end) - self.steps)?;
            self.steps = next.min(end);
            if self.steps == next {
                std::hint::black_box(self.stepper.sample()?);
                if self.maps {
                    std::hint::black_box(self.stepper.snapshot(&Map::ALL)?);
                }
            }
        }
        Ok(start.elapsed())
    }

    fn load_evaluations_per_step(&self) -> Option<f64> {
        self.stepper.load_evaluations_per_step()
    }
}
