//! Error against run time: a scene is run along ladders, and every run is held against a reference.
//!
//! | what | where |
//! |---|---|
//! | the numerics that a ladder changes | [`numerics`] |
//! | the rungs of every ladder | [`ladder`] |
//! | surfaces on a coarser mesh | [`coarsening`], [`overlap`] |
//! | how long a run will take | [`laboratory`] |
//! | which runs fit into a budget | [`mod@plan`] |
//! | one run | [`mod@measure`] |
//! | what is kept of it | [`outcome`], [`history`] |
//! | a reference, made or read | [`mod@reference`] |
//! | windows of physical time | [`windows`] |
//! | a run held against the reference | [`comparison`], [`history_error`], [`topography`] |
//! | order of convergence | [`order`] |
//! | which runs are worth their time | [`pareto`], [`mod@advice`] |
//! | all that was found | [`report`], its numbers in [`columns`] |
//! | as text, CSV, JSON and HDF5 | [`mod@text`], [`mod@csv`], [`mod@json`], [`hdf5`] |

mod advice;
mod coarsening;
mod columns;
mod comparison;
mod csv;
mod hdf5;
mod history;
mod history_error;
mod json;
mod laboratory;
mod ladder;
mod measure;
mod numerics;
mod order;
mod outcome;
mod overlap;
mod pareto;
mod plan;
mod reference;
mod report;
mod text;
mod topography;
mod windows;

pub use csv::csv;
pub use hdf5::{Making, content};
pub use json::json;
pub use laboratory::{Found, Laboratory, Wish};
pub use reference::{ReadReference, read as read_reference};
pub use report::{Report, Row};
pub use text::text;
