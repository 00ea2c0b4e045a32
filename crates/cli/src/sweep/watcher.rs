//! Who looks on while a run of a study is made, and how it may end before its end.

use plateau_core::simulation::SimulationError;
use plateau_io::scene::Scene;
use plateau_io::surface::Loaded;
use plateau_run::RunError;

/// Whether a run goes on, and what others want to know meanwhile.
pub trait Watcher: Sync {
    /// Told how many steps were taken since the last time, about ten times a second; the signal that ends the run, if
    /// there was one.
    fn steps(&self, count: u64) -> Option<u8>;

    /// Told of the surfaces of a run before its first step.
    fn surfaces(&self, scene: &Scene, loaded: &Loaded);

    /// Told when a run does not begin at its beginning.
    fn goes_on(&self, steps: u64);
}

/// A signal ended the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopped(pub u8);

/// Why a run did not finish.
pub enum Ended {
    /// A signal came.
    Stopped(u8),
    /// What went wrong.
    Failed(String),
}

impl From<SimulationError> for Ended {
    fn from(error: SimulationError) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<RunError> for Ended {
    fn from(error: RunError) -> Self {
        Self::Failed(error.to_string())
    }
}
