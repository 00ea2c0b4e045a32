//! Everything of Plateau that touches a file: scenes, surfaces, run files.
//!
//! | what | where |
//! |---|---|
//! | a scene, read, checked and resolved | [`scene`] |
//! | quantities with units | [`units`] |
//! | initial surfaces, measured or synthetic | [`surface`] |
//! | the run file and its writer | [`run_file`] |

mod digest;
pub mod run_file;
pub mod scene;
pub mod surface;
mod timestamp;
pub mod units;
