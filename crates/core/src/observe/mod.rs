//! Reports of a simulation: samples of its quantities and maps of its fields (model section 5).
//!
//! | file | what is in it |
//! |---|---|
//! | `sample.rs` | quantities of every run: the fields of a sample, and their names and units |
//! | `extra.rs` | series that not every run has: on request, or of runs with friction, heat, emission or a brake |
//! | `event.rs` | records of the events of a cycle |
//! | `map.rs` | fields that can be recorded as maps |
//! | `schedule.rs` | times at which samples and maps are due |
//! | `window_mean.rs`, `running_in.rs` | evaluation of series and maps afterwards |

pub mod event;
pub mod extra;
pub mod map;
pub mod running_in;
pub mod sample;
pub mod schedule;
pub mod window_mean;

pub use self::extra::{ACCELERATION, CYCLE, EXTRAS, ROAD, quantities, requested};
pub use self::map::{ABSENT, Map, MapValues, Snapshot};
pub use self::sample::{QUANTITIES, Quantity, Sample, TOTALS};
