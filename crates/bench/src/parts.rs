//! What the optional parts of the model and of the output cost.

use std::time::{Duration, Instant};

use plateau_core::observe::Map;

use crate::document::Benchmark;
use crate::error::BenchError;
use crate::kernel::entry;
use crate::race::{Entry, Runner, race};
use crate::session::Options;
use crate::stepper::{Setup, Stepper};

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

/// All debris of the contact in one pool, which needs a captured fraction.
pub const ONE_POOL: &str = "plateaus.debris=contact";
/// A pool for each track, which needs one too.
pub const POOL_PER_TRACK: &str = "plateaus.debris=track";
/// The captured fraction of the pooled baseline.
pub const POOLED_FRACTION: &str = "plateaus.captured_fraction=0.06";
/// No plateau falls for want of support, which with local debris none does anyway.
pub const NO_DESTRUCTION: &str = "plateaus.destruction=false";
/// A hundredth of the wear rate of the pin.
pub const DISC_WEAR: &str = "materials.disc_primary.specific_wear_rate=\"5e-16 1/Pa\"";
/// Half the modulus of the fibres.
pub const SOFTER_DEBRIS: &str = "materials.pin_secondary.youngs_modulus=\"5e8 Pa\"";
/// Twice the wear rate of the fibres.
pub const FASTER_DEBRIS: &str = "materials.pin_secondary.specific_wear_rate=\"1e-13 1/Pa\"";

/// Measures and reports.
pub fn parts(options: Options) -> Result<(), BenchError> {
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
    session.finish()
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
