//! Helpers shared by the end-to-end tests.

pub mod divergence;
pub mod fault;
pub mod patience;
pub mod power_loss;
pub mod program;
pub mod run_file;
#[path = "../../crates/core/tests/scenes.rs"]
pub mod scenes;
#[path = "../../crates/io/tests/studies.rs"]
pub mod studies;
pub mod table;
pub mod vector;
