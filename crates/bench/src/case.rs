//! Scenes that are timed, on meshes of several sizes.

use std::error::Error;
use std::path::{Path, PathBuf};

use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::checkpoint::Checkpoint;
use plateau_core::simulation::{Execution, Simulation};
use plateau_io::{scene, surface};
use serde::Serialize;

/// Result of a benchmark, or the reason why there is none, in words.
pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// Error of a file, in words.
pub fn of_file(path: &Path) -> impl FnOnce(std::io::Error) -> String {
    move |error| format!("{}: {error}", path.display())
}

/// Setting of the paper's model, with which scenes are measured; `--set` may ask for something else.
const MODEL: &str = "numerics.time_acceleration=1";

/// The time acceleration with which a pin wears in before a benchmark.
const WEARING_IN: f64 = 100.0;

/// Parameters and surfaces of a simulation.
#[derive(Debug, Clone)]
pub struct Case {
    pub parameters: Parameters,
    /// The surfaces before the first step.
    pub surfaces: InitialSurfaces,
    /// The state from which it starts, if that is not before the first step.
    pub start: Option<Checkpoint>,
}

/// Counts of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct MeshSize {
    /// Cells in r.
    pub rows: usize,
    /// Columns under the pin.
    pub pin_columns: usize,
    /// Columns round the ring.
    pub disc_columns: usize,
}

impl MeshSize {
    /// A brake pad at the paper's cell size.
    pub const FULL_PAD: Self = Self { rows: 800, pin_columns: 1600, disc_columns: 13_800 };
    /// A sixteenth of the paper's mesh, for a look at whether a benchmark runs.
    pub const QUICK: Self = Self { rows: 20, pin_columns: 40, disc_columns: 691 };

    /// A mesh `factor` times as large in both directions.
    pub fn times(self, factor: usize) -> Self {
        Self {
            rows: self.rows * factor,
            pin_columns: self.pin_columns * factor,
            disc_columns: self.disc_columns * factor,
        }
    }

    /// A mesh whose pin and ring are `factor` times as long, the rows being the same.
    pub fn longer(self, factor: usize) -> Self {
        Self { pin_columns: self.pin_columns * factor, disc_columns: self.disc_columns * factor, ..self }
    }

    /// Cells of the pin.
    pub fn pin_cells(self) -> usize {
        self.rows * self.pin_columns
    }
}

impl std::fmt::Display for MeshSize {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} x {} on {}", self.rows, self.pin_columns, self.disc_columns)
    }
}

/// A scene file and changes of it.
#[derive(Debug, Clone)]
pub struct Source {
    /// The scene file.
    pub path: PathBuf,
    /// Changes, as after `--set`.
    pub sets: Vec<String>,
    /// Physical time for which the pin has worn in when the benchmark starts, s.
    pub worn_in: f64,
}

impl Source {
    /// The scene at `path`, or the paper's, with m = 1 and the changes `sets`.
    pub fn new(path: Option<PathBuf>, sets: Vec<String>, worn_in: f64) -> Self {
        let path = path.unwrap_or_else(|| repository().join("data/scenes/cermet.toml"));
        Self { path, sets: [vec![MODEL.to_owned()], sets].concat(), worn_in }
    }

    /// File name of the scene.
    pub fn name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The same scene with more changes.
    pub fn with(&self, sets: impl IntoIterator<Item = String>) -> Self {
        Self { sets: self.sets.iter().cloned().chain(sets).collect(), ..self.clone() }
    }

    /// The same scene on a mesh of another size.
    ///
    /// Cells keep their size, the disc its speed and the pin its nominal pressure: the width of the ring grows with the
    /// rows, its mean radius with the columns round it, the load with the area of the pin and the angular velocity
    /// against the radius. So every cell has as much to do as before.
    pub fn on(&self, size: MeshSize) -> Outcome<Self> {
        let parameters = self.parameters()?;
        let mesh = &parameters.mesh;
        if size == mesh_size(&parameters) {
            return Ok(self.clone());
        }
        let width = mesh.row_height() * size.rows as f64;
        let radius = mesh.column_width() * size.disc_columns as f64 / std::f64::consts::TAU;
        let force = parameters.normal_force * size.pin_cells() as f64 / mesh.pin_cells() as f64;
        let speed = parameters.angular_velocity * mesh.mean_radius() / radius;
        Ok(self.with([
            format!("mesh.rows={}", size.rows),
            format!("mesh.pin_columns={}", size.pin_columns),
            format!("mesh.disc_columns={}", size.disc_columns),
            format!("mesh.inner_radius=\"{} m\"", radius - width / 2.0),
            format!("mesh.outer_radius=\"{} m\"", radius + width / 2.0),
            format!("operation.normal_force=\"{force} N\""),
            format!("operation.rotational_speed=\"{speed} rad/s\""),
        ]))
    }

    /// Parameters, without the surfaces.
    pub fn parameters(&self) -> Outcome<Parameters> {
        Ok(scene::load(&self.path, &self.sets)?.parameters)
    }

    /// Parameters and surfaces.
    pub fn case(&self) -> Outcome<Case> {
        let scene = scene::load(&self.path, &self.sets)?;
        let surfaces = surface::load(&scene)?.surfaces;
        let mut case = Case { parameters: scene.parameters, surfaces, start: None };
        if self.worn_in > 0.0 {
            case.start = Some(worn_in(&case, self.worn_in)?);
        }
        Ok(case)
    }
}

/// The state of a case after so much time (s), which is passed with a time acceleration: what a step costs depends on how the
/// surfaces look, not on the last digit of a height.
fn worn_in(case: &Case, time: f64) -> Outcome<Checkpoint> {
    eprintln!("wearing in: {}, {time} s", mesh_size(&case.parameters));
    let execution = Execution { workers: 1, ..Execution::default() };
    let mut simulation = Simulation::with_execution(case.parameters.clone(), case.surfaces.clone(), execution)?;
    simulation.accelerate(WEARING_IN)?;
    while simulation.time() < time {
        simulation.pass_to(simulation.steps_done() + case.parameters.mesh.disc_columns() as u64)?;
    }
    simulation.accelerate(case.parameters.time_acceleration)?;
    Ok(simulation.checkpoint()?)
}

/// Counts of cells of a mesh.
pub fn mesh_size(parameters: &Parameters) -> MeshSize {
    let mesh = &parameters.mesh;
    MeshSize { rows: mesh.rows(), pin_columns: mesh.pin_columns(), disc_columns: mesh.disc_columns() }
}

/// The root of the repository from which this program was built.
pub fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

#[cfg(test)]
#[path = "../tests/unit/case.rs"]
mod tests;
