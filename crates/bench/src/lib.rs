//! Benchmarks: how long a step of the model takes and why (the program `plateau-bench`).
//!
//! ```text
//! kernel, scaling, parts, peers   one benchmark each: what is set against what
//! costs      another one: runs of the program with optional parts on and off
//! case       scene -> parameters and surfaces, on meshes of several sizes
//! stepper    a simulation as something that can be timed: the only calls of core's time loop
//! race       times several things in turn
//! document   results as JSON                              tables     the tables made from them
//! ```

pub mod arguments;
mod build;
mod case;
mod costs;
mod document;
mod error;
mod kernel;
mod machine;
mod parts;
mod peer;
mod peers;
mod race;
mod report;
mod scaling;
mod session;
mod stepper;
mod table;
mod tables;
