//! How exact a scene's runs are for their time: a ladder of runs held against a reference.
//!
//! | what | where |
//! |---|---|
//! | the numerics that a ladder changes, and its rungs | `ladder` |
//! | surfaces on a coarser mesh | `coarsening` |
//! | how runs are made and measured, and how long they take | `runs` |
//! | which runs fit into a budget, and which is the reference | `plan` |
//! | the runs of a plan, one after the other | [`search()`] |
//! | windows of physical time, what is kept of a run's course | `history` |
//! | what is kept of a run, held against the reference | `comparison` |
//! | a reference, made or read | `reference` |
//! | order of convergence | `order` |
//! | which runs are worth their time, and when that can be told | `choice` |
//! | all that was found | [`Report`] |
//! | why nothing was | [`AccuracyError`] |

mod choice;
mod coarsening;
mod comparison;
mod error;
mod history;
mod ladder;
mod order;
mod plan;
mod reference;
mod report;
mod runs;
mod search;

pub use choice::{Advice, judge};
pub use error::{AccuracyError, PlanError, ReferenceError, Unfinished};
pub use ladder::{Ladder, integrator_name};
pub use reference::{OwnError, ReadReference, read as read_reference};
pub use report::{Measured, Report, Row};
pub use search::{Found, Wish, search};
