//! Accuracy of a scene's runs against their run time: a ladder of runs compared with one reference.
//!
//! | what | where |
//! |---|---|
//! | quantities, their course over windows of physical time, and its errors | `quantity` |
//! | runs that are a scene with some keys set, or half and twice as long cells | `ladder` |
//! | one run, taken and timed; a reference, made or read | `reference` |
//! | the reference and all runs within a budget, one after the other | [`measure()`] |
//! | all that was found, and what is advised | [`Report`] |
//! | why nothing was | [`AccuracyError`] |

mod error;
mod ladder;
mod measure;
mod quantity;
mod reference;
mod report;

pub use error::{AccuracyError, PlanError, ReferenceError, Unfinished};
pub use ladder::{Base, Ladder, Rung};
pub use measure::{Wish, measure};
pub use quantity::{COMPARED, Compared, QuantityError};
pub use reference::{Reference, read as read_reference};
pub use report::{Advice, Measured, OwnError, Report, Row};
