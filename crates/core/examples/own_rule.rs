//! A rule of your own: the model as it is read, with resin that swells back a little in every step, as if it took up water.
//! `cargo run --release --example own_rule -p plateau-core`.

use std::error::Error;

use plateau_core::model::State;
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::model::step::advance;

/// What resin swells in a step, m.
const SWELLING: f64 = 2e-9;

fn main() -> Result<(), Box<dyn Error>> {
    // A smaller ring, for this model is slow; as much pressure as on the paper's.
    let paper = Parameters::paper();
    let mesh = Mesh::new(16, 690, 40, 21e-3, 21.8e-3)?;
    let normal_force = paper.normal_force * mesh.pin_area() / paper.mesh.pin_area();
    let parameters = Parameters { mesh, normal_force, time_acceleration: 100.0, ..paper };
    let surfaces = InitialSurfaces::like_the_papers(&parameters.mesh)?;
    let mut state = State::new(&parameters, surfaces);
    for step in 1..=20 * 690 {
        let done = advance(&parameters, &mut state)?;
        // The rule: resin that does not touch comes up. z of the pin grows away from the disc.
        let resin = (0..state.pin.height.len()).filter(|cell| state.pin.base[*cell].is_resin() && !done.contact[*cell]);
        for cell in resin.collect::<Vec<_>>() {
            state.pin.height[cell] -= SWELLING;
            state.pin.substrate[cell] -= SWELLING;
        }
        if step % 690 == 0 {
            let touching = done.contact.iter().filter(|touches| **touches).count();
            println!("{:3} revolutions: {touching} of {} cells touch", step / 690, done.contact.len());
        }
    }
    Ok(())
}
