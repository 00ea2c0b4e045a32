//! When a run has run in: the time after which a quantity has come to a fraction of its value at the end of the run. The one
//! definition for the summary, the report and `reaches` of studies.

use thiserror::Error;

use super::drift::{Drift, LEAST_PULSES, Trend, beside_a_line};
use super::window_mean::{Cumulative, LEAST_PARTS};

/// Windows of a run, at most: each is a sixtieth of it, 50 s of the 3000 s of the paper.
const WINDOWS: usize = 60;
/// Windows from which on there is a history.
const LEAST_WINDOWS: usize = 20;
/// Windows at the end that tell the last value: the last 100 s of 3000 s.
const LAST: usize = 2;
/// Part of the range of the noise that the way back of a monotone curve may exceed it by: there are twice as many windows in which
/// the largest can be found.
const BEYOND_RANGE: f64 = 0.25;
/// Part of the later windows that may be short of the fraction again: with more, the first that is not is one by chance.
const SHORT_AGAIN: f64 = 0.1;

/// Why the time is not defined.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum NotDefined {
    #[error(
        "not defined: too few samples or simulated revolutions; {LEAST_WINDOWS} in the run and {LEAST_PARTS} in each quarter of its second half are needed"
    )]
    TooShort,
    #[error("not defined: it has samples without a value, or ends at 0")]
    NoValue,
    #[error("not defined: still {} at the end, by {:.1} % in the last quarter of the run", if *.0 > 0.0 { "rises" } else { "falls" }, 100.0 * .0.abs())]
    NotSteady(f64),
    #[error("not defined: cannot be told from a run of this length whether it still changes, by {:+.1} ± {:.1} % in the last quarter", 100.0 * .0, 100.0 * .1)]
    Unknown(f64, f64),
    #[error("not defined: a quarter of the run has at most {:.1} pulses of the contact area, {LEAST_PULSES} are needed", .0)]
    FewPulses(f64),
    #[error("not defined: {:.0} % of the windows after the first that reaches it are short of it again, {:.0} % at most are noise", 100.0 * .0, 100.0 * SHORT_AGAIN)]
    ShortAgain(f64),
    #[error("not defined: neither rises nor falls all along, it goes back by {:.1} % of its last value", 100.0 * .0)]
    NotMonotone(f64),
}

/// The time, s, at which a quantity first comes to `fraction` of its last value, or, from above, to its last value over the
/// fraction: the middle of the first window whose mean does. Windows are sixtieths of the run, but no shorter than a simulated
/// revolution or an interval between samples; the last value is the mean of the last two.
///
/// `pulse_time` is that of the pulses of the contact area, s, as far as it is one and that is known.
///
/// # Errors
/// [`NotDefined`] unless the quantity is steady by [`Drift`] in the second half of the run: it has three pulses in a quarter, and from
/// the third quarter to the last its mean changes neither by more than chance (and by more than a tenth of what is missing at that
/// fraction, 1 % at most), nor, with two standard errors, by more than half of that (5 % at most). Also where the means go back by more
/// than the range of what varies about a straight line in the second half of the run, or more than a tenth of the later windows is short
/// of the fraction again.
pub fn time_to(fraction: f64, samples: &Cumulative<'_>, pulse_time: Option<f64>) -> Result<f64, NotDefined> {
    let end = *samples.time.last().ok_or(NotDefined::TooShort)?;
    if samples.integral.len() != samples.time.len() {
        return Err(NotDefined::NoValue);
    }
    let windows = samples.parts(0.0, end).min(WINDOWS);
    if windows < LEAST_WINDOWS {
        return Err(NotDefined::TooShort);
    }
    let mut means = samples.means_of_parts(0.0, end, windows);
    let last = means[windows - LAST..].iter().sum::<f64>() / LAST as f64;
    if last == 0.0 || !means.iter().all(|mean| mean.is_finite()) {
        return Err(NotDefined::NoValue);
    }
    // Everything as a part of the last value, which is 1 then.
    means.iter_mut().for_each(|mean| *mean /= last);
    let integral: Vec<f64> = samples.integral.iter().map(|integral| integral / last).collect();
    let drift = Drift::of(&Cumulative { integral: &integral, ..*samples }, pulse_time).ok_or(NotDefined::TooShort)?;
    match drift.trend_beside(1.0 - fraction) {
        Trend::Steady => {}
        Trend::Rises | Trend::Falls => return Err(NotDefined::NotSteady(drift.change)),
        Trend::Unknown => return Err(NotDefined::Unknown(drift.change, drift.standard_error)),
        Trend::TooShort => return Err(NotDefined::FewPulses(drift.pulses.unwrap_or_default())),
    }
    let rises = means[0] <= 1.0;
    if !rises {
        means.iter_mut().for_each(|mean| *mean = -*mean);
    }
    let rest = beside_a_line(&means[windows / 2..]);
    let noise =
        rest.iter().copied().fold(f64::NEG_INFINITY, f64::max) - rest.iter().copied().fold(f64::INFINITY, f64::min);
    let mut highest = f64::NEG_INFINITY;
    let back = means.iter().fold(0.0_f64, |back, mean| {
        highest = highest.max(*mean);
        back.max(highest - mean)
    });
    // Rounding of the integral is no way back.
    if back > (1.0 + BEYOND_RANGE) * noise + 1e-9 {
        return Err(NotDefined::NotMonotone(back));
    }
    let near = if rises { fraction } else { -1.0 / fraction };
    let first = means.iter().position(|mean| *mean >= near).ok_or(NotDefined::NoValue)?;
    let later = &means[first..];
    let short_again = later.iter().filter(|mean| **mean < near).count() as f64 / later.len() as f64;
    if short_again > SHORT_AGAIN {
        return Err(NotDefined::ShortAgain(short_again));
    }
    Ok((first as f64 + 0.5) * end / windows as f64)
}

/// The same of a run with a cycle, of which `contact_time` is the series (s, since t = 0): windows are parts of the time in contact, and
/// the time in which the pin is lifted counts for nothing. The answer is a time of the run, s.
///
/// # Errors
/// Those of [`time_to`].
pub fn time_to_in_contact(fraction: f64, samples: &Cumulative<'_>, contact_time: &[f64]) -> Result<f64, NotDefined> {
    if contact_time.len() != samples.time.len() {
        return Err(NotDefined::NoValue);
    }
    let [time, integral, revolutions] = samples.on_contact_time(contact_time);
    // Where load and speed change, so does the time of a pulse.
    let found = time_to(fraction, &Cumulative { time: &time, integral: &integral, revolutions: &revolutions }, None)?;
    let after = contact_time.partition_point(|time| *time < found);
    let ends = |values: &[f64]| Some((after.checked_sub(1).map_or(0.0, |before| values[before]), *values.get(after)?));
    let ((from, to), (start, end)) = ends(contact_time).zip(ends(samples.time)).ok_or(NotDefined::NoValue)?;
    Ok(start + (end - start) * (found - from) / (to - from))
}
