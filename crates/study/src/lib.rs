//! Studies: which runs to make ([`design`]), what their responses tell of the factors ([`effects`]), and what is expected
//! where no run was made ([`surrogate`]), and where the responses are best ([`optimum`]).
//!
//! Nothing here knows of simulations, files or the command line.

pub mod design;
pub mod effects;
pub mod fit;
pub mod optimum;
mod quasi_newton;
pub mod sensitivity;
pub mod shuffle;
pub mod surrogate;
