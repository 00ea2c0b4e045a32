//! How exact a scene's runs are for their time: a ladder of runs held against a reference.
//!
//! | what | where |
//! |---|---|
//! | the numerics that a ladder changes, and its rungs | [`ladder`] |
//! | surfaces on a coarser mesh | `coarsening` |
//! | how runs are made and measured, and how long they take | `runs` |
//! | which runs fit into a budget, and which is the reference | `plan` |
//! | the runs of a plan, one after the other | [`search()`] |
//! | windows of physical time, what is kept of a run's course | [`history`] |
//! | what is kept of a run, held against the reference | [`comparison`] |
//! | a reference, made or read | [`mod@reference`] |
//! | order of convergence | `order` |
//! | which runs are worth their time, and when that can be told | [`choice`] |
//! | all that was found | [`report`] |
//! | why nothing was | [`AccuracyError`] |

pub mod choice;
mod coarsening;
pub mod comparison;
mod error;
pub mod history;
pub mod ladder;
mod order;
mod plan;
pub mod reference;
pub mod report;
mod runs;
mod search;

pub use error::{AccuracyError, PlanError, ReferenceError};
pub use ladder::Ladder;
pub use reference::ReadReference;
pub use report::{Report, Row};
pub use runs::Unfinished;
pub use search::{Found, Wish, search};
