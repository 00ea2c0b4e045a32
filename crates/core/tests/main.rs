//! What the crate promises, from outside. One program, for every one that is linked takes time.

mod description;
mod extremes;
mod preparation;
mod synthesis;
mod synthesis_bits;
mod synthesis_moments;
