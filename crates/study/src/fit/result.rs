//! What a fit tells.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::{Combination, Fit, Measurement, Pair, Profile};

/// What is known of keys and responses.
#[derive(Debug, Clone, PartialEq)]
pub struct FitResult {
    /// Most likely values of the keys.
    pub best: Vec<f64>,
    /// The responses there.
    pub responses: Vec<FittedResponse>,
    /// Profiles of the keys.
    pub profiles: Vec<Profile>,
    /// Regions of all pairs of keys.
    pub pairs: Vec<Pair>,
    /// What is determined where there is a ridge; see [`Combination`]. None where there is no ridge.
    pub combinations: Option<Vec<Combination>>,
    /// Σ (forecast − measured)²/variance at the most likely values.
    pub misfit: f64,
    /// Measurements less keys.
    pub freedom: usize,
    /// Probability of a larger misfit if the model is right; none without degrees of freedom.
    pub p: Option<f64>,
    /// Level of intervals and regions.
    pub confidence: f64,
    /// The largest variance of a process over that of its measurement, where the measurements are not unlikely.
    pub surrogate_share: f64,
    /// Whether more runs would change little.
    pub settled: bool,
}

/// A response at the most likely values of the keys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedResponse {
    /// What was measured.
    pub measurement: Measurement,
    /// What runs give, as the Gaussian process has it.
    pub forecast: f64,
    /// Standard deviation of that for want of runs.
    pub surrogate_deviation: f64,
    /// Standard deviation of that for want of seeds.
    pub seeds_deviation: f64,
    /// Standard deviation from seed to seed of single runs; none without replicates.
    pub scatter: Option<f64>,
    /// Root mean square by which points miss the forecast of the others.
    pub leave_one_out_error: f64,
}

impl Fit {
    /// Profiles, regions and all else; that takes longer than the fit.
    pub fn result(&self) -> FitResult {
        let polished = self.clone().polished();
        polished.told()
    }

    fn told(&self) -> FitResult {
        let keys = self.keys.len();
        let pairs = (0..keys).flat_map(|one| (one + 1..keys).map(move |other| [one, other]));
        let freedom = self.likelihood.terms.len().saturating_sub(keys);
        let misfit = self.likelihood.misfit(&self.best);
        let tail = |freedom: usize| ChiSquared::new(freedom as f64).ok().map(|of| of.sf(misfit));
        let responses = self.likelihood.terms.iter().map(|term| {
            let left_out = term.process.left_out();
            let squares = left_out.iter().map(|point| (point.observed - point.forecast).powi(2));
            FittedResponse {
                measurement: term.measurement,
                forecast: term.process.local_at(&self.best).mean,
                surrogate_deviation: term.variance_at(&self.best).sqrt(),
                seeds_deviation: term.of_seeds.sqrt(),
                scatter: term.process.seed_deviation(),
                leave_one_out_error: (squares.sum::<f64>() / left_out.len() as f64).sqrt(),
            }
        });
        FitResult {
            best: self.best(),
            responses: responses.collect(),
            profiles: (0..keys).map(|key| self.profile(key)).collect(),
            pairs: pairs.map(|keys| self.pair(keys)).collect(),
            combinations: self.combinations(),
            misfit,
            freedom,
            p: if freedom > 0 { tail(freedom) } else { None },
            confidence: self.confidence,
            surrogate_share: self.surrogate_share(),
            settled: self.is_settled(),
        }
    }
}
