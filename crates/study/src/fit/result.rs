//! What a fit tells.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::components::Components;
use super::likelihood::Term;
use super::{Combination, Fit, MeasuredSeries, Measurement, Pair, Profile, Worst};

/// What is known of keys and responses.
#[derive(Debug, Clone, PartialEq)]
pub struct FitResult {
    /// Most likely values of the keys.
    pub best: Vec<f64>,
    /// The responses there, of which single values were measured.
    pub responses: Vec<FittedResponse>,
    /// The series there.
    pub series: Vec<FittedSeries>,
    /// Profiles of the keys.
    pub profiles: Vec<Profile>,
    /// Regions of all pairs of keys.
    pub pairs: Vec<Pair>,
    /// What is determined where there is a ridge; see [`Combination`]. None where there is no ridge.
    pub combinations: Option<Vec<Combination>>,
    /// What is known several times as well as the keys where all keys are determined; see [`Combination`].
    pub better_known: Vec<Combination>,
    /// Σ (forecast − measured)²/variance at the most likely values.
    pub misfit: f64,
    /// Measurements, each point of a series one of them, less keys.
    pub freedom: usize,
    /// Probability of a larger misfit if the model is right; none without degrees of freedom.
    pub p: Option<f64>,
    /// Level of intervals and regions.
    pub confidence: f64,
    /// The largest variance of a process over that of its measurement, where the measurements are not unlikely.
    pub surrogate_share: f64,
    /// The response that has it.
    pub worst: Option<Worst>,
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

/// A series at the most likely values of the keys.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedSeries {
    /// What was measured.
    pub measured: MeasuredSeries,
    /// What runs give at the times, as the Gaussian processes have it.
    pub forecast: Vec<f64>,
    /// Standard deviations of that for want of runs and of seeds.
    pub deviations: Vec<f64>,
    /// Components of the runs' series that the measurement can see.
    pub components: usize,
    /// Root mean square of the deviations of the measurement, white: 1 where they are as large as the uncertainties.
    pub apart: f64,
    /// Correlation of successive ones of these.
    pub successive: f64,
    /// The largest standard deviation, over that of the measurement, that a component has for want of seeds.
    pub seeds_deviation: f64,
    /// The same from seed to seed of single runs; none without replicates.
    pub scatter: Option<f64>,
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
        let in_series: usize = self.series.iter().map(Components::count).sum();
        let values = self.likelihood.terms.len() - in_series;
        let points: usize = self.series.iter().map(|series| series.measured.times().len()).sum();
        let freedom = (values + points).saturating_sub(keys);
        let rest: f64 = self.series.iter().map(Components::rest).sum();
        let misfit = self.likelihood.misfit(&self.best) + rest;
        let tail = |freedom: usize| ChiSquared::new(freedom as f64).ok().map(|of| of.sf(misfit));
        let responses = self.likelihood.terms[..values].iter().map(|term| {
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
            series: self.told_series(values),
            profiles: (0..keys).map(|key| self.profile(key)).collect(),
            pairs: pairs.map(|keys| self.pair(keys)).collect(),
            combinations: self.combinations(),
            better_known: self.better_known(),
            misfit,
            freedom,
            p: if freedom > 0 { tail(freedom) } else { None },
            confidence: self.confidence,
            surrogate_share: self.surrogate_share(),
            worst: self.worst(),
            settled: self.is_settled(),
        }
    }

    /// The series, whose terms begin at this place.
    fn told_series(&self, mut begin: usize) -> Vec<FittedSeries> {
        let mut all = Vec::new();
        for series in &self.series {
            let terms = &self.likelihood.terms[begin..begin + series.count()];
            begin += series.count();
            let scores: Vec<f64> = terms.iter().map(|term| term.process.local_at(&self.best).mean).collect();
            let variances: Vec<f64> = terms.iter().map(|term| term.variance_at(&self.best) + term.of_seeds).collect();
            let (forecast, away) = series.series(&scores);
            let squares: f64 = away.iter().map(|away| away * away).sum();
            let products: f64 = away.windows(2).map(|pair| pair[0] * pair[1]).sum();
            let largest = |of: fn(&Term) -> f64| {
                terms.iter().map(|term| of(term) / term.measurement.uncertainty).fold(0.0, f64::max)
            };
            let has_seeds = terms.iter().all(|term| term.process.seed_deviation().is_some());
            all.push(FittedSeries {
                measured: series.measured.clone(),
                forecast,
                deviations: series.deviations(&variances),
                components: series.count(),
                apart: (squares / away.len() as f64).sqrt(),
                successive: if squares > 0.0 { products / squares } else { 0.0 },
                seeds_deviation: largest(|term| term.of_seeds.sqrt()),
                scatter: has_seeds.then(|| largest(|term| term.process.seed_deviation().unwrap_or(0.0))),
            });
        }
        all
    }
}
