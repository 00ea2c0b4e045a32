//! Everything of Plateau that touches a file.
pub mod scene;
pub mod surface;
