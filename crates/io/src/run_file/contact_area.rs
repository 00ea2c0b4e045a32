//! The mean contact area at the end of a run.

use std::f64::consts::TAU;

use plateau_core::observe::drift::Drift;
use plateau_core::observe::pulse::pulse_time;
use plateau_core::observe::running_in::{NotDefined, RUN_IN, time_to};
use plateau_core::observe::window_mean::{Cumulative, WindowMean, last_tenth};

use super::{ReadError, RunFile};
use crate::scene;

/// What the contact area of a run was at its end; nothing of it where that cannot be told.
#[derive(Debug, Clone, Copy, Default)]
pub struct ContactArea {
    /// The mean over the last tenth of the run, m², as far as it is recorded: see [`last_tenth`]. Of a run with a cycle over the time
    /// in contact.
    pub last_tenth: Option<WindowMean>,
    /// What the mean changed by in the second half of the run; none of a run with a cycle, whose contact area follows load and speed.
    pub drift: Option<Drift>,
    /// When it has come to 90 % of its value at the end, s; none of a run with a cycle.
    pub running_in: Option<Result<f64, NotDefined>>,
}

impl RunFile {
    /// The contact area at the end of the run, as far as it is recorded.
    ///
    /// # Errors
    /// [`ReadError::Damaged`] when a series cannot be read.
    pub fn contact_area(&self) -> Result<ContactArea, ReadError> {
        let Some(integral) = self.values("contact_area_integral")? else { return Ok(ContactArea::default()) };
        let revolutions = self.revolutions()?.unwrap_or_default();
        let samples = Cumulative { time: self.time(), integral: &integral, revolutions: &revolutions };
        let has_cycle = self.scene().get("operation").is_some_and(|operation| operation.get("cycle").is_some());
        let (drift, running_in) = match has_cycle {
            true => (None, None),
            false => (Drift::of(&samples, self.pulse_time()), Some(time_to(RUN_IN, &samples))),
        };
        let last_tenth = last_tenth(samples.time, samples.revolutions).and_then(|(from, to)| {
            match self.values("contact_time").transpose() {
                Some(contact_time) => contact_time.map(|series| samples.mean_in_contact(&series, from, to)).transpose(),
                None => samples.mean(from, to).map(Ok),
            }
        });
        Ok(ContactArea { last_tenth: last_tenth.transpose()?, drift, running_in })
    }

    /// Time of a pulse of the contact area, s, at least; none where nothing pulses, or the file does not tell.
    fn pulse_time(&self) -> Option<f64> {
        let scene = scene::of_text(self.path(), &self.attribute("scene")?).ok()?;
        pulse_time(&scene.parameters, &self.bases().ok()??)
    }

    /// Simulated revolutions from t = 0 to every sample, where the sliding distance is recorded: a simulated revolution stands
    /// for as many as the time acceleration says.
    fn revolutions(&self) -> Result<Option<Vec<f64>>, ReadError> {
        let Some(distance) = self.values("sliding_distance")? else { return Ok(None) };
        let accelerations = match self.values("time_acceleration")? {
            Some(chosen) => chosen,
            None => vec![self.given_acceleration().unwrap_or(1.0); distance.len()],
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

    /// The time acceleration of the scene, if that is a number.
    pub fn given_acceleration(&self) -> Option<f64> {
        let given = self.scene().get("numerics").and_then(|numerics| numerics.get("time_acceleration"));
        given.and_then(|given| given.as_float().or_else(|| given.as_integer().map(|given| given as f64)))
    }
}
