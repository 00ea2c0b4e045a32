//! The physics of Plateau.
pub mod material;
pub mod mesh;
pub mod observe;
pub mod parameters;
pub mod state;
pub mod surface;
