//! What the benchmarks promise, from outside. One program, for every one that is linked takes time.

mod commands;
mod extremes;
