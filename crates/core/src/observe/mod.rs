//! What a simulation reports: samples of its quantities and maps of its fields (model section 5).
//!
//! | file | what is in it |
//! |---|---|
//! | `sample.rs`, `quantity.rs` | what every run reports: the fields of a sample, and their names and units |
//! | `extra.rs` | what it takes to be a series that not every run has |
//! | `roughness.rs`, `pressure_spread.rs` | such series, on request |
//! | `operation.rs` | such series of runs with a cycle |
//! | `dissipation.rs` | such series of runs with friction, heat or emission |
//! | `event.rs` | what is reported of each event of a cycle |
//! | `map.rs` | fields that can be recorded as maps |
//! | `schedule.rs` | when samples and maps are due |
//! | `pulse.rs` | how long the contact area takes to rise and fall once |
//! | `window_mean.rs`, `drift.rs`, `running_in.rs` | what is made of series and maps afterwards |

pub mod dissipation;
pub mod drift;
pub mod event;
pub mod extra;
pub mod map;
pub mod operation;
pub mod pressure_spread;
pub mod pulse;
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
    &operation::CYCLE,
    &operation::ROAD,
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
