//! The paper's case: prints how the contact area grows while the pin wears in. `cargo run --release --example paper -p plateau-core`.

use std::error::Error;

use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::Simulation;

fn main() -> Result<(), Box<dyn Error>> {
    // One simulated revolution stands for a hundred.
    let parameters = Parameters { time_acceleration: 100.0, ..Parameters::paper() };
    let revolution = parameters.mesh.disc_columns() as u64;
    let surfaces = InitialSurfaces::like_the_papers(&parameters.mesh)?;
    let mut simulation = Simulation::new(parameters, surfaces)?;
    while simulation.time() < 60.0 {
        simulation.advance_to(simulation.steps_done() + revolution)?;
        let sample = simulation.sample()?;
        println!("{:5.1} s  {:6.3} mm2", sample.time, sample.contact_area_mean * 1e6);
    }
    Ok(())
}
