//! How likely the measurements are where the keys have given values.

use super::Measurement;
use crate::quasi_newton::Slope;
use crate::surrogate::gaussian_process::GaussianProcess;

/// The processes of all responses and what was measured of them.
#[derive(Debug, Clone)]
pub(super) struct Likelihood {
    pub terms: Vec<Term>,
}

/// A response.
#[derive(Debug, Clone)]
pub(super) struct Term {
    pub process: GaussianProcess,
    pub measurement: Measurement,
    /// What the process's variance is multiplied by: more than 1 where its points miss the forecasts of the others by more
    /// than it says.
    pub inflation: f64,
    /// Variance of what the sets of seeds add everywhere.
    pub of_seeds: f64,
}

impl Term {
    /// Variance of a forecast's process alone.
    pub fn variance_at(&self, place: &[f64]) -> f64 {
        self.inflation * self.process.local_at(place).variance
    }

    /// Variance of measurement and seeds, which more points do not lessen.
    pub fn fixed_variance(&self) -> f64 {
        self.measurement.uncertainty * self.measurement.uncertainty + self.of_seeds
    }
}

impl Likelihood {
    pub fn new(processes: Vec<GaussianProcess>, measurements: &[Measurement]) -> Self {
        let term = |(process, measurement): (GaussianProcess, &Measurement)| Term {
            inflation: process.left_out_square().max(1.0),
            of_seeds: process.seeds_variance(),
            process,
            measurement: *measurement,
        };
        Self { terms: processes.into_iter().zip(measurements).map(term).collect() }
    }

    /// −2 ln of the likelihood at a place in coded units, but for a constant: Σ (μ − m)²/V + ln V, where V is the variance of
    /// measurement, seeds and process; with derivatives.
    pub fn slope(&self, place: &[f64]) -> Option<Slope> {
        let (mut value, mut gradient) = (0.0, vec![0.0; place.len()]);
        for term in &self.terms {
            let slopes = term.process.slopes_at(place);
            let variance = term.fixed_variance() + term.inflation * slopes.local.variance;
            let away = slopes.local.mean - term.measurement.value;
            value += away * away / variance + libm::log(variance / term.fixed_variance());
            let by_variance = (1.0 - away * away / variance) / variance;
            for (at, slope) in gradient.iter_mut().enumerate() {
                *slope += 2.0 * away / variance * slopes.mean[at] + by_variance * term.inflation * slopes.variance[at];
            }
        }
        value.is_finite().then_some((value, gradient))
    }

    /// The same without derivatives; infinite where it is no number.
    pub fn value(&self, place: &[f64]) -> f64 {
        let term = |term: &Term| {
            let local = term.process.local_at(place);
            let variance = term.fixed_variance() + term.inflation * local.variance;
            let away = local.mean - term.measurement.value;
            away * away / variance + libm::log(variance / term.fixed_variance())
        };
        let value: f64 = self.terms.iter().map(term).sum();
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// Σ (μ − m)²/V: how far forecasts and measurements are apart.
    pub fn misfit(&self, place: &[f64]) -> f64 {
        let term = |term: &Term| {
            let away = term.process.local_at(place).mean - term.measurement.value;
            away * away / (term.fixed_variance() + term.variance_at(place))
        };
        self.terms.iter().map(term).sum()
    }

    /// Slopes of the responses by coded units over the deviations of their measurements, a row for each response.
    pub fn weighted_slopes(&self, place: &[f64]) -> Vec<Vec<f64>> {
        let row = |term: &Term| {
            let slopes = term.process.slopes_at(place);
            let deviation = (term.fixed_variance() + term.inflation * slopes.local.variance).sqrt();
            slopes.mean.iter().map(|slope| slope / deviation).collect()
        };
        self.terms.iter().map(row).collect()
    }
}
