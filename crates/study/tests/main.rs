//! What the crate promises, from outside. One program, for every one that is linked takes time.

mod answers;
mod coverage;

mod designs;
mod effects;
mod effects_of_odd_data;
mod fit_coverage;
mod optimum;
mod process_coverage;
mod surrogate;
