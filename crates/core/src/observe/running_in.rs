//! Running in: whether a run is still at it, by the change of its mean contact area in its second half, and how long that takes to rise
//! and fall once; and the time after which a quantity has come to a fraction of its value at the end of the run. The one definition for the
//! summary, the report and `reaches` of studies.

use serde::Serialize;
use thiserror::Error;

use crate::model::parameters::Parameters;
use crate::model::state::Base;
use crate::observe::window_mean::{Cumulative, LEAST_PARTS, LEAST_PULSES, ROUNDING, WindowMean, error_of_mean};
use crate::surface::fibre_fraction;

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

/// Error of a time that is not defined, see [`time_to`].
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum NotDefined {
    #[error(
        "not defined: too few samples or simulated revolutions; {LEAST_WINDOWS} in the run and {LEAST_PARTS} in each quarter of its second half are needed"
    )]
    TooShort,
    #[error("not defined: it has samples without a value, or ends at 0")]
    NoValue,
    #[error("not defined: still {} at the end, by {:.1} % from the third quarter of the run to the last", if *.0 > 0.0 { "rises" } else { "falls" }, 100.0 * .0.abs())]
    NotSteady(f64),
    #[error("not defined: cannot be told from a run of this length whether it still changes, by {:+.1} ± {:.1} % from the third quarter to the last", 100.0 * .0, 100.0 * .1)]
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

/// Time as of [`time_to`] in a run with a cycle, of which `contact_time` is the series (s, since t = 0): windows are parts of the time in
/// contact, and the time in which the pin is lifted counts for nothing. The answer is a time of the run, s.
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

/// The fraction of the value at the end with which a run counts as run in.
pub const RUN_IN: f64 = 0.9;
/// Standard errors from which on a change is not taken for chance: 2.5 times in a hundred in either direction.
const BEYOND_CHANCE: f64 = 2.0;
/// Parts of what is missing at a fraction of the last value, and with no fraction a tenth: a change of less than the first counts as none,
/// and a run that may hide a larger one than the second tells nothing.
const NEGLIGIBLE: f64 = 0.1;
const OF_INTEREST: f64 = 0.5;
/// Missing part of the last value where no fraction is asked for: that at the running-in time of a summary. So 1 % is negligible and
/// 5 % is of interest.
const MISSING: f64 = 1.0 - RUN_IN;

/// The last quarter of a run beside the one before it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Drift {
    /// Mean over the third quarter.
    pub third_quarter: WindowMean,
    /// Mean over the last quarter.
    pub last_quarter: WindowMean,
    /// Change from one to the other, as a part of the mean of the third.
    pub change: f64,
    /// Standard error of the change, in the same measure: of what varies about a straight line through both quarters, for a steady rise
    /// is no chance; as if both quarters were independent.
    pub standard_error: f64,
    /// Pulses of the contact area in a quarter, at most; none where nothing pulses or that is not known.
    pub pulses: Option<f64>,
}

/// Trend of a mean, by its change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trend {
    /// Rise by more than chance explains.
    Rises,
    /// Fall by more than chance explains.
    Falls,
    /// Change by less than is of interest, and by no more than chance or next to nothing.
    Steady,
    /// Chance may hide a change that is of interest.
    Unknown,
    /// Quarters with too few pulses to tell.
    TooShort,
}

impl Drift {
    /// Drift of a run whose contact area pulses in this time, s, or longer; none where a quarter has too few samples or
    /// simulated revolutions for a standard error, or nothing to compare with.
    pub fn of(samples: &Cumulative<'_>, pulse_time: Option<f64>) -> Option<Self> {
        let end = *samples.time.last()?;
        let quarter = |from: f64, to: f64| samples.mean(from * end, to * end);
        let (third, last) = (quarter(0.5, 0.75)?, quarter(0.75, 1.0)?);
        let parts = [&third, &last].map(|quarter| samples.parts(quarter.from, quarter.to));
        let parts = parts[0].min(parts[1]);
        if parts < LEAST_PARTS || third.mean <= 0.0 {
            return None;
        }
        let rest = beside_a_line(&samples.means_of_parts(third.from, last.to, 2 * parts));
        Some(Self {
            third_quarter: third,
            last_quarter: last,
            change: (last.mean - third.mean) / third.mean,
            standard_error: 2.0_f64.sqrt() * error_of_mean(&rest, parts) / third.mean,
            pulses: pulse_time.map(|time| 0.25 * end / time),
        })
    }

    /// Trend by the change.
    pub fn trend(&self) -> Trend {
        self.trend_beside(MISSING)
    }

    /// Trend where this part of the last value is missing, but no more than in [`trend`](Self::trend): less is finer.
    pub(super) fn trend_beside(&self, missing: f64) -> Trend {
        let missing = missing.min(MISSING);
        let chance = BEYOND_CHANCE * self.standard_error;
        let is_negligible = self.change.abs() <= NEGLIGIBLE * missing * (1.0 + ROUNDING);
        match self.change {
            _ if self.pulses.is_some_and(|pulses| pulses < LEAST_PULSES) => Trend::TooShort,
            change if change > chance && !is_negligible => Trend::Rises,
            change if change < -chance && !is_negligible => Trend::Falls,
            change if change.abs() + chance <= OF_INTEREST * missing * (1.0 + ROUNDING) => Trend::Steady,
            _ => Trend::Unknown,
        }
    }
}

/// Residuals of values about their least-squares line.
pub(super) fn beside_a_line(values: &[f64]) -> Vec<f64> {
    let middle = 0.5 * (values.len() as f64 - 1.0);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let places = || (0..values.len()).map(|place| place as f64 - middle);
    let slope = places().zip(values).map(|(place, value)| place * value).sum::<f64>()
        / places().map(|place| place * place).sum::<f64>();
    places().zip(values).map(|(place, value)| value - mean - slope * place).collect()
}

/// Time of one pulse of the contact area at constant load and speed, s, at least: T = h_m φ A/(κ F_N v). Resin that touches loses its
/// wear height h_m at once (model 4.2), and touches again when the fibres, of area φ A and specific wear rate κ, have worn as far.
/// Build-up beside the fibres has to wear as well, and makes it longer. `base` is that of the pin's cells.
///
/// None where load or speed change with time, where there is no resin, or nothing wears.
pub fn pulse_time(parameters: &Parameters, base: &[Base]) -> Option<f64> {
    if parameters.cycle.is_some() || !base.contains(&Base::Resin) {
        return None;
    }
    let (materials, mesh) = (&parameters.materials, &parameters.mesh);
    let fibre_area = fibre_fraction(base, mesh) * mesh.pin_area();
    let sliding_speed = parameters.angular_velocity * mesh.mean_radius();
    let worn_per_second = materials.pin_primary.specific_wear_rate * parameters.usual_load() * sliding_speed;
    let time = materials.wear_height * fibre_area / worn_per_second;
    (time > 0.0 && time.is_finite()).then_some(time)
}
