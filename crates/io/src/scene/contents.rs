//! What a scene asks for, in SI units: the typed result of reading it.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use plateau_core::acceleration::Adaptive;
use plateau_core::model::cycle::Cycle;
use plateau_core::model::parameters::Parameters;
use plateau_core::observe::dissipation::{EMISSION, FRICTION, HEAT};
use plateau_core::observe::extra::Extra;
use plateau_core::observe::operation::{CYCLE, ROAD};
use plateau_core::observe::schedule::{End, SampleEvery, Schedule};
use plateau_core::observe::{ACCELERATION, Map};
use plateau_core::surface::micrograph::Micrograph;
use plateau_core::surface::{FibreSynthesis, HeightSynthesis, Preparation};

use super::{Origin, Warning};
use crate::surface::ReadOptions;

/// A scene, read, checked and resolved.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Title; the scene file's stem if the scene gives none.
    pub title: String,
    /// The scene file.
    pub path: PathBuf,
    /// Everything core is told; where the run chooses its acceleration, with m = 1.
    pub parameters: Parameters,
    /// Steps to simulate; where the run chooses its acceleration, with m = 1.
    pub steps: u64,
    /// |Σ k A u − F_N| / F_N above which the run says that the load balance is inexact. It changes no step.
    pub load_tolerance: f64,
    /// Load and speed over time, if they are given as a cycle.
    pub cycle: Option<OperationCycle>,
    /// How the run chooses its acceleration, if it does.
    pub adaptive: Option<Adaptive>,
    /// Physical time that is to be simulated, s; the last step ends there, or up to one step later.
    pub duration: f64,
    /// Disc heights.
    pub disc_surface: HeightSettings,
    /// Pin heights.
    pub pin_surface: HeightSettings,
    /// Added to the pin's height on cells without fibre, m.
    pub resin_recess: f64,
    /// Fibre map of the pin.
    pub pin_base: BaseSource,
    /// The fibre map is a view of the pin's face: x is mirrored, whatever the map comes from.
    pub pin_base_mirror: bool,
    /// Threads.
    pub workers: Workers,
    /// What is written, where and when.
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
    /// Where every key that has a value was given, by its full path.
    pub places: BTreeMap<String, Origin>,
}

impl Scene {
    /// When samples and maps are due.
    pub fn schedule(&self) -> Schedule {
        let OutputSettings { sample_every, maps_at, .. } = &self.output;
        Schedule::new(&self.parameters, self.end(), *sample_every, maps_at)
    }

    /// Series besides those that every run has, where the run chooses its acceleration or does not.
    pub fn extras(&self, chooses_acceleration: bool) -> Vec<&'static Extra> {
        let acceleration = chooses_acceleration.then_some(&ACCELERATION);
        let has_road = self.cycle.as_ref().is_some_and(|operation| operation.has_road);
        let Parameters { friction, thermal, emission, .. } = &self.parameters;
        let others = [
            (self.cycle.is_some(), &CYCLE),
            (has_road, &ROAD),
            (friction.is_some(), &FRICTION),
            (thermal.is_some(), &HEAT),
            (emission.is_some(), &EMISSION),
        ];
        let others = others.into_iter().filter(|(is_there, _)| *is_there).map(|(_, extra)| extra);
        self.output.extras.iter().copied().chain(acceleration).chain(others).collect()
    }

    /// When the run is over.
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
    /// Whether it has a load of its own, in place of the constant one.
    pub has_load: bool,
    /// Whether it has a speed of its own.
    pub has_speed: bool,
    /// Whether it says how fast the vehicle is.
    pub has_road: bool,
    /// Whether the vehicle changes its speed, while the disc turns at one speed.
    pub is_road_alone: bool,
    /// The file of its rows, if they are not in the scene, with the SHA-256 of what was read of it.
    pub file: Option<(PathBuf, String)>,
}

/// Heights and how they are prepared.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightSettings {
    /// Where the heights come from.
    pub source: HeightSource,
    /// View from the front: x is mirrored.
    pub mirror: bool,
    /// The preparation chain.
    pub preparation: Preparation,
}

/// Where heights come from.
#[derive(Debug, Clone, PartialEq)]
pub enum HeightSource {
    /// A file, told by its content; the path is resolved against the scene that names it.
    File {
        /// The file.
        path: PathBuf,
        /// What the scene says of the file.
        options: ReadOptions,
    },
    /// A random field.
    Synthetic(HeightSynthesis),
    /// All heights zero.
    Flat,
}

/// Where the pin's fibre map comes from.
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
        /// How it becomes a fibre map.
        micrograph: Micrograph,
    },
    /// Random capsules.
    Synthetic(FibreSynthesis),
    /// All cells alike.
    Uniform(plateau_core::model::state::Base),
}

/// How many threads share the ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Workers {
    /// What is fastest on this machine.
    Auto,
    /// This many, at least 1.
    Count(usize),
}

/// What is written, where and when.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSettings {
    /// Run file, relative to the working directory.
    pub file: PathBuf,
    /// When samples are taken.
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
