//! Designs of studies: which runs to make, and in which order.
//!
//! Nothing here knows of simulations, files or the command line.

pub mod design;
pub mod shuffle;
