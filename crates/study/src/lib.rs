//! Studies: which runs to make ([`design`]), and what their responses tell of the factors ([`effects`]).
//!
//! Nothing here knows of simulations, files or the command line.

pub mod design;
pub mod effects;
