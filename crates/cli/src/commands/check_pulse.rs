//! What `plateau check` reports of the pulses of the contact area, and whether the run is long enough for them.

use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::Base;
use plateau_core::observe::pulse::pulse_time;
use plateau_core::observe::window_mean::LEAST_REVOLUTIONS;
use serde::Serialize;

use crate::number;

/// Pulses that the last tenth of a run should hold (docs/faq.md).
const WANTED: f64 = 5.0;
/// What rounding may take off a number of pulses or revolutions.
const ROUNDING: f64 = 1e-9;

/// The last tenth of a run beside a pulse of its contact area.
#[derive(Debug, Serialize)]
pub(super) struct PulseReport {
    /// Time of a pulse, s, at least.
    pulse_time: f64,
    /// The last tenth of the run, s.
    last_tenth: f64,
    /// Simulated revolutions in it.
    revolutions: f64,
}

impl PulseReport {
    /// That of a run of so many steps; none where nothing pulses, or load and speed change with time.
    pub(super) fn of(parameters: &Parameters, base: &[Base], steps: u64) -> Option<Self> {
        let run = steps as f64;
        Some(Self {
            pulse_time: pulse_time(parameters, base)?,
            last_tenth: 0.1 * run * parameters.step_time(),
            revolutions: 0.1 * run / parameters.mesh.disc_columns() as f64,
        })
    }

    /// In words.
    pub(super) fn text(&self) -> String {
        let Self { pulse_time, last_tenth, revolutions } = *self;
        let enough = |found: f64, wanted: f64| found >= wanted * (1.0 - ROUNDING);
        let seconds = |time: f64| format!("{} s", number::rounded(time, 3));
        let pulses = last_tenth / pulse_time;
        let mut text = format!(
            "the shortest pulse takes {}; the last tenth of the run, {}, has at most {}",
            seconds(pulse_time),
            seconds(last_tenth),
            number::rounded(pulses, 2)
        );
        if !enough(pulses, WANTED) {
            let wanted = seconds(10.0 * WANTED * pulse_time);
            text += &format!(", and a mean needs at least {WANTED}: the run must be longer than {wanted}");
            // As long as the mean is that the run will tell, where the run has so many revolutions.
            if !enough(revolutions, LEAST_REVOLUTIONS) && enough(10.0 * revolutions, LEAST_REVOLUTIONS) {
                let window = seconds(last_tenth * LEAST_REVOLUTIONS / revolutions);
                text += &format!("; its mean is over the last {window}, {LEAST_REVOLUTIONS} simulated revolutions");
            }
        } else if !enough(revolutions, LEAST_REVOLUTIONS) {
            let found = number::rounded(revolutions, 2);
            text += &format!(
                ": a mean needs {LEAST_REVOLUTIONS} simulated revolutions, and these are {found}: a smaller time_acceleration gives more"
            );
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_is_too_short_is_told_how_long_it_should_be() {
        let of = |last_tenth: f64, revolutions: f64| PulseReport { pulse_time: 27.0, last_tenth, revolutions }.text();
        assert_eq!(
            of(6.0, 8.5),
            "the shortest pulse takes 27 s; the last tenth of the run, 6 s, has at most 0.22, and a mean needs at least 5: the run must be longer than 1350 s; \
             its mean is over the last 7.06 s, 10 simulated revolutions"
        );
        assert!(of(6.0, 0.85).ends_with("the run must be longer than 1350 s"), "{}", of(6.0, 0.85));
        assert_eq!(of(270.0, 380.0), "the shortest pulse takes 27 s; the last tenth of the run, 270 s, has at most 10");
        assert!(
            of(270.0, 3.8).ends_with("these are 3.8: a smaller time_acceleration gives more"),
            "{}",
            of(270.0, 3.8)
        );
    }
}
