//! Mean of the contact area over the end of a run, with its standard error.
//!
//! Resin that touches loses h_m at once (model 4.2) and is clear until the plateaus have worn as far; most of it does so
//! together. So the contact area pulses, and a mean over one revolution is that of a moment within a pulse. Means over many
//! pulses can be compared.

use serde::Serialize;

/// Part of a run, at its end, of which the mean is taken.
const LAST_PART: f64 = 0.1;
/// Simulated revolutions in that part, at least, where the run has as many.
pub const LEAST_REVOLUTIONS: f64 = 10.0;
/// Parts of a window from which a standard error is told, at least: that of n independent values is itself off by a part of
/// 1/√(2(n−1)), a third here.
pub const LEAST_PARTS: usize = 5;
/// Pulses of the contact area in a window from which on its mean has a standard error, and can be compared with another: what varies
/// within a pulse does not tell how means over fewer would.
pub const LEAST_PULSES: f64 = 3.0;
/// Rounding of counts of revolutions.
pub(super) const ROUNDING: f64 = 1e-9;

/// Cumulative series of a quantity at the samples of a run, each as long as the others.
#[derive(Debug, Clone, Copy)]
pub struct Cumulative<'a> {
    /// Times of the samples, s, ascending.
    pub time: &'a [f64],
    /// Integral of the quantity over time since t = 0, its unit times s.
    pub integral: &'a [f64],
    /// Simulated revolutions since t = 0; empty if they are not known.
    pub revolutions: &'a [f64],
}

/// Mean of a quantity over a part of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WindowMean {
    /// Start of the part, s.
    pub from: f64,
    /// End of the part, s.
    pub to: f64,
    /// Simulated revolutions in it; none if they are not known.
    pub revolutions: Option<f64>,
    /// The time in it, s, over which the mean is taken, where the pin was lifted meanwhile.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_time: Option<f64>,
    /// The mean, exactly: difference of the integral over the time.
    pub mean: f64,
    /// Standard error of the mean: see [`standard_error`]. None with fewer than five parts, see [`Cumulative::mean`],
    /// or three pulses, see [`WindowMean::of_pulses`].
    pub standard_error: Option<f64>,
}

impl WindowMean {
    /// Mean where the contact area pulses in this time, s, or longer, if that is known: without a standard error if it has too few
    /// pulses.
    pub fn of_pulses(self, pulse_time: Option<f64>) -> Self {
        let has_enough = pulse_time.is_none_or(|time| self.to - self.from >= LEAST_PULSES * time * (1.0 - ROUNDING));
        Self { standard_error: self.standard_error.filter(|_| has_enough), ..self }
    }

    /// Tells whether the part has as many revolutions as a mean needs; true if they are not known.
    pub fn is_long(&self) -> bool {
        self.revolutions.is_none_or(|revolutions| revolutions > LEAST_REVOLUTIONS * (1.0 - ROUNDING))
    }
}

impl Cumulative<'_> {
    /// The mean between two times, s: exact where these are times of samples, or 0, and otherwise with the integral linear
    /// between samples. None unless 0 ≤ from < to ≤ the time of the last sample, or where a sample is not finite.
    ///
    /// For the standard error the window is cut into equal parts, as many as it has intervals between samples, but none
    /// shorter than a simulated revolution: what comes and goes within each revolution is no chance.
    pub fn mean(&self, from: f64, to: f64) -> Option<WindowMean> {
        let in_order = 0.0 <= from && from < to && to <= self.time.last()? * (1.0 + ROUNDING);
        if !in_order || self.integral.len() != self.time.len() {
            return None;
        }
        let revolutions = self.turns(from, to);
        let integral = |moment: f64| at(self.time, self.integral, moment);
        let mean = (integral(to) - integral(from)) / (to - from);
        let parts = self.parts(from, to);
        let standard_error = (parts >= LEAST_PARTS).then(|| standard_error(&self.means_of_parts(from, to, parts)));
        let finite = mean.is_finite() && standard_error.is_none_or(f64::is_finite);
        finite.then_some(WindowMean { from, to, revolutions, contact_time: None, mean, standard_error })
    }

    /// The mean over the time in contact alone, of which `contact_time` is the series (s, since t = 0): the time in which the pin was
    /// lifted counts for nothing. None also where it was lifted all the time.
    pub fn mean_in_contact(&self, contact_time: &[f64], from: f64, to: f64) -> Option<WindowMean> {
        let in_order = 0.0 <= from && from < to && to <= self.time.last()? * (1.0 + ROUNDING);
        if !in_order || contact_time.len() != self.time.len() {
            return None;
        }
        let [time, integral, revolutions] = self.on_contact_time(contact_time);
        let [start, end] = [from, to].map(|moment| at(self.time, contact_time, moment));
        let samples = Cumulative { time: &time, integral: &integral, revolutions: &revolutions };
        let mean = samples.mean(start, end)?;
        let is_lifted = to - from > (end - start) * (1.0 + ROUNDING);
        Some(WindowMean { from, to, contact_time: is_lifted.then_some(end - start), ..mean })
    }

    /// Time in contact, integral and revolutions on the axis of that time, without the samples at which it stands still.
    pub(super) fn on_contact_time(&self, contact_time: &[f64]) -> [Vec<f64>; 3] {
        let mut before = 0.0;
        let moves = |(_, time): &(usize, &f64)| {
            let moves = **time > before;
            before = before.max(**time);
            moves
        };
        let kept: Vec<usize> = contact_time.iter().enumerate().filter(moves).map(|(sample, _)| sample).collect();
        let at_kept = |values: &[f64]| kept.iter().filter_map(|at| values.get(*at).copied()).collect();
        [contact_time, self.integral, self.revolutions].map(at_kept)
    }

    /// Simulated revolutions in a window, if they are known.
    fn turns(&self, from: f64, to: f64) -> Option<f64> {
        let is_known = self.revolutions.len() == self.time.len();
        is_known.then(|| at(self.time, self.revolutions, to) - at(self.time, self.revolutions, from))
    }

    /// Parts of a window of which a standard error is made; see [`mean`](Self::mean).
    pub(super) fn parts(&self, from: f64, to: f64) -> usize {
        let intervals = 1 + self.time.iter().filter(|time| (from < **time) && (**time < to)).count();
        self.turns(from, to).map_or(intervals, |turns| intervals.min((turns * (1.0 + ROUNDING)) as usize))
    }

    /// Means over equal parts of a window of [`mean`](Self::mean).
    pub(super) fn means_of_parts(&self, from: f64, to: f64, parts: usize) -> Vec<f64> {
        let width = (to - from) / parts as f64;
        let edge =
            |part: usize| at(self.time, self.integral, if part == parts { to } else { from + part as f64 * width });
        (0..parts).map(|part| (edge(part + 1) - edge(part)) / width).collect()
    }
}

