//! Benchmarks: how long a step of the model takes and why (the program `plateau-bench`).
//!
//! ```text
//! steps, costs, peers   the benchmarks: a step and its parts; runs of the program; the same step in Python
//! session    options of a benchmark of steps, and its results
//! case       scene -> parameters and surfaces, on meshes of several sizes
//! stepper    a simulation as something that can be timed: the only calls of core's time loop
//! race       times several things in turn
//! document   results as JSON: what was measured, and in what circumstances
//! tables     the tables made from them                    report   prints them, or puts them into a document
//! ```

pub mod arguments;
mod case;
mod circumstances;
mod costs;
mod document;
mod error;
mod peers;
mod race;
mod report;
mod session;
mod stepper;
mod steps;
mod tables;
