//! Whether a run is still running in, when it had run in, and over which time its contact area is averaged, in words.

use plateau_core::observe::drift::{Drift, LEAST_PULSES, RUN_IN, Trend};
use plateau_core::observe::running_in::NotDefined;
use plateau_core::observe::window_mean::WindowMean;
use plateau_io::number;
use plateau_io::run_file::NoDrift;

/// Whether the mean contact area still changes, in words, or why that cannot be told.
pub fn running_in(found: &Result<Drift, NoDrift>) -> String {
    let drift = match found {
        Ok(drift) => drift,
        Err(reason) => return reason.to_string(),
    };
    let Drift { third_quarter, last_quarter, change, standard_error, pulses } = drift;
    if let (Trend::TooShort, Some(pulses)) = (drift.trend(), pulses) {
        let pulses = number::rounded(*pulses, 2);
        return format!(
            "cannot be told: a quarter of the run has at most {pulses} pulses of the contact area, {LEAST_PULSES} are needed"
        );
    }
    let percent = number::with_error(100.0 * change, Some(100.0 * standard_error));
    let sign = if *change > 0.0 { "+" } else { "" };
    let [start, middle, end] =
        [third_quarter.from, last_quarter.from, last_quarter.to].map(|time| number::rounded(time, 4));
    let found = match drift.trend() {
        Trend::Rises => "contact area still rises",
        Trend::Falls => "contact area still falls",
        Trend::Steady => "contact area is steady",
        Trend::Unknown | Trend::TooShort => "cannot be told from a run of this length",
    };
    format!("{found}: {sign}{percent} % from {start} … {middle} s to {middle} … {end} s")
}

/// When the contact area had come to its value at the end, in words.
pub fn running_in_time(found: &Result<f64, NotDefined>) -> String {
    match found {
        Ok(time) => {
            format!("{} s, to {:.0} % of the contact area at the end", number::rounded(*time, 4), 100.0 * RUN_IN)
        }
        Err(reason) => reason.to_string(),
    }
}

/// Over how much of its part a mean of the contact area is, behind that part; nothing where it is all of it.
pub fn in_contact(window: &WindowMean) -> String {
    window.contact_time.map_or(String::new(), |time| {
        format!(
            ", of which {} s in contact: the time in which the pin is lifted, and before the first step, does not count",
            number::rounded(time, 4)
        )
    })
}

#[cfg(test)]
mod tests {
    use plateau_core::observe::window_mean::WindowMean;

    use super::*;

    #[test]
    fn the_change_in_the_second_half_is_told_with_its_error() {
        let quarter = |from: f64, to: f64, mean: f64| WindowMean {
            from,
            to,
            revolutions: None,
            contact_time: None,
            mean,
            standard_error: Some(0.02e-6),
        };
        let with = |change: f64, standard_error: f64, pulses: Option<f64>| {
            running_in(&Ok(Drift {
                third_quarter: quarter(30.0, 45.0, 1e-6),
                last_quarter: quarter(45.0, 60.0, (1.0 + change) * 1e-6),
                change,
                standard_error,
                pulses,
            }))
        };
        let of = |change: f64, standard_error: f64| with(change, standard_error, Some(3.0));
        assert_eq!(
            with(0.12, 0.03, Some(0.6)),
            "cannot be told: a quarter of the run has at most 0.6 pulses of the contact area, 3 are needed"
        );
        assert_eq!(with(0.12, 0.03, None), of(0.12, 0.03));
        assert_eq!(of(0.12, 0.03), "contact area still rises: +12.0 ± 3.0 % from 30 … 45 s to 45 … 60 s");
        assert_eq!(of(-0.12, 0.03), "contact area still falls: -12.0 ± 3.0 % from 30 … 45 s to 45 … 60 s");
        assert_eq!(
            of(0.05, 0.03),
            "cannot be told from a run of this length: +5.0 ± 3.0 % from 30 … 45 s to 45 … 60 s"
        );
        assert_eq!(
            running_in(&Err(NoDrift::Cycle)),
            "cannot be told: with a cycle the contact area follows load and speed"
        );
        assert_eq!(of(0.01, 0.01), "contact area is steady: +1.0 ± 1.0 % from 30 … 45 s to 45 … 60 s");
    }

    #[test]
    fn the_running_in_time_is_told_or_why_there_is_none() {
        assert_eq!(running_in_time(&Ok(1225.0)), "1225 s, to 90 % of the contact area at the end");
        assert_eq!(
            running_in_time(&Err(NotDefined::NotSteady(0.102))),
            "not defined: still rises at the end, by 10.2 % in the last quarter of the run"
        );
    }
}
