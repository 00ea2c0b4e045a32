//! What the crate promises, from outside. One program, for every one that is linked takes time.

mod build_up;
mod closed_forms;
mod description;
mod extension;
mod extremes;
mod heat;
mod laws;
mod model;
mod preparation;
mod round_pin;
mod scenes;
mod synthesis;
mod synthesis_bits;
mod synthesis_moments;
