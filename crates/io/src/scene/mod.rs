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
mod document;
mod error;
mod interpret;
mod layers;
pub(crate) mod mesh;
mod resolved;
pub mod schema;
mod settings;
mod surfaces;

use std::path::Path;

use settings::Settings;

pub use contents::{
    BaseSource, HeightSettings, HeightSource, Lay, OperationCycle, OutputSettings, ReadOptions, Scene, Workers,
    memory_estimate,
};
pub(crate) use error::{Locator, is_study, not_toml};
pub use error::{Origin, Problem, SceneError, Warning};
pub use resolved::{Difference, differences, values};

/// Reads the scene at `path`, lays it over the scenes it extends, applies the arguments of `--set` (`key.path=value`)
/// and checks everything that can be checked without reading surfaces.
pub fn load(path: &Path, sets: &[String]) -> Result<Scene, SceneError> {
    checked(layers::read(path, None, &[sets])?, path)
}

/// As [`load`], of the text of a scene that is in no file: what it names is looked for as if it were at `path`.
pub fn of_text(path: &Path, text: &str) -> Result<Scene, SceneError> {
    of_layers(path, Some(text), &[])
}

/// As [`load`], or of a text as [`of_text`], with lists of changes that are laid over each other, as scenes are that extend others: a
/// later one may choose another alternative.
pub fn of_layers(path: &Path, text: Option<&str>, sets: &[&[String]]) -> Result<Scene, SceneError> {
    checked(layers::read(path, text, sets)?, path)
}

fn checked(layers: layers::Layered, path: &Path) -> Result<Scene, SceneError> {
    let layers::Layered { entries, files, mut problems, replaced } = layers;
    if problems.is_empty() {
        // A key that is mistyped or was dropped is not missing too.
        settings::refuse_missing(&entries, path, &mut problems);
    }
    settings::refuse_lone_companions(&entries, &mut problems);
    settings::refuse_meaningless(&entries, &mut problems);
    let settings = Settings::read(&entries, path, &mut problems);
    if !problems.is_empty() {
        return Err(SceneError::new(problems));
    }
    let mut scene = build::build(settings, files, path)?;
    scene.warnings.splice(0..0, replaced);
    Ok(scene)
}
