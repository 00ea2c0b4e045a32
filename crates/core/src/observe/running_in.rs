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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::random::{Random, Stream};

    /// The answer of a quantity with this integral, of which there are 600 samples in 600 s.
    fn of(fraction: f64, integral: impl Fn(f64) -> f64) -> Result<f64, NotDefined> {
        let time: Vec<f64> = (1..=600).map(f64::from).collect();
        let integral: Vec<f64> = time.iter().map(|time| integral(*time)).collect();
        time_to(fraction, &Cumulative { time: &time, integral: &integral, revolutions: &[] }, None)
    }

    /// The integral of 1 + (a − 1) exp(−t/τ).
    fn saturating(start: f64, tau: f64) -> impl Fn(f64) -> f64 {
        move |time| time + (start - 1.0) * tau * (1.0 - (-time / tau).exp())
    }

    #[test]
    fn a_curve_that_saturates_is_run_in_where_its_closed_form_is() {
        // 1 − exp(−t/50 s) is 0.9 at 115.1 s: by hand, the first window of 10 s whose mean, 1 − 5 exp(−t/50)(1 − exp(−1/5)), is 0.9 or more is
        // that from 120 s on: 0.918; that from 110 s on has 0.8996.
        assert_eq!(of(0.9, saturating(0.0, 50.0)), Ok(125.0));
        // From above, to 1/0.9: 1 + exp(−t/50 s) is 1.111 at 109.9 s, and its mean from 100 s on is 1.1227, from 110 s on 1.1004.
        assert_eq!(of(0.9, saturating(2.0, 50.0)), Ok(115.0));
        // It does not depend on the sign or the size.
        assert_eq!(of(0.9, |time| -3e-7 * saturating(0.0, 50.0)(time)), Ok(125.0));
        // It begins nearer than that.
        assert_eq!(of(0.5, saturating(0.8, 50.0)), Ok(5.0));
    }

    #[test]
    fn the_time_in_which_the_pin_is_lifted_counts_for_nothing() {
        // In contact for 10 s, lifted for 10 s, and so on for 1200 s: on the axis of contact it is the curve of 600 s above.
        let time: Vec<f64> = (1..=1200).map(f64::from).collect();
        let contact: Vec<f64> =
            time.iter().map(|time| 10.0 * (time / 20.0).floor() + (time % 20.0).min(10.0)).collect();
        let integral: Vec<f64> = contact.iter().map(|time| saturating(0.0, 50.0)(*time)).collect();
        let samples = Cumulative { time: &time, integral: &integral, revolutions: &[] };
        // 125 s in contact are 5 s of the 13th time in contact, which begins at 240 s.
        let found = time_to_in_contact(0.9, &samples, &contact).unwrap();
        assert!((found - 245.0).abs() < 1e-9, "{found}");
        // With the pauses as an area of 0 it is another curve.
        assert_ne!(time_to(0.9, &samples, None), Ok(found));
        assert_eq!(time_to_in_contact(0.9, &samples, &contact[1..]), Err(NotDefined::NoValue));
    }

    #[test]
    fn pulses_about_a_curve_that_saturates_are_its_noise() {
        // 0.05 cos(2π t/37 s) more: of the means over 10 s.
        let rate = std::f64::consts::TAU / 37.0;
        let found = of(0.9, |time| saturating(0.0, 60.0)(time) + 0.05 * (rate * time).sin() / rate).unwrap();
        assert!((100.0..180.0).contains(&found), "{found}");
    }

    #[test]
    fn what_still_rises_or_falls_is_not_run_in() {
        assert!(matches!(of(0.9, |time| time * time), Err(NotDefined::NotSteady(change)) if change > 0.0));
        assert!(
            matches!(of(0.9, |time| 2000.0 * time - time * time), Err(NotDefined::NotSteady(change)) if change < 0.0)
        );
        // 1 − exp(−t/75 s) changes by 0.7 % from quarter to quarter, 1 − exp(−t/120 s) by 3.5 %: by hand, (1 − e⁻²)² e⁻⁴ 75/150 and so on.
        assert!(of(0.9, saturating(0.0, 75.0)).is_ok());
        assert!(matches!(of(0.99, saturating(0.0, 75.0)), Err(NotDefined::NotSteady(_))));
        assert!(matches!(of(0.9, saturating(0.0, 120.0)), Err(NotDefined::NotSteady(_))));
    }

    #[test]
    fn what_pulses_too_seldom_or_swings_about_the_fraction_is_not_run_in() {
        let time: Vec<f64> = (1..=600).map(f64::from).collect();
        let integral: Vec<f64> = time.iter().map(|time| saturating(0.0, 40.0)(*time)).collect();
        let samples = Cumulative { time: &time, integral: &integral, revolutions: &[] };
        assert_eq!(time_to(0.9, &samples, Some(50.0)), time_to(0.9, &samples, None));
        // A quarter is 150 s.
        assert_eq!(time_to(0.9, &samples, Some(75.0)), Err(NotDefined::FewPulses(2.0)));
        // Windows of 10 s of 0.97 and 1.03 in turn, the last two of 1.1: those of 0.97 are short of 0.99. By hand, of 59 windows from the second
        // on 28.
        let height = |window: usize| match window {
            58.. => 1.1,
            _ if window.is_multiple_of(2) => 0.97,
            _ => 1.03,
        };
        let sums = |time: f64| (1..=time as usize).map(|second| height((second - 1) / 10)).sum::<f64>();
        let found = of(0.9, sums);
        assert!(matches!(found, Err(NotDefined::ShortAgain(part)) if (part - 28.0 / 59.0).abs() < 1e-12), "{found:?}");
        // 0.4 sin(t/50 s) more: two quarters are not alike.
        let slow = |time: f64| time + 0.4 * 50.0 * (1.0 - (time / 50.0).cos());
        assert!(
            matches!(of(0.9, slow), Err(NotDefined::Unknown(..) | NotDefined::NotSteady(_))),
            "{:?}",
            of(0.9, slow)
        );
    }

    #[test]
    fn what_falls_and_rises_is_not_run_in() {
        // 1 but for a dip to 0.4 about 150 s, and the other way round.
        let dip = |time: f64| 20.0 * 1.772_453_85 / 2.0 * (1.0 + libm::erf((time - 150.0) / 20.0));
        assert!(matches!(of(0.9, |time| time - 0.6 * dip(time)), Err(NotDefined::NotMonotone(back)) if back > 0.4));
        assert!(matches!(of(0.9, |time| time + 0.6 * dip(time)), Err(NotDefined::NotMonotone(_))));
    }

    #[test]
    fn noise_is_not_taken_for_a_way_back() {
        let mut random = Random::new(5, Stream::DiscHeight);
        let defined = (0..200)
            .filter(|_| {
                let mut noise = vec![0.0];
                (0..600).for_each(|place| noise.push(noise[place] + 0.1 * random.normal()));
                of(0.9, |time| saturating(0.0, 40.0)(time) + noise[time as usize]).is_ok()
            })
            .count();
        // Chance alone is taken for a drift in one run of twenty, and for a way back in some.
        assert!(defined > 160, "{defined} of 200");
    }

    #[test]
    fn what_there_is_not_is_not_run_in() {
        assert_eq!(of(0.9, |_| 0.0), Err(NotDefined::NoValue));
        assert_eq!(of(0.9, |_| f64::NAN), Err(NotDefined::NoValue));
        let time = [1.0, 2.0, 3.0];
        let few = Cumulative { time: &time, integral: &time, revolutions: &[] };
        assert_eq!(time_to(0.9, &few, None), Err(NotDefined::TooShort));
        assert_eq!(
            time_to(0.9, &Cumulative { time: &[], integral: &[], revolutions: &[] }, None),
            Err(NotDefined::TooShort)
        );
    }
}
