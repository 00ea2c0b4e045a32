//! A whole series that was measured: values at times, each with its uncertainty, and for how long errors are alike.
//!
//! Errors are normal. Those of two points are correlated by exp(−|t − t′|/τ), where τ is the correlation time; with τ = 0 they are
//! independent. Such errors have the property of Markov, so they become independent ones of deviation 1 by differences of
//! neighbours alone: e₁ = x₁/u₁ stays, and (eᵢ − ρᵢ eᵢ₋₁)/√(1 − ρᵢ²) takes the place of each other eᵢ, where ρᵢ = exp(−(tᵢ − tᵢ₋₁)/τ).
//! What has gone through this is called white here.
//!
//! C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning (MIT Press, 2006), appendix B.2 (the
//! Ornstein–Uhlenbeck process).

use thiserror::Error;

/// A series that was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSeries {
    times: Vec<f64>,
    values: Vec<f64>,
    uncertainties: Vec<f64>,
    correlation_time: f64,
}

/// What is wrong with a point of a series.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SeriesError {
    /// Too few of them.
    #[error("{0} points, expected at least 2")]
    TooFew(usize),
    /// A number that is none.
    #[error("point {0}, counted from 0: a value is not a finite number")]
    NotFinite(usize),
    /// A time that is not after the one before.
    #[error("point {0}, counted from 0: its time is not after that of the point before")]
    Order(usize),
    /// An uncertainty that is none.
    #[error("point {0}, counted from 0: the uncertainty is {1}, expected more than 0")]
    Uncertainty(usize, f64),
    /// A correlation time that is none.
    #[error("the correlation time is {0}, expected a time of 0 or more")]
    CorrelationTime(f64),
}

impl MeasuredSeries {
    /// A series of `values` at `times`, each with its standard uncertainty; `correlation_time` is 0 for independent errors.
    ///
    /// # Errors
    /// [`SeriesError`].
    pub fn new(
        times: Vec<f64>,
        values: Vec<f64>,
        uncertainties: Vec<f64>,
        correlation_time: f64,
    ) -> Result<Self, SeriesError> {
        let points = times.len().min(values.len()).min(uncertainties.len());
        if points < 2 {
            return Err(SeriesError::TooFew(points));
        }
        if let Some(at) = (0..points).find(|at| !(times[*at] + values[*at] + uncertainties[*at]).is_finite()) {
            return Err(SeriesError::NotFinite(at));
        }
        if let Some(at) = (1..points).find(|at| times[*at] <= times[at - 1]) {
            return Err(SeriesError::Order(at));
        }
        if let Some(at) = (0..points).find(|at| uncertainties[*at] <= 0.0) {
            return Err(SeriesError::Uncertainty(at, uncertainties[at]));
        }
        if !(correlation_time >= 0.0 && correlation_time.is_finite()) {
            return Err(SeriesError::CorrelationTime(correlation_time));
        }
        Ok(Self { times, values, uncertainties, correlation_time })
    }

    /// Times, in ascending order.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Their standard uncertainties.
    pub fn uncertainties(&self) -> &[f64] {
        &self.uncertainties
    }

    /// For how long errors are alike; 0 if they are independent.
    pub fn correlation_time(&self) -> f64 {
        self.correlation_time
    }

    /// How many independent points would tell a constant as well: 1ᵀR⁻¹1 with the correlations R, which is
    /// 1 + Σ (1 − ρᵢ)/(1 + ρᵢ).
    pub fn independent_points(&self) -> f64 {
        1.0 + self.steps().map(|step| step.map_or(1.0, |step| libm::tanh(0.5 * step))).sum::<f64>()
    }

    /// Root mean square of the deviations of a run from what was measured, white: 1 where they are as large as the
    /// uncertainties. `run` has the values at the times.
    pub fn distance(&self, run: &[f64]) -> f64 {
        let away: Vec<f64> = run.iter().zip(&self.values).map(|(run, measured)| run - measured).collect();
        let squares: f64 = self.white(&away).iter().map(|away| away * away).sum();
        (squares / self.times.len() as f64).sqrt()
    }

