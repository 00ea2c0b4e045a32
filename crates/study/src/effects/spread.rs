//! How uncertain a prediction is, for the mean of many runs and for one more.
//!
//! Blocks are there by lot: with other seeds there would be other ones. Where they differ by more than the error, what they
//! differ by is a part of the uncertainty, and the degrees of freedom are those of Satterthwaite, F. E. (1946): An approximate
//! distribution of estimates of variance components. Biometrics Bulletin 2, 110–114, doi:10.2307/3002019.

use super::distribution::t_quantile;
use super::error::EffectsError;
use super::factor::FactorKind;
use super::result::{Effects, Prediction, Squares};
use crate::design::Setting;

/// A prediction and its variances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spread {
    /// The response, averaged over blocks.
    pub value: f64,
    /// Of the mean of many runs, with any seeds; none without an error.
    pub mean: Option<Variance>,
    /// Of one more run, with a new seed; none without an error.
    pub run: Option<Variance>,
}

/// A variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Variance {
    /// Its estimate, in the square of the response's unit.
    pub estimate: f64,
    /// Degrees of freedom of the estimate.
    pub freedom: f64,
}

impl Variance {
    /// The sum of parts of two independent mean squares.
    fn sum(parts: [(f64, Squares); 2]) -> Option<Self> {
        let (mut estimate, mut spread) = (0.0, 0.0);
        for (part, squares) in parts.into_iter().filter(|(part, _)| *part != 0.0) {
            let own = part * squares.mean()?;
            estimate += own;
            spread += own * own / squares.freedom as f64;
        }
        Some(Self { estimate, freedom: estimate * estimate / spread }).filter(|sum| sum.freedom > 0.0)
    }

    /// Half the length of the interval of this confidence.
    pub fn reach(self, confidence: f64) -> f64 {
        t_quantile(1.0 - confidence, self.freedom) * self.estimate.sqrt()
    }
}

impl Effects {
    /// The response at settings, and its variances.
    ///
    /// # Errors
    /// If the settings do not fit the factors, or a level was never observed.
    pub(crate) fn spread(&self, settings: &[Setting]) -> Result<Spread, EffectsError> {
        Ok(self.spread_of(&self.inner.regressors.row(&self.by_value(settings), None)?))
    }

    /// The response where some factors have these settings, as [`predict_at`](Self::predict_at), with the interval that has the mean of many
    /// runs in it, whatever their seeds: what a surrogate expects of the mean there. None where the runs do not tell the response.
    ///
    /// # Errors
    /// Those of [`predict_at`](Self::predict_at).
    pub fn mean_at(&self, given: &[(usize, Setting)]) -> Result<Prediction, EffectsError> {
        let spread = self.spread_of(&self.row_at(given)?);
        let mean = spread.mean.filter(|_| self.tells_at(given));
        let interval = |variance: Variance| {
            let reach = variance.reach(self.confidence);
            [spread.value - reach, spread.value + reach]
        };
        let standard_error = mean.map(|variance| variance.estimate.sqrt());
        Ok(Prediction { value: spread.value, standard_error, interval: mean.map(interval) })
    }

    /// The response for a row of the model matrix, and its variances.
    fn spread_of(&self, row: &[f64]) -> Spread {
        let inner = &self.inner;
        let (value, leverage) = inner.fit.predict(row);
        let error = self.residual_standard_deviation.map(|_| self.residual.squares);
        let runs = self.observations as f64;
        let of = |more: f64| {
            let error = error?;
            let blocks = self.blocks.as_ref().map(|term| Squares { freedom: term.freedom, sum: term.sum_of_squares });
            let differ = blocks.filter(|blocks| blocks.freedom > 0 && blocks.mean() > error.mean());
            let Some(blocks) = differ else { return Variance::sum([(leverage + more, error), (0.0, error)]) };
            // A block's mean square has the variance of blocks as often as a block has runs. The mean over all blocks has
            // a part of it for each of them, a new run one more.
            let count = blocks.freedom as f64 + 1.0;
            let part = (1.0 + more * count) / runs;
            Variance::sum([(part, blocks), ((leverage + more - part).max(0.0), error)])
        };
        Spread { value: inner.offset + value, mean: of(0.0), run: of(1.0) }
    }

    /// Settings with the ends of numbers that have two levels as these levels: −1 is the least value, whichever level is the
    /// first.
    pub(super) fn by_value(&self, settings: &[Setting]) -> Vec<Setting> {
        let level = |(at, setting): (usize, &Setting)| match (
            *setting,
            self.inner.factors.get(at).map(|factor| &factor.kind),
        ) {
            (Setting::Coded(end), Some(FactorKind::Levels(values))) if values.len() == 2 && end.abs() == 1.0 => {
                let first = usize::from((values[0] < values[1]) != (end < 0.0));
                Setting::Level(first)
            }
            (setting, _) => setting,
        };
        settings.iter().enumerate().map(level).collect()
    }
}
