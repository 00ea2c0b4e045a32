//! Scene in SI units, the typed result of reading it, and the memory that its run takes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use plateau_core::acceleration::Adaptive;
use plateau_core::model::brake::Brake;
use plateau_core::model::cycle::Cycle;
use plateau_core::model::parameters::Parameters;
use plateau_core::observe::extra::{
    BRAKE_EMISSION, BRAKE_TORQUE, EMISSION, EMISSION_ON_ROAD, Extra, FRICTION, HEAT, PADS, PADS_ON_ROAD,
};
use plateau_core::observe::schedule::{End, SampleEvery, Schedule};
use plateau_core::observe::{ACCELERATION, CYCLE, Map, ROAD};
use plateau_core::simulation::Decomposition;
use plateau_core::surface::micrograph::{Enlargement, Micrograph};
use plateau_core::surface::{Body, FibreSynthesis, HeightSynthesis, Preparation};

use super::error::{Origin, Warning};
use crate::delimited::Decimal;

/// A scene, read, checked and resolved.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Title; the scene file's stem if the scene gives none.
    pub title: String,
    /// The scene file.
    pub path: PathBuf,
    /// Parameters of the model; where the run chooses its acceleration, with m = 1.
    pub parameters: Parameters,
    /// Steps to simulate; where the run chooses its acceleration, with m = 1.
    pub steps: u64,
    /// Residual |Σ k A u − F_N| / F_N above which the run says that the load balance is inexact. It changes no step.
    pub load_tolerance: f64,
    /// Load and speed over time, if they are given as a cycle.
    pub cycle: Option<OperationCycle>,
    /// Brake of whose pads the pin is a piece.
    pub brake: Option<Brake>,
    /// Choice of the acceleration by the run, if it chooses it.
    pub adaptive: Option<Adaptive>,
    /// Physical time that is to be simulated, s; the last step ends there, or up to one step later.
    pub duration: f64,
    /// Disc heights.
    pub disc_surface: HeightSettings,
    /// Pin heights.
    pub pin_surface: HeightSettings,
    /// Height that is added to the pin's on cells without fibre, m.
    pub resin_recess: f64,
    /// Fibre map of the pin.
    pub pin_base: BaseSource,
    /// True if the fibre map is a view of the pin's face: x is mirrored, whatever the map comes from.
    pub pin_base_mirror: bool,
    /// Threads.
    pub workers: Workers,
    /// Division of the mesh among them.
    pub decomposition: Decomposition,
    /// Output: files, series, maps, and their times.
    pub output: OutputSettings,
    /// Seeds of the scene as (key path, seed), for the run file's provenance.
    pub seeds: Vec<(String, u64)>,
    /// The whole resolved scene as TOML: `extends` and `--set` applied, defaults filled in.
    pub resolved: String,
    /// Every scene file read (this one and those it extends) and the file of the cycle, each with the SHA-256 of what was read of it, 64
    /// hexadecimal digits.
    pub files: Vec<(PathBuf, String)>,
    /// Things worth telling the user that are no errors (for instance a map time beyond the end).
    pub warnings: Vec<Warning>,
    /// Origin of every key that has a value, by its full path.
    pub places: BTreeMap<String, Origin>,
}

impl Scene {
    /// Time at which samples and maps are due.
    pub fn schedule(&self) -> Schedule {
        let OutputSettings { sample_every, maps_at, .. } = &self.output;
        Schedule::new(&self.parameters, self.end(), *sample_every, maps_at)
    }

    /// Series besides those that every run has, where the run chooses its acceleration or does not.
    pub fn extras(&self, chooses_acceleration: bool) -> Vec<&'static Extra> {
        let acceleration = chooses_acceleration.then_some(&ACCELERATION);
        let has_road = self.cycle.as_ref().is_some_and(|operation| operation.has_road);
        let has_brake = self.brake.is_some();
        let Parameters { friction, thermal, emission, .. } = &self.parameters;
        let others = [
            (self.cycle.is_some() || self.parameters.by_torque, &CYCLE),
            (has_road, &ROAD),
            (friction.is_some(), &FRICTION),
            (thermal.is_some(), &HEAT),
            (emission.is_some(), &EMISSION),
            (has_brake, &PADS),
            (has_brake && has_road, &PADS_ON_ROAD),
            (has_brake && friction.is_some(), &BRAKE_TORQUE),
            (has_brake && emission.is_some(), &BRAKE_EMISSION),
            (has_brake && emission.is_some() && has_road, &EMISSION_ON_ROAD),
        ];
        let others = others.into_iter().filter(|(is_there, _)| *is_there).map(|(_, extra)| extra);
        self.output.extras.iter().copied().chain(acceleration).chain(others).collect()
    }

    /// Time at which the run is over.
    fn end(&self) -> End {
        // The time of a step is rounded, so a number of steps is the better end where it does not change; a cycle may end in
        // a pause.
        let is_timed = self.adaptive.is_some() || self.parameters.cycle.is_some();
        if is_timed { End::Time(self.duration) } else { End::Steps(self.steps) }
    }
}

