//! Fits to an experiment: which values of some keys make a program give what was measured.
//!
//! Runs are dear, so every response gets a Gaussian process, and the likelihood of the measurements is that of the processes:
//! normal, with the variance of the measurement and that of the process added. A [`Fit`] tells where further runs teach most,
//! and when the processes' part of the variance is small against the measurements'. What is known then is told by the profile
//! likelihood: of each key, of each pair, and which products of keys are determined where the keys themselves are not.
//!
//! M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63(3), 425–464 (2001), doi:10.1111/1467-9868.00294 (calibration with Gaussian
//! processes); A. Raue et al., Bioinformatics 25(15), 1923–1929 (2009), doi:10.1093/bioinformatics/btp358 (profile likelihood and
//! what data do not determine).
//!
//! | what | where |
//! |---|---|
//! | a whole series that was measured | `measured_series` |
//! | a series as a few responses | `components` |
//! | the likelihood of the measurements | `likelihood` |
//! | places in the ranges that are looked at | `places` |
//! | where the next runs teach most | `next` |
//! | whether they are worth making | `worth` |
//! | intervals of keys, regions of pairs | `profile` |
//! | which products of keys are determined | `combination` |
//! | all of it | `result` |

mod combination;
mod components;
mod key;
mod likelihood;
mod measured_series;
mod next;
mod places;
mod profile;
mod result;
mod worth;

use statrs::distribution::{ChiSquared, ContinuousCDF};
use thiserror::Error;

use crate::effects::{Factor, FactorKind, Observation};
use crate::surrogate::gaussian_process::{GaussianProcess, GaussianProcessError, Options as ProcessOptions};
pub use combination::Combination;
use components::Components;
pub use components::ObservedSeries;
pub use key::Key;
use likelihood::Likelihood;
pub use measured_series::{MeasuredSeries, SeriesError};
use places::Places;
pub use profile::{Pair, Piece, Profile};
pub use result::{FitResult, FittedResponse, FittedSeries};
pub use worth::Worst;

/// Something that was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// The value.
    pub value: f64,
    /// Its standard uncertainty, in the same unit.
    pub uncertainty: f64,
}

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FitError {
    /// Nothing to fit, or nothing to fit to.
    #[error("a fit needs at least one key and one measurement, found {keys} and {measurements}")]
    Empty {
        /// Keys.
        keys: usize,
        /// Measurements.
        measurements: usize,
    },
    /// A range that is none.
    #[error("key `{key}`: the range {low} to {high} is none")]
    Range {
        /// Its name.
        key: String,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// A measurement that tells nothing.
    #[error(
        "measurement {index}, counted from 0: {value} ± {uncertainty}, expected two numbers, the uncertainty above 0"
    )]
    Measurement {
        /// Which, from 0.
        index: usize,
        /// Its value.
        value: f64,
        /// Its uncertainty.
        uncertainty: f64,
    },
    /// A response that gets no Gaussian process.
    #[error("response {index}, counted from 0: {error}")]
    Response {
        /// Which, from 0.
        index: usize,
        /// Why.
        error: GaussianProcessError,
    },
    /// A series that gets no Gaussian process.
    #[error("series {index}, counted from 0: {error}")]
    Series {
        /// Which, from 0.
        index: usize,
        /// Why.
        error: GaussianProcessError,
    },
    /// A series that no run has.
    #[error("series {0}, counted from 0: no run has values at all of its times")]
    NoRun(usize),
    /// The likelihood is no number anywhere.
    #[error("the likelihood of the measurements is not a number anywhere in the ranges")]
    NoLikelihood,
}

/// What is known of the keys from the runs so far.
#[derive(Debug, Clone)]
pub struct Fit {
    keys: Vec<Key>,
    likelihood: Likelihood,
    /// Series that were measured; their terms of the likelihood follow those of single values, in this order.
    series: Vec<Components>,
    places: Places,
    /// The most likely place, in coded units.
    best: Vec<f64>,
    /// −2 ln of the likelihood there.
    least: f64,
    confidence: f64,
}

