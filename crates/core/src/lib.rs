//! The physics of Plateau.
pub mod contact;
pub mod debris;
pub mod filling;
pub mod history;
pub mod material;
pub mod mesh;
pub mod observe;
pub mod pair;
pub mod parameters;
pub mod plateau;
mod sampling;
pub mod simulation;
pub mod state;
pub mod sum;
pub mod surface;
pub mod wear;
