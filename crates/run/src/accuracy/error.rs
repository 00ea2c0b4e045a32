//! Why errors cannot be measured, and whose fault that is.

use std::io;
use std::path::PathBuf;

use plateau_core::model::mesh::MeshError;
use plateau_core::simulation::SimulationError;
use plateau_io::number;
use plateau_io::run_file::ReadError;
use thiserror::Error;

use crate::error::signal_in_words;

use crate::error::RunError;

/// Why errors cannot be measured.
#[derive(Debug, Error)]
pub enum AccuracyError {
    /// What was asked for cannot be done.
    #[error(transparent)]
    Input(#[from] PlanError),
    /// The scene makes no run, or its first steps fail.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A coarser mesh is none.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A run without which nothing can be compared failed.
    #[error("{run}: {error}")]
    Failed {
        /// The run, in words.
        run: String,
        /// Why.
        error: Unfinished,
    },
    /// A signal came before anything could be compared.
    #[error("stopped by {} {moment}; nothing is written", signal_in_words(*signal))]
    Stopped {
        /// The signal.
        signal: u8,
        /// When, in words.
        moment: String,
    },
}

/// Why a run did not come to its end.
#[derive(Debug, Error)]
pub enum Unfinished {
    /// It could not be put together, or a step failed.
    #[error(transparent)]
    Failed(#[from] RunError),
    /// A quantity became infinite or no number.
    #[error("contact area or heights were no finite numbers after step {step}")]
    NotFinite {
        /// The step after which that was seen.
        step: u64,
    },
    /// This signal asked to stop.
    #[error("stopped by {}", signal_in_words(*.0))]
    Stopped(u8),
}

impl From<SimulationError> for Unfinished {
    fn from(error: SimulationError) -> Self {
        Self::Failed(error.into())
    }
}

/// Why there are no runs to compare.
#[derive(Debug, Error)]
pub enum PlanError {
    /// The reference is not finer than the scene.
    #[error(
        "the reference has time_acceleration = {reference}, the scene has {scene}: expected a reference that is finer than the \
         scene, or 1"
    )]
    NotFiner {
        /// Time acceleration of the reference.
        reference: f64,
        /// That of the scene, as it gives it.
        scene: String,
    },
    /// Nothing can be held against the reference.
    #[error(
        "nothing is coarser than the reference with time_acceleration = {reference}: choose other ladders or a longer duration"
    )]
    NothingToRun {
        /// Time acceleration of the reference.
        reference: f64,
    },
    /// The budget does not suffice.
    #[error(
        "the budget of {} is too small: at {} steps/s, as measured, {what} take about {}; give --budget {} or more{model}",
        number::duration(*budget), number::grouped(*speed as u64), number::duration(*needed), enough(*needed)
    )]
    TooSmall {
        /// The budget, s.
        budget: f64,
        /// Steps per second on the scene's mesh.
        speed: f64,
        /// The runs that it is for, in words.
        what: String,
        /// What they take, s.
        needed: f64,
        /// What a better reference would take, in words, if there is one.
        model: String,
    },
}

/// Why a run file is no reference of a scene.
#[derive(Debug, Error)]
pub enum ReferenceError {
    /// It cannot be read.
    #[error("{0}")]
    Read(#[from] ReadError),
    /// It cannot be digested.
    #[error("{}: {error}", path.display())]
    File {
        /// The run file.
        path: PathBuf,
        /// What the system says.
        #[source]
        error: io::Error,
    },
    /// The run did not come to its end.
    #[error("the reference {} is {state}, expected a run that is finished", path.display())]
    NotFinished {
        /// The run file.
        path: PathBuf,
        /// The state of the run.
        state: &'static str,
    },
    /// Its scene does not say how it was accelerated.
    #[error("the scene of the reference {} has no numerics.time_acceleration", path.display())]
    NoTimeAcceleration {
        /// The run file.
        path: PathBuf,
    },
    /// It is shorter or longer than the scene.
    #[error("the reference {} ends at {end} s, expected {expected} s as the scene says", path.display())]
    OtherEnd {
        /// The run file.
        path: PathBuf,
        /// Where it ends, s.
        end: f64,
        /// Where the scene does, s.
        expected: f64,
    },
    /// A series that is compared is not there.
    #[error("the reference {} has no series {name}", path.display())]
    NoSeries {
        /// The run file.
        path: PathBuf,
        /// The series.
        name: &'static str,
    },
    /// It is a run of another scene.
    #[error(
        "the reference {} is a run of another scene; only numerics and output may differ:{differences}",
        path.display()
    )]
    OtherScene {
        /// The run file.
        path: PathBuf,
        /// What differs, a line each.
        differences: String,
    },
}

/// A budget that suffices, as it is given on the command line: with room, for what is needed (s) is an estimate.
pub(super) fn enough(needed: f64) -> String {
    format!("{}s", (1.2 * needed).ceil().max(1.0))
}
