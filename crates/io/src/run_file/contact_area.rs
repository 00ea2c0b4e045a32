//! The mean contact area at the end of a run.

use std::f64::consts::TAU;

use plateau_core::observe::drift::pulse_time;
use plateau_core::observe::drift::{Drift, RUN_IN};
use plateau_core::observe::running_in::{NotDefined, time_to, time_to_in_contact};
use plateau_core::observe::window_mean::{Cumulative, LEAST_PARTS, WindowMean, last_tenth};
use thiserror::Error;

use super::{ReadError, RunFile};
use crate::scene;

/// Contact area of a run at its end.
#[derive(Debug, Clone, Copy)]
pub struct ContactArea {
    /// The mean over the last tenth of the run, m², as far as it is recorded: see [`last_tenth`]. Of a run with a cycle over the time
    /// in contact.
    pub last_tenth: Option<WindowMean>,
    /// Change of the mean in the second half of the run, or why that is not told.
    pub drift: Result<Drift, NoDrift>,
    /// Time at which it has come to 90 % of its value at the end, s, or why that is not defined. Of a run with a cycle over the time in contact.
    pub running_in: Result<f64, NotDefined>,
}

/// Reason why it is not told whether a run is still running in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum NoDrift {
    /// The contact area follows load and speed.
    #[error("cannot be told: with a cycle the contact area follows load and speed")]
    Cycle,
    /// There is nothing to compare.
    #[error(
        "cannot be told: too few samples or simulated revolutions; {LEAST_PARTS} in each quarter of the second half are needed"
    )]
    TooShort,
}

impl RunFile {
    /// The contact area at the end of the run, as far as it is recorded.
    pub fn contact_area(&self) -> Result<ContactArea, ReadError> {
        let integral = self.values("contact_area_integral")?.unwrap_or_default();
        // Without the integral there are no samples of it.
        let time = if integral.is_empty() { &[] } else { self.time() };
        let revolutions = self.revolutions()?.unwrap_or_default();
        let samples = Cumulative { time, integral: &integral, revolutions: &revolutions };
        let contact_time = self.values("contact_time")?;
        let window = last_tenth(samples.time, samples.revolutions);
        Ok(match contact_time {
            Some(contact_time) => ContactArea {
                last_tenth: window.and_then(|(from, to)| samples.mean_in_contact(&contact_time, from, to)),
                drift: Err(NoDrift::Cycle),
                running_in: time_to_in_contact(RUN_IN, &samples, &contact_time),
            },
            None => {
                let pulse_time = self.pulse_time();
                ContactArea {
                    last_tenth: window.and_then(|(from, to)| samples.mean(from, to)),
                    drift: Drift::of(&samples, pulse_time).ok_or(NoDrift::TooShort),
                    running_in: time_to(RUN_IN, &samples, pulse_time),
                }
            }
        })
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