/// Operation as a cycle.
#[derive(Debug, Clone)]
pub struct OperationCycle {
    /// Load and speed over time. Where they never change, the parameters of the scene have no cycle.
    pub cycle: Arc<Cycle>,
    /// Tells whether its load is a braking torque.
    pub by_torque: bool,
    /// Tells whether it has a load of its own, in place of the constant one.
    pub has_load: bool,
    /// Tells whether it has a speed of its own.
    pub has_speed: bool,
    /// Tells whether it says how fast the vehicle is.
    pub has_road: bool,
    /// Tells whether the vehicle changes its speed, while the disc turns at one speed.
    pub is_road_alone: bool,
    /// Time of its first row as the file has it, s.
    pub start: f64,
    /// The file of its rows, if they are not in the scene, with the SHA-256 of what was read of it.
    pub file: Option<(PathBuf, String)>,
}

/// Heights and how they are prepared.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightSettings {
    /// Source of the heights.
    pub source: HeightSource,
    /// True for a view from the front: x is mirrored.
    pub mirror: bool,
    /// The preparation chain.
    pub preparation: Preparation,
}

/// Source of heights.
#[derive(Debug, Clone, PartialEq)]
pub enum HeightSource {
    /// A file, told by its content; the path is resolved against the scene that names it.
    File {
        /// The file.
        path: PathBuf,
        /// Statements of the scene about the file.
        options: ReadOptions,
    },
    /// A random field.
    Synthetic(HeightSynthesis),
    /// All heights zero.
    Flat,
}

/// Statements of a user about a surface file that the file itself does not make.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// Dataset in an HDF5 file, array in an .npz archive, or the number of a table in a text.
    pub dataset: Option<String>,
    /// Time of the map of a run file, s; without it the last one is taken.
    pub at: Option<f64>,
    /// Length that the number 1 stands for, m; for text that does not state its unit, for NumPy arrays in another unit than m
    /// and for images of decimal heights.
    pub unit: Option<f64>,
    /// Distance of neighbouring points along x and y, m; for files that do not state it.
    pub pitch: Option<[f64; 2]>,
    /// Heights of black and white of an image, m.
    pub height_range: Option<[f64; 2]>,
    /// The decimal mark of a text file, where its content does not tell it.
    pub decimal: Option<Decimal>,
    /// Lines of a text file that are not read, from its first. A file of which lines are skipped, also none, is taken as
    /// a table, whatever its first lines tell.
    pub skip: Option<u64>,
    /// The file is a profile, and this is the direction of its lay.
    pub profile_lay: Option<Lay>,
}

/// Direction of the lay of a surface, of which a profile says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lay {
    /// Grooves along the sliding direction: the profile was traced across it, and goes on unchanged along it.
    Along,
    /// Grooves across the sliding direction: the profile was traced along it, and goes on unchanged across it.
    Across,
    /// No direction: a surface that has the statistics of the profile in every direction.
    Isotropic,
}

/// Source of the pin's fibre map.
#[derive(Debug, Clone, PartialEq)]
pub enum BaseSource {
    /// Integers in an HDF5 file, 0 = none, 1 = primary, shape (pin_columns, rows).
    File {
        /// The file.
        path: PathBuf,
        /// Dataset in the file.
        dataset: Option<String>,
    },
    /// A micrograph, PNG or TIFF.
    Image {
        /// The file.
        path: PathBuf,
        /// Preparation of the fibre map.
        micrograph: Micrograph,
    },
    /// Random capsules.
    Synthetic(FibreSynthesis),
    /// All cells alike.
    Uniform(plateau_core::model::state::Base),
}

/// Number of threads that share the ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Workers {
    /// The number that is fastest on this machine.
    Auto,
    /// Number that is given, at least 1.
    Count(usize),
}

