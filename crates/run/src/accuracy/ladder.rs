//! Ladders: runs of a scene with one of its keys set to several values; and the cells of the runs, where the cell is a numerical setting.

use std::path::PathBuf;

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::InitialSurfaces;
use plateau_io::scene::{self, Scene, SceneError};

/// Time accelerations that are tried, besides the scene's own: they have small common multiples, so that there are windows
/// of whole revolutions of all of them.
const TIME_ACCELERATIONS: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
/// Fewest simulated revolutions of a run.
const FEWEST_REVOLUTIONS: f64 = 8.0;
/// Tolerances of a run that chooses its acceleration that are tried, besides the scene's own.
const TOLERANCES: [f64; 5] = [0.002, 0.005, 0.01, 0.02, 0.05];
/// Largest acceleration of such a run, unless the scene says another.
const LARGEST: f64 = 1000.0;
/// Parts of themselves by which initial heights are changed.
const PERTURBATIONS: [f64; 3] = [1e-9, 1e-6, 1e-4];

/// Runs that differ in one key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ladder {
    /// Revolutions that a simulated one stands for.
    TimeAcceleration,
    /// The same with cells half and twice as long along the sliding direction.
    Mesh,
    /// Accelerations that the run chooses itself, by the error that it may make.
    Tolerance,
    /// The reference anew with initial heights that differ a little: how much of the errors is chance.
    Perturbation,
}

impl Ladder {
    /// All ladders.
    pub const ALL: [Self; 4] = [Self::TimeAcceleration, Self::Mesh, Self::Tolerance, Self::Perturbation];

    /// Name of the ladder on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::TimeAcceleration => "time_acceleration",
            Self::Mesh => "mesh",
            Self::Tolerance => "tolerance",
            Self::Perturbation => "perturbation",
        }
    }
}

/// Place of a run on its ladder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LadderPoint {
    /// The ladder.
    pub ladder: Ladder,
    /// Time acceleration, tolerance, or part of the heights.
    pub value: f64,
    /// Cells of the run.
    pub cells: Cells,
}

/// Time accelerations of a scene, increasing: 1, the scene's own, and others with which there are enough revolutions.
pub fn time_accelerations(own: f64, revolutions: f64) -> Vec<f64> {
    let room = |acceleration: &f64| *acceleration == 1.0 || revolutions / acceleration >= FEWEST_REVOLUTIONS;
    sorted(TIME_ACCELERATIONS.into_iter().filter(room).chain([own]))
}

