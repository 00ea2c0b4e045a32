//! What a simulation reports: samples of its quantities and maps of its fields (model section 5).
//!
//! | file | what is in it |
//! |---|---|
//! | `sample.rs`, `quantity.rs` | what every run reports: the fields of a sample, and their names and units |
//! | `extra.rs` | what it takes to be a series that not every run has |
//! | `roughness.rs`, `pressure_spread.rs` | such series, on request |
//! | `dissipation.rs` | such series of runs with friction, heat or emission |
//! | `event.rs` | what is reported of each event of a cycle |
//! | `map.rs` | fields that can be recorded as maps |
//! | `schedule.rs` | when samples and maps are due |
//! | `window_mean.rs`, `drift.rs`, `running_in.rs` | what is made of series and maps afterwards |

pub mod dissipation;
pub mod drift;
pub mod event;
pub mod extra;
pub mod map;
pub mod pressure_spread;
pub mod quantity;
pub mod roughness;
pub mod running_in;
pub mod sample;
pub mod schedule;
pub mod window_mean;

use self::extra::Extra;
pub use self::map::{ABSENT, Map, MapValues, Snapshot};
pub use self::quantity::{QUANTITIES, Quantity, TOTALS};
pub use self::sample::Sample;

/// The table of series that not every run has, in the order of a run file. Scenes (`output.NAME`), run files, exports,
/// figures and documents follow from its entries.
pub const EXTRAS: &[&Extra] = &[
    &roughness::EXTRA,
    &pressure_spread::EXTRA,
    &dissipation::CONTACT_TEMPERATURE,
    &ACCELERATION,
    &CYCLE,
    &ROAD,
    &dissipation::FRICTION,
    &dissipation::HEAT,
    &dissipation::EMISSION,
];

/// The acceleration at the end of a step, in a run that chooses it.
pub const ACCELERATION: Extra = Extra {
    name: "acceleration",
    quantities: &[
        Quantity::extra("time_acceleration", "1", "revolutions that one simulated revolution stands for"),
        Quantity::extra(
            "acceleration_error",
            "1",
            "estimate of the relative error of the contact area that the time acceleration causes",
        ),
    ],
    request: None,
    needs: "a time acceleration that the run chooses, numerics.time_acceleration = { tolerance = 0.01, max = 1000 }",
};

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

/// The series on request: those whose switch, by its name, is on.
pub fn requested<E>(is_on: impl Fn(&str) -> Result<bool, E>) -> Result<Vec<&'static Extra>, E> {
    let mut extras = Vec::new();
    for extra in EXTRAS.iter().copied().filter(|extra| extra.request.is_some()) {
        if is_on(extra.name)? {
            extras.push(extra);
        }
    }
    Ok(extras)
}

/// The series of a run file but the time, with these besides those of every run.
pub fn quantities(extras: &[&Extra]) -> impl Iterator<Item = &'static Quantity> {
    QUANTITIES.iter().chain(extras.iter().flat_map(|extra| extra.quantities))
}
