//! Scenes: what a simulation is told, in TOML (formats.md).
pub mod recipe;
