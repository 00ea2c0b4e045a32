//! The mean contact area at the end of a run.

use std::f64::consts::TAU;

use plateau_core::observe::drift::Drift;
use plateau_core::observe::window_mean::{Cumulative, WindowMean};

use super::{ReadError, RunFile};

impl RunFile {
    /// The mean contact area over the last tenth of the run, m², as far as it is recorded: see
    /// [`Cumulative::mean_of_last_tenth`]. None without samples or without the series.
    ///
    /// # Errors
    /// [`ReadError::Damaged`] when a series cannot be read.
    pub fn last_contact_area(&self) -> Result<Option<WindowMean>, ReadError> {
        self.of_contact_area(|samples| samples.mean_of_last_tenth())
    }

    /// What the mean contact area changed by in the second half of the run: see [`Drift`]. None where that cannot be told, and of a
    /// run with a cycle, whose contact area follows load and speed.
    ///
    /// # Errors
    /// [`ReadError::Damaged`] when a series cannot be read.
    pub fn drift_of_contact_area(&self) -> Result<Option<Drift>, ReadError> {
        if self.scene().get("operation").is_some_and(|operation| operation.get("cycle").is_some()) {
            return Ok(None);
        }
        self.of_contact_area(Drift::of)
    }

    fn of_contact_area<T>(&self, look: impl FnOnce(&Cumulative<'_>) -> Option<T>) -> Result<Option<T>, ReadError> {
        let Some(integral) = self.values("contact_area_integral")? else { return Ok(None) };
        let revolutions = self.revolutions()?.unwrap_or_default();
        Ok(look(&Cumulative { time: self.time(), integral: &integral, revolutions: &revolutions }))
    }

    /// Simulated revolutions from t = 0 to every sample, where the sliding distance is recorded: a simulated revolution stands
    /// for as many as the time acceleration says.
    fn revolutions(&self) -> Result<Option<Vec<f64>>, ReadError> {
        let Some(distance) = self.values("sliding_distance")? else { return Ok(None) };
        let accelerations = match self.values("time_acceleration")? {
            Some(chosen) => chosen,
            None => vec![self.given_acceleration(); distance.len()],
        };
        let way = TAU * self.mesh().mean_radius();
        let (mut before, mut turns) = (0.0, 0.0);
        let turned = distance.iter().zip(&accelerations).map(|(distance, acceleration)| {
            turns += (distance - before) / (way * acceleration);
            before = *distance;
            turns
        });
        Ok(Some(turned.collect()))
    }

    /// The time acceleration of the scene; 1 where there was none to choose.
    fn given_acceleration(&self) -> f64 {
        let given = self.scene().get("numerics").and_then(|numerics| numerics.get("time_acceleration"));
        let number = given.and_then(|given| given.as_float().or_else(|| given.as_integer().map(|given| given as f64)));
        number.unwrap_or(1.0)
    }
}
