//! Scenes: what a simulation is told, in TOML (docs/scenes.md).
//!
//! ```text
//! scene file, scenes it extends, --set   layers     one list of keys, each with its place in a text
//!                                        settings   each key checked by the schema, SI units, defaults
//!                                        build      what keys say together: mesh, steps, memory -> Scene (surfaces: those of disc and pin)
//!                                        resolved   the whole scene as TOML again
//! ```

mod build;
mod contents;
mod cycle;
mod cycle_table;
mod error;
mod interpret;
mod layers;
pub(crate) mod mesh;
mod resolved;
pub mod schema;
mod settings;
mod surfaces;

pub use build::{load, of_layers, of_text};
pub use contents::{
    BaseSource, HeightSettings, HeightSource, Lay, OperationCycle, OutputSettings, ReadOptions, Scene, Workers,
    memory_estimate,
};
pub(crate) use error::{Locator, is_study, not_toml};
pub use error::{Origin, Problem, SceneError, Warning};
pub use resolved::{Difference, differences, values};
