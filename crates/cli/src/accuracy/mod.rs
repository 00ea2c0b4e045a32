//! Error against run time: a scene is run along ladders, and every run is held against a reference.
//!
//! | what | where |
//! |---|---|
//! | the numerics that a ladder changes | [`numerics`] |
//! | the rungs of every ladder | [`ladder`] |
//! | surfaces on a coarser mesh | [`coarsening`], [`overlap`] |
//! | how runs are made, and how long they take | [`runs`], [`mod@measure`] |
//! | which runs fit into a budget, and which is the reference | [`mod@plan`] |
//! | the runs of a plan, one after the other | [`mod@search`] |
//! | what is kept of a run | [`outcome`], [`history`] |
//! | a reference, made or read | [`mod@reference`] |
//! | windows of physical time | [`windows`] |
//! | a run held against the reference | [`comparison`] |
//! | order of convergence | [`order`] |
//! | which runs are worth their time, and when that can be told | [`choice`], in sentences [`mod@advice`] |
//! | all that was found | [`report`], its numbers in [`columns`] |
//! | as text, CSV and JSON | [`mod@text`], [`documents`] |

mod advice;
mod choice;
mod coarsening;
mod columns;
mod comparison;
mod documents;
mod history;
mod ladder;
mod measure;
mod numerics;
mod order;
mod outcome;
mod overlap;
mod plan;
mod reference;
mod report;
mod runs;
mod search;
mod text;
mod windows;

pub use documents::{Making, csv, json};
pub use reference::{ReadReference, read as read_reference};
pub use report::{Report, Row};
pub use search::{Found, Wish, search};
pub use text::text;
