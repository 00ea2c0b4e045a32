//! Reasons why errors cannot be measured, which tell whose fault that is.

use std::io;

use plateau_core::simulation::SimulationError;
use plateau_io::number;
use plateau_io::run_file::ReadError;
use plateau_io::scene::SceneError;
use thiserror::Error;

use crate::error::{RunError, signal_in_words};

/// Reason why errors cannot be measured.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum AccuracyError {
    #[error(transparent)]
    Input(#[from] PlanError),
    /// The scene makes no run, or its first steps fail.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A run without which nothing can be compared failed.
    #[error("{run}: {error}")]
    Failed { run: String, error: Unfinished },
    /// A signal came before anything could be compared.
    #[error("stopped by {} {moment}; nothing is written", signal_in_words(*signal))]
    Stopped { signal: u8, moment: String },
}

/// Reason why a run did not come to its end.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum Unfinished {
    /// Run that could not be put together, or a step of it that failed.
    #[error(transparent)]
    Failed(#[from] RunError),
    #[error("contact area or heights were no finite numbers after step {step}")]
    NotFinite { step: u64 },
    #[error("stopped by {}", signal_in_words(*.0))]
    Stopped(u8),
}

impl From<SimulationError> for Unfinished {
    fn from(error: SimulationError) -> Self {
        Self::Failed(error.into())
    }
}

/// Reason why there are no runs to compare.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum PlanError {
    /// The scene does not take the time acceleration of the reference.
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error("the reference has time_acceleration = {reference}: expected {}", expected(*own, *needs_model))]
    NotFiner {
        reference: f64,
        own: f64,
        /// True if nothing but the model itself judges runs of the scene.
        needs_model: bool,
    },
    #[error(
        "nothing is coarser than the reference with time_acceleration = {reference}: choose other ladders or a longer \
         duration{}",
        also(notes)
    )]
    NothingToRun { reference: f64, notes: Vec<String> },
    #[error(
        "the budget of {} is too small: at {} steps/s, as measured, a reference with time_acceleration = {reference} needs a \
         budget of {}; give --budget {} or more{}",
        number::duration(*budget), number::grouped(*speed as u64), number::duration(*needed), enough(*needed),
        or_model(*reference, *of_model)
    )]
    TooSmall {
        budget: f64,
        speed: f64,
        /// Time acceleration of the reference that needs the smallest budget.
        reference: f64,
        /// Budget with it, s.
        needed: f64,
        /// Budget with the model itself as the reference, s.
        of_model: f64,
    },
}

fn expected(own: f64, needs_model: bool) -> String {
    if needs_model {
        "1, the model itself, for a scene that chooses its acceleration, and on a smooth disc with pooled debris"
            .to_owned()
    } else {
        format!("less than the scene's time_acceleration = {own}, or 1")
    }
}

fn also(notes: &[String]) -> String {
    notes.iter().flat_map(|note| ["; ", note.as_str()]).collect()
}

fn or_model(reference: f64, needed: f64) -> String {
    if reference == 1.0 { String::new() } else { format!(", or {} for 1, the model itself", enough(needed)) }
}

/// Reason why a run file is no reference of a scene.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum ReferenceError {
    #[error("{0}")]
    Read(#[from] ReadError),
    /// File that cannot be digested.
    #[error("{0}: {1}")]
    File(String, #[source] io::Error),
    /// Run of another scene, or without what is compared.
    #[error("{0}")]
    Refused(String),
}

/// A budget that suffices, as it is given on the command line: with room, for what is needed (s) is an estimate.
pub(super) fn enough(needed: f64) -> String {
    format!("{}s", (1.2 * needed).ceil().max(1.0))
}
