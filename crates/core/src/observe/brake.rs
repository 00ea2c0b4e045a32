//! Series of the brake of whose pads the simulated pin is a piece: what the pin wears and emits, scaled to the pads.

use super::extra::{BRAKE_EMISSION, BRAKE_TORQUE, EMISSION_ON_ROAD, PADS, PADS_ON_ROAD};
use super::sample::Sample;
use crate::model::brake::Brake;
use crate::model::mesh::Mesh;

/// Adds the values of the series of a brake to a sample of the pin of a mesh, which is pressed with a force (N) at a rotational speed (rad/s),
/// and whose vehicle has come a distance (m). What the scene does not have is NaN, as is the torque that holds a disc at rest.
pub fn record(brake: &Brake, mesh: &Mesh, [force, speed]: [f64; 2], distance: f64, sample: &mut Sample) {
    let pad_wear = sample.lost_pin() / mesh.pin_area();
    let per_distance = |total: f64| total / distance;
    PADS.record(sample, [pad_wear]);
    PADS_ON_ROAD.record(sample, [per_distance(pad_wear), brake.pad_thickness / per_distance(pad_wear)]);
    if let Some(friction) = sample.accounts.friction {
        let friction_force = match (force, speed) {
            // Where nothing presses, there is no coefficient.
            (0.0, _) => 0.0,
            (_, 0.0) => f64::NAN,
            _ => friction.coefficient * force,
        };
        BRAKE_TORQUE.record(sample, [brake.torque(friction_force, mesh)]);
    }
    if let Some(emission) = sample.accounts.emission {
        let of_brake =
            [emission.mass, emission.pm10, emission.pm25, emission.number].map(|of_pin| of_pin / brake.share(mesh));
        BRAKE_EMISSION.record(sample, of_brake);
        EMISSION_ON_ROAD.record(sample, of_brake.map(per_distance));
    }
}
