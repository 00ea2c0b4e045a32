//! Runs a scene without any file and keeps only the largest contact area that was sampled.
//! `cargo run --release -p plateau-run --example no_file -- data/scenes/quick.toml`.

use std::error::Error;

use plateau_core::observe::Sample;
use plateau_core::simulation::{Execution, SimulationError};
use plateau_io::{scene, surface};
use plateau_run::{Assembly, Sink};

/// The sample with the largest contact area.
#[derive(Default)]
struct Largest(Sample);

impl Sink for Largest {
    type Error = SimulationError;

    fn sample(&mut self, sample: Sample) -> Result<(), SimulationError> {
        if sample.contact_area > self.0.contact_area {
            self.0 = sample;
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "data/scenes/quick.toml".into());
    let scene = scene::load(path.as_ref(), &[])?;
    let surfaces = surface::load(&scene)?.surfaces;
    let mut assembly = Assembly::new(&scene, surfaces, Execution::default())?;
    let mut largest = Largest::default();
    assembly.run_to_end(&mut largest)?;
    println!("{:.3} mm2 touched at {:.3} s", largest.0.contact_area * 1e6, largest.0.time);
    Ok(())
}
