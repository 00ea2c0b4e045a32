//! What the crate promises, from outside. One program, for every one that is linked takes time.

mod build_up;
mod closed_forms;
mod condition;
mod control;
mod extension;
mod extremes;
mod fibres;
mod heat;
mod laws;
mod micrograph;
mod model;
mod observe;
mod preparation;
mod round_pin;
mod scenes;
mod synthesis;
mod synthesis_bits;
mod synthesis_moments;
