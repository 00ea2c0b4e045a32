//! Studies: which runs to make ([`design`]), what their responses tell of the factors ([`effects`]), and what is expected
//! where no run was made ([`surrogate`]).
//!
//! Nothing here knows of simulations, files or the command line.

pub mod design;
pub mod effects;
pub mod fit;
mod quasi_newton;
pub mod sensitivity;
pub mod surrogate;