/// Steps of these ladders that a reference judges, which has the time acceleration `reference`, and halved cells if `finer`:
/// coarser runs, or the reference with other heights. A run that chooses its acceleration begins with 1, so that nothing but the
/// model itself is finer.
pub fn steps(
    ladders: &[Ladder],
    accelerations: &[f64],
    own_tolerance: Option<f64>,
    reference: f64,
    finer: bool,
) -> Vec<LadderPoint> {
    let coarser = |cells: Cells, equal: bool| {
        let values = accelerations.iter().copied().filter(move |m| *m > reference || equal && *m == reference);
        values.map(move |value| (value, cells)).collect::<Vec<_>>()
    };
    let same = |values: Vec<f64>, cells: Cells| values.into_iter().map(move |value| (value, cells)).collect();
    let values = |ladder: Ladder| match ladder {
        Ladder::TimeAcceleration => coarser(Cells::Own, finer),
        Ladder::Mesh if finer => [coarser(Cells::Halved, false), coarser(Cells::Doubled, true)].concat(),
        Ladder::Tolerance if reference == 1.0 => same(sorted(TOLERANCES.into_iter().chain(own_tolerance)), Cells::Own),
        Ladder::Mesh | Ladder::Tolerance => Vec::new(),
        Ladder::Perturbation => same(PERTURBATIONS.to_vec(), if finer { Cells::Halved } else { Cells::Own }),
    };
    let of =
        |ladder: Ladder| values(ladder).into_iter().map(move |(value, cells)| LadderPoint { ladder, value, cells });
    ladders.iter().flat_map(|ladder| of(*ladder)).collect()
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// A scene file with changes, from which every run of a ladder differs in the keys that its rung sets.
#[derive(Debug, Clone)]
pub struct Base {
    /// The scene file.
    pub path: PathBuf,
    /// Changes, as after `--set`.
    pub sets: Vec<String>,
    /// Scene that file and changes make together.
    pub scene: Scene,
}

/// One run of a ladder.
#[derive(Debug, Clone)]
pub struct Rung {
    /// The ladder.
    pub ladder: Ladder,
    /// Value of what it changes: the time acceleration, the columns of the disc, the tolerance, the part of the heights.
    pub value: f64,
    /// Cells of the run.
    pub cells: Cells,
    /// Changes of the base, as after `--set`.
    sets: Vec<String>,
    /// Scene with these changes.
    pub scene: Scene,
}

impl Rung {
    /// Reads the scene of a step; `reference` is the time acceleration of the reference.
    pub fn new(
        base: &Base,
        LadderPoint { ladder, value, cells }: LadderPoint,
        reference: f64,
    ) -> Result<Self, SceneError> {
        let accelerated = |acceleration: f64| format!("numerics.time_acceleration = {acceleration}");
        let columns = cells.columns(&base.scene.parameters.mesh).filter(|_| cells != Cells::Own);
        let mut sets = Vec::new();
        if let Some([disc, pin]) = columns {
            sets.extend([format!("mesh.disc_columns = {disc}"), format!("mesh.pin_columns = {pin}")]);
        }
        match ladder {
            Ladder::TimeAcceleration | Ladder::Mesh => sets.push(accelerated(value)),
            Ladder::Tolerance => {
                let largest = base.scene.adaptive.map_or(LARGEST, |adaptive| adaptive.largest);
                sets.push(format!("numerics.time_acceleration = {{ tolerance = {value}, max = {largest} }}"));
            }
            Ladder::Perturbation => {
                let scale = base.scene.disc_surface.preparation.scale * (1.0 + value);
                sets.extend([accelerated(reference), format!("disc.prepare.scale = {scale}")]);
            }
        }
        let value = columns.filter(|_| ladder == Ladder::Mesh).map_or(value, |[disc, _]| disc as f64);
        let scene = scene::load(&base.path, &[&base.sets[..], &sets].concat())?;
        let rung = Self { ladder, value, cells, sets, scene };
        Ok(rung.lasting(base.scene.duration))
    }

    /// The same rung for so much physical time (s): a number of steps is another time with another acceleration.
    #[must_use]
    pub fn lasting(mut self, duration: f64) -> Self {
        self.scene.duration = duration;
        self.scene.steps = self.scene.parameters.steps_of(duration);
        self
    }

    /// Keys and values that make this run, as a scene has them.
    pub fn setting(&self) -> String {
        self.sets.join(", ").replace("numerics.", "").replace("mesh.", "")
    }
}

/// Length of cells along the sliding direction, against the scene's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cells {
    /// Half as long.
    Halved,
    /// The scene's.
    Own,
    /// Twice as long.
    Doubled,
}

impl Cells {
    /// Columns of the halved cells from one of these to the next.
    fn stride(self) -> usize {
        match self {
            Self::Halved => 1,
            Self::Own => 2,
            Self::Doubled => 4,
        }
    }

    /// Columns of the disc and of the pin, from those of the scene's mesh; none where the disc's cannot be divided. A pin with an
    /// odd number of columns gets half a doubled cell more.
    pub fn columns(self, own: &Mesh) -> Option<[usize; 2]> {
        let [disc, pin] = [own.disc_columns(), own.pin_columns()].map(|columns| 2 * columns);
        (disc % self.stride() == 0).then_some([disc / self.stride(), pin.div_ceil(self.stride())])
    }

    /// Wall time of a run against that with the scene's cells: columns, and steps, are in inverse proportion to a cell's length.
    pub fn work(self) -> f64 {
        (2.0 / self.stride() as f64).powi(2)
    }

    /// Samples surfaces that were made on the mesh of halved cells: the same physical surfaces.
    #[must_use]
    pub fn sample(self, surfaces: &InitialSurfaces, rows: usize) -> InitialSurfaces {
        fn columns<T: Copy>(values: &[T], rows: usize, stride: usize) -> Vec<T> {
            values.chunks(rows).step_by(stride).flatten().copied().collect()
        }
        let stride = self.stride();
        InitialSurfaces {
            disc_height: columns(&surfaces.disc_height, rows, stride),
            pin_height: columns(&surfaces.pin_height, rows, stride),
            pin_base: columns(&surfaces.pin_base, rows, stride),
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/accuracy/ladder.rs"]
mod tests;