/// Output: files, series, maps, and their times.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSettings {
    /// Run file, relative to the working directory.
    pub file: PathBuf,
    /// Time at which samples are taken.
    pub sample_every: SampleEvery,
    /// Physical times of the maps, s, increasing, none beyond the end; the last state is always written besides.
    pub maps_at: Vec<f64>,
    /// The maps that are written.
    pub maps: Vec<Map>,
    /// The series on request that are written with every sample.
    pub extras: Vec<&'static Extra>,
    /// Wall time between two checkpoints, s.
    pub checkpoint_every: f64,
}

/// Copies of a map that exist at once: one on its way to the writer, one that it writes; and of a field that a series is
/// measured of, that of one worker and that of all.
const COPIES: u128 = 2;

const FLOAT: u128 = size_of::<f64>() as u128;
const STATUS: u128 = size_of::<u8>() as u128;

/// Bytes that a run of the scene keeps in memory at its peak: state and working arrays, and beside them the larger of
/// the surfaces while they are made and the maps on their way to the file.
///
/// Measured surfaces come on top, as large as their files. Surfaces that are extended by statistics count as for a patch of a few
/// rows.
pub fn memory_estimate(scene: &Scene) -> u64 {
    let mesh = &scene.parameters.mesh;
    let counts = [mesh.rows(), mesh.disc_columns(), mesh.pin_columns()].map(|count| count as u64);
    let run = estimate(counts, &scene.output.maps, &scene.output.extras, scene.adaptive.is_some());
    // One body after the other, before there is a simulation.
    let extended = |settings: &HeightSettings, body: Body| {
        settings.preparation.extend.map_or(0, |_| field(body.columns(mesh), mesh.rows(), body == Body::Disc))
    };
    let fibres = match &scene.pin_base {
        BaseSource::Image { micrograph, .. }
            if matches!(micrograph.enlargement, Some(Enlargement::Statistics { .. })) =>
        {
            field(mesh.pin_columns(), mesh.rows(), false)
        }
        _ => 0,
    };
    let surfaces = [extended(&scene.disc_surface, Body::Disc), extended(&scene.pin_surface, Body::Pin), fibres];
    surfaces.into_iter().fold(run, u64::max)
}

/// Bytes of the field from which heights of a body are taken that are extended by statistics: a complex number, an
/// autocorrelation, its power and a height for every cell of the padded grid.
fn field(columns: usize, rows: usize, closed: bool) -> u64 {
    let padded = |cells: usize| (cells + 1).next_power_of_two() as u64;
    let columns = if closed { columns as u64 } else { padded(columns) };
    columns.saturating_mul(padded(rows)).saturating_mul(5 * FLOAT as u64)
}

/// Estimates memory, bytes, as [`memory_estimate`] does, for a mesh of these rows and columns that need not exist; saturates.
pub(super) fn estimate(
    [rows, disc_columns, pin_columns]: [u64; 3],
    maps: &[Map],
    extras: &[&Extra],
    chooses_acceleration: bool,
) -> u64 {
    let cells = |columns: u64| u128::from(rows) * u128::from(columns);
    let (disc, pin) = (cells(disc_columns), cells(pin_columns));
    let sum = |parts: &[(u128, u128)]| {
        parts.iter().fold(0_u128, |sum, (count, bytes)| sum.saturating_add(count.saturating_mul(*bytes)))
    };
    // A run that chooses its acceleration has a scout with a state of its own.
    let simulations = if chooses_acceleration { 2 } else { 1 };
    // Height and substrate of both, the pin's base, two working arrays over the pin, radius and area of every row.
    let state = sum(&[(disc, 2 * FLOAT), (pin, 4 * FLOAT + STATUS), (rows.into(), 2 * FLOAT)]);
    let surfaces = sum(&[(disc, 2 * FLOAT), (pin, 2 * (FLOAT + STATUS))]);
    let size = |map: &Map| {
        let bytes = if map.is_status() { STATUS } else { FLOAT };
        (if map.on_disc() { disc } else { pin }, COPIES * bytes)
    };
    let gathered = extras.iter().filter_map(|extra| extra.request.as_ref()).flat_map(|request| request.maps);
    let output = sum(&maps.iter().chain(gathered).map(size).collect::<Vec<_>>());
    u64::try_from(state.saturating_mul(simulations).saturating_add(surfaces.max(output))).unwrap_or(u64::MAX)
}

#[cfg(test)]
#[path = "../../tests/unit/scene/contents.rs"]
mod tests;