    /// Values at the times with errors that are independent and of deviation 1.
    pub(super) fn white(&self, values: &[f64]) -> Vec<f64> {
        let scaled: Vec<f64> = values.iter().zip(&self.uncertainties).map(|(value, u)| value / u).collect();
        let mut white = scaled.clone();
        for (at, step) in self.steps().enumerate() {
            if let Some(step) = step {
                let (correlation, rest) = parts(step);
                white[at + 1] = (scaled[at + 1] - correlation * scaled[at]) / rest;
            }
        }
        white
    }

    /// What [`white`](Self::white) was made of.
    pub(super) fn coloured(&self, white: &[f64]) -> Vec<f64> {
        let mut scaled = white.to_vec();
        for (at, step) in self.steps().enumerate() {
            if let Some(step) = step {
                let (correlation, rest) = parts(step);
                scaled[at + 1] = correlation * scaled[at] + rest * white[at + 1];
            }
        }
        scaled.iter().zip(&self.uncertainties).map(|(value, u)| value * u).collect()
    }

    /// From each point to the next, in correlation times; none where errors are independent.
    fn steps(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        let time = self.correlation_time;
        self.times.windows(2).map(move |pair| (time > 0.0).then(|| (pair[1] - pair[0]) / time))
    }
}

/// Correlation of neighbours at a distance in correlation times, and √(1 − its square).
fn parts(step: f64) -> (f64, f64) {
    (libm::exp(-step), (-libm::expm1(-2.0 * step)).sqrt())
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    fn series(correlation_time: f64) -> MeasuredSeries {
        let times = vec![0.0, 1.0, 1.5, 4.0, 9.0];
        MeasuredSeries::new(times, vec![1.0, 3.0, 2.0, 5.0, 4.0], vec![0.5, 1.0, 2.0, 0.5, 1.0], correlation_time)
            .unwrap()
    }

    /// By the definition: the inverse of the matrix of covariances.
    fn inverse(series: &MeasuredSeries, scaled: bool) -> DMatrix<f64> {
        let (times, u) = (series.times(), series.uncertainties());
        let covariance = DMatrix::from_fn(5, 5, |one, other| {
            let correlation = match series.correlation_time {
                0.0 => f64::from(u8::from(one == other)),
                time => (-(times[one] - times[other]).abs() / time).exp(),
            };
            if scaled { correlation } else { correlation * u[one] * u[other] }
        });
        covariance.try_inverse().unwrap()
    }

    #[test]
    fn squares_of_white_deviations_are_those_of_the_covariances() {
        for time in [0.0, 0.7, 30.0] {
            let series = series(time);
            let run = [2.0, 1.0, 7.0, 5.5, 1.0];
            let away = DVector::from_iterator(5, run.iter().zip(series.values()).map(|(run, value)| run - value));
            let expected = (away.transpose() * inverse(&series, false) * &away)[(0, 0)];
            assert!((series.distance(&run).powi(2) * 5.0 / expected - 1.0).abs() < 1e-9, "{time}");
            let back = series.coloured(&series.white(&run));
            assert!(back.iter().zip(run).all(|(back, run)| (back - run).abs() < 1e-9));
        }
    }

    #[test]
    fn correlated_points_count_for_fewer() {
        for time in [0.0, 0.7, 30.0] {
            let series = series(time);
            let ones = DVector::from_element(5, 1.0);
            let expected = (ones.transpose() * inverse(&series, true) * &ones)[(0, 0)];
            assert!((series.independent_points() - expected).abs() < 1e-9, "{time}");
        }
        assert_eq!(series(0.0).independent_points(), 5.0);
    }

    #[test]
    fn points_that_are_none_are_told_by_number() {
        let new = |times: &[f64], uncertainty: f64| {
            MeasuredSeries::new(times.to_vec(), vec![1.0; times.len()], vec![uncertainty; times.len()], 0.0)
                .unwrap_err()
        };
        assert_eq!(new(&[1.0], 1.0), SeriesError::TooFew(1));
        assert_eq!(new(&[1.0, 2.0, 2.0], 1.0), SeriesError::Order(2));
        assert_eq!(new(&[1.0, f64::NAN], 1.0), SeriesError::NotFinite(1));
        assert_eq!(new(&[1.0, 2.0], 0.0), SeriesError::Uncertainty(0, 0.0));
    }
}
