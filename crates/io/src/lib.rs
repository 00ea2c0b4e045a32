//! Everything of Plateau that touches a file.
pub mod run_file;
pub mod scene;
pub mod units;
