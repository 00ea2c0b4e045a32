//! How long the runs of a study are.

use plateau_core::observe::window_mean::LEAST_REVOLUTIONS;
use plateau_io::scene::Scene;

use crate::number;

/// How long a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunLength {
    /// Its duration, s.
    pub duration: f64,
    /// Its simulated revolutions; none where it chooses its time acceleration as it goes.
    pub revolutions: Option<f64>,
}

impl RunLength {
    /// That of a scene: a step takes the pin on by a column of the disc.
    pub fn of(scene: &Scene) -> Self {
        let revolutions = scene.steps as f64 / scene.parameters.mesh.disc_columns() as f64;
        Self { duration: scene.duration, revolutions: scene.adaptive.is_none().then_some(revolutions) }
    }

    /// Over what part of the run a mean over its last tenth is taken, at the end of it.
    pub fn part(&self) -> f64 {
        self.revolutions.map_or(0.1, |turns| (LEAST_REVOLUTIONS / turns).clamp(0.1, 1.0))
    }
}

/// A time in words.
pub fn seconds(time: f64) -> String {
    format!("{} s", number::rounded(time, 6))
}
