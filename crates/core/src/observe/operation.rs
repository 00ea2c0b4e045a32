//! Series of the operation, in runs whose load or speed is given as a cycle (model 9).

use super::extra::Extra;
use super::quantity::Quantity;

/// Load, speed and the time in contact; [`Cycle::operation_at`](crate::model::cycle::Cycle::operation_at) and
/// [`Cycle::contact_time_until`](crate::model::cycle::Cycle::contact_time_until) give their values.
pub const CYCLE: Extra = Extra {
    name: "cycle",
    quantities: &[
        Quantity::extra("normal_force", "N", "normal force on the simulated pin in the step, mean over its angle"),
        Quantity::extra("rotational_speed", "rad s-1", "rotational speed of the disc at the end of the step"),
        Quantity::extra("contact_time", "s", "time since the first step in which the pin was not lifted"),
    ],
    request: None,
    needs: "a cycle, table [operation.cycle]",
};

/// How far the vehicle has come, where its speed is given.
pub const ROAD: Extra = Extra {
    name: "road",
    quantities: &[Quantity::extra("road_distance", "m", "distance that the vehicle has travelled")],
    request: None,
    needs: "a cycle with the speed on the road, column road_speed",
};