impl Fit {
    /// Fits a process to each response and finds the most likely values of the keys. `observations` are those of each
    /// response, with a coded setting for each key; `confidence` is the level of intervals, between 0 and 1.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn new(
        keys: &[Key],
        measurements: &[Measurement],
        observations: &[Vec<Observation>],
        confidence: f64,
    ) -> Result<Self, FitError> {
        Self::with_series(keys, measurements, observations, &[], confidence)
    }

    /// The same with series that were measured, each with what the runs have at its times.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn with_series(
        keys: &[Key],
        measurements: &[Measurement],
        observations: &[Vec<Observation>],
        series: &[(MeasuredSeries, Vec<ObservedSeries>)],
        confidence: f64,
    ) -> Result<Self, FitError> {
        check(keys, measurements, series.len())?;
        let factor = |key: &Key| Factor { name: key.name.clone(), kind: FactorKind::Range { low: -1.0, high: 1.0 } };
        let factors: Vec<Factor> = keys.iter().map(factor).collect();
        let process =
            |observations: &Vec<Observation>| GaussianProcess::fit(&factors, observations, &ProcessOptions::default());
        let of_value = |(index, observations): (usize, &Vec<Observation>)| {
            process(observations).map_err(|error| FitError::Response { index, error })
        };
        let mut processes = observations.iter().enumerate().map(of_value).collect::<Result<Vec<_>, _>>()?;
        let (mut measurements, mut all) = (measurements.to_vec(), Vec::new());
        for (index, (measured, runs)) in series.iter().enumerate() {
            let components = Components::new(measured, runs).ok_or(FitError::NoRun(index))?;
            for observations in components.observations(runs) {
                processes.push(process(&observations).map_err(|error| FitError::Series { index, error })?);
            }
            measurements.extend(components.measurements());
            all.push(components);
        }
        let likelihood = Likelihood::new(processes, &measurements);
        let places = Places::new(keys.len(), &likelihood);
        let (best, least) = places.most_likely(&likelihood).ok_or(FitError::NoLikelihood)?;
        let places = places.with_near(&best, &likelihood);
        Ok(Self { keys: keys.to_vec(), likelihood, series: all, places, best, least, confidence })
    }

    /// Most likely values of the keys so far.
    pub fn best(&self) -> Vec<f64> {
        self.keys.iter().zip(&self.best).map(|(key, coded)| key.value(*coded)).collect()
    }

    /// How far −2 ln of the likelihood is above the least where the keys have these values; a rise below the quantile of χ² with
    /// as many degrees of freedom as keys is in their region.
    pub fn rise(&self, values: &[f64]) -> f64 {
        let place: Vec<f64> = self.keys.iter().zip(values).map(|(key, value)| key.coded(*value)).collect();
        self.likelihood.value(&place) - self.least
    }

    /// How far −2 ln of the likelihood rises within the region of so many keys together at the level of the fit.
    fn threshold(&self, keys: usize) -> f64 {
        ChiSquared::new(keys as f64).map_or(f64::NAN, |of| of.inverse_cdf(self.confidence))
    }
}

fn check(keys: &[Key], measurements: &[Measurement], series: usize) -> Result<(), FitError> {
    if keys.is_empty() || measurements.len() + series == 0 {
        return Err(FitError::Empty { keys: keys.len(), measurements: measurements.len() + series });
    }
    if let Some(key) = keys.iter().find(|key| !key.is_range()) {
        return Err(FitError::Range { key: key.name.clone(), low: key.low, high: key.high });
    }
    let is_wrong =
        |given: &Measurement| !(given.value.is_finite() && given.uncertainty.is_finite() && given.uncertainty > 0.0);
    match measurements.iter().position(is_wrong) {
        None => Ok(()),
        Some(index) => {
            let Measurement { value, uncertainty } = measurements[index];
            Err(FitError::Measurement { index, value, uncertainty })
        }
    }
}