/// The last tenth of a run, s, from one sample to the last; earlier from where it has fewer than ten simulated revolutions
/// otherwise, and all of the run where that has no more. None without samples.
pub fn last_tenth(time: &[f64], revolutions: &[f64]) -> Option<(f64, f64)> {
    let to = *time.last()?;
    let latest = to * (1.0 - LAST_PART) * (1.0 + ROUNDING);
    let mut first = time.partition_point(|time| *time <= latest);
    if let (Some(all), true) = (revolutions.last(), revolutions.len() == time.len()) {
        let latest = all - LEAST_REVOLUTIONS * (1.0 - ROUNDING);
        first = first.min(revolutions.partition_point(|turns| *turns <= latest));
    }
    Some((if first == 0 { 0.0 } else { time[first - 1] }, to))
}

/// A cumulative series at a moment: 0 at t = 0, linear between samples.
fn at(time: &[f64], values: &[f64], moment: f64) -> f64 {
    let after = time.partition_point(|time| *time < moment).min(time.len() - 1);
    let (start, before) = if after == 0 { (0.0, 0.0) } else { (time[after - 1], values[after - 1]) };
    let share = ((moment - start) / (time[after] - start)).min(1.0);
    before + share * (values[after] - before)
}

/// Standard error of the mean of values that follow one another in time and may be alike:
///
/// γ_k = (1/n) Σ_i (x_i − x̄)(x_{i+k} − x̄), S = γ_0 + 2 Σ_{0<k<L} γ_k, error² = S n / ((n − L)(n − L + 1)).
///
/// L ends the initial monotone sequence: pairs γ_{2j} + γ_{2j+1} are added as long as they are positive, none counting more
/// than the one before, and for no more than half of all lags (C. J. Geyer, Practical Markov chain Monte Carlo, Statistical
/// Science 7 (1992) 473–483, section 3.3). The divisor takes out that the mean is that of the same values (T. P. Straatsma,
/// H. J. C. Berendsen, A. J. Stam, Molecular Physics 57 (1986) 89–95); with L = 1 it makes the familiar s/√n. S counts as
/// γ_0 at least: what swings to and fro is not taken for better known than chance. Strict periods are therefore given too
/// large an error, and so is a mean that drifts.
pub fn standard_error(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let rest: Vec<f64> = values.iter().map(|value| value - mean).collect();
    error_of_mean(&rest, values.len())
}

/// Standard error of the mean of n values, from residuals: those of the n values from their mean, or those of 2 n from a line. A
/// constant is estimated from every n of them in both cases, so that the divisor is the same.
pub(super) fn error_of_mean(rest: &[f64], n: usize) -> f64 {
    let covariance =
        |lag: usize| rest.iter().zip(&rest[lag..]).map(|(one, other)| one * other).sum::<f64>() / rest.len() as f64;
    let of_one = covariance(0);
    let (mut lags, mut sum, mut before) = (0, -of_one, f64::INFINITY);
    while lags + 2 <= n / 2 {
        let pair = (covariance(lags) + covariance(lags + 1)).min(before);
        if pair <= 0.0 {
            break;
        }
        (lags, sum, before) = (lags + 2, sum + 2.0 * pair, pair);
    }
    if sum < of_one {
        (lags, sum) = (1, of_one);
    }
    let left = (n - lags) as f64;
    (sum * n as f64 / (left * (left + 1.0))).sqrt()
}
