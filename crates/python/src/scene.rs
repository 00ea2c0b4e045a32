//! Scenes as objects of Python, and the units of their values.

use std::path::PathBuf;

use plateau_io::plausibility;
use plateau_io::scene::{self, schema};
use plateau_io::units::{self, Powers};
use pyo3::prelude::*;

use crate::failure::{Failure, raise};

/// A scene, read, checked and resolved.
#[pyclass(frozen, module = "plateau._native")]
pub struct Scene(pub scene::Scene);

#[pymethods]
impl Scene {
    /// Reads the scene at `path`, or its `text`, with lists of changes as after `--set`, each laid over those before.
    #[new]
    #[pyo3(signature = (path, text=None, sets=Vec::new()))]
    fn new(py: Python<'_>, path: PathBuf, text: Option<&str>, sets: Vec<Vec<String>>) -> PyResult<Self> {
        let lists: Vec<&[String]> = sets.iter().map(Vec::as_slice).collect();
        let read = py.detach(|| scene::of_layers(&path, text, &lists));
        // A text is in no file that could be missing.
        let about = if text.is_some() { Vec::new() } else { vec![path.to_string_lossy()] };
        let about: Vec<&str> = about.iter().map(AsRef::as_ref).collect();
        let mut scene = read.map_err(|error| raise(py, &about, Failure::input(error)))?;
        scene.warnings.extend(plausibility::of_scene(&scene));
        Ok(Self(scene))
    }

    /// The whole scene as TOML: defaults filled in, changes applied.
    #[getter]
    fn resolved(&self) -> &str {
        &self.0.resolved
    }

    /// What the scene can hardly mean.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.iter().map(ToString::to_string).collect()
    }

    /// The run file that the scene names.
    #[getter]
    fn output(&self) -> PathBuf {
        self.0.output.file.clone()
    }
}

/// Full path of every key of scenes.
#[pyfunction]
pub fn keys() -> Vec<String> {
    schema::keys().iter().map(schema::Key::path).collect()
}

/// Powers of m, kg, s, rad and K of a unit, and a, b and c: it is 10^a · b / c of the SI unit of these powers.
#[pyfunction]
pub fn scale_of(py: Python<'_>, unit: &str) -> PyResult<(Powers, i32, f64, f64)> {
    units::scale_of(unit).map_err(|error| raise(py, &[], Failure::input(error)))
}
