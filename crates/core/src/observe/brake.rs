//! Series of the brake of whose pads the simulated pin is a piece: what the pin wears and emits, scaled to the pads.

use super::extra::Extra;
use super::sample::{Quantity, Sample};
use crate::model::brake::Brake;
use crate::model::mesh::Mesh;

/// With `[brake]`.
pub const PADS: Extra = Extra {
    name: "pads",
    quantities: &[Quantity::extra("pad_wear", "m", "thickness that the pads have lost, mean over their area")],
    request: None,
    needs: "a brake, table [brake]",
};

/// With `[brake]` and `[friction]`.
pub const BRAKE_TORQUE: Extra = Extra {
    name: "brake_torque",
    quantities: &[Quantity::extra("brake_torque", "N m", "braking torque of the whole brake")],
    request: None,
    needs: "a brake and a law of friction, tables [brake] and [friction]",
};

/// With `[brake]` and `[emission]`.
pub const BRAKE_EMISSION: Extra = Extra {
    name: "brake_emission",
    quantities: &[
        Quantity::extra(
            "brake_emitted_mass",
            "kg",
            "mass of the debris that left the whole brake: what pads and disc have lost",
        ),
        Quantity::extra("brake_pm10_mass", "kg", "mass of it that is airborne as PM10, of the whole brake"),
        Quantity::extra("brake_pm25_mass", "kg", "mass of it that is airborne as PM2.5, of the whole brake"),
        Quantity::extra("brake_particle_number", "1", "number of airborne particles of the whole brake"),
    ],
    request: None,
    needs: "a brake and airborne emission, tables [brake] and [emission]",
};

/// With `[brake]` and the speed on the road.
pub const PADS_ON_ROAD: Extra = Extra {
    name: "pads_on_road",
    quantities: &[
        Quantity::extra(
            "pad_wear_per_distance",
            "1",
            "thickness that the pads have lost over the distance of the vehicle",
        ),
        Quantity::extra("pad_life", "m", "distance of the vehicle after which the pads are worn down at that rate"),
    ],
    request: None,
    needs: "a brake and a cycle with the speed on the road, table [brake] and column road_speed",
};

/// With `[brake]`, `[emission]` and the speed on the road.
pub const EMISSION_ON_ROAD: Extra = Extra {
    name: "emission_on_road",
    quantities: &[
        Quantity::extra(
            "brake_emitted_per_distance",
            "kg m-1",
            "mass that the whole brake lost over the distance of the vehicle",
        ),
        Quantity::extra(
            "brake_pm10_per_distance",
            "kg m-1",
            "PM10 of the whole brake over the distance of the vehicle",
        ),
        Quantity::extra(
            "brake_pm25_per_distance",
            "kg m-1",
            "PM2.5 of the whole brake over the distance of the vehicle",
        ),
        Quantity::extra(
            "brake_particles_per_distance",
            "m-1",
            "particles of the whole brake over the distance of the vehicle",
        ),
    ],
    request: None,
    needs: "a brake, airborne emission and a cycle with the speed on the road, tables [brake] and [emission] and column road_speed",
};

/// All of them.
pub const OF_BRAKES: &[&Extra] = &[&PADS, &PADS_ON_ROAD, &BRAKE_TORQUE, &BRAKE_EMISSION, &EMISSION_ON_ROAD];

/// Adds the values of all of these to a sample of the pin of a mesh, which is pressed with a force (N) at a rotational speed (rad/s),
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
