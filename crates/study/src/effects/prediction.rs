//! Predictions of the model.

use super::error::EffectsError;
use super::result::{Effects, Inner, Prediction};
use crate::design::Setting;

impl Effects {
    /// The response at settings, averaged over blocks. Terms without an estimate of their own count as zero. In a
    /// quadratic model, factors with numeric levels may be set between them, in coded units.
    ///
    /// # Errors
    /// If the settings do not fit the factors, or a level was never observed.
    pub fn predict(&self, settings: &[Setting]) -> Result<Prediction, EffectsError> {
        Ok(self.inner.predict(&self.inner.regressors.row(settings, None)?))
    }
}

impl Inner {
    /// The response for a row of the model matrix.
    pub fn predict(&self, row: &[f64]) -> Prediction {
        let (value, variance) = self.fit.predict(row);
        let value = self.offset + value;
        let standard_error = self.deviation.map(|deviation| deviation * variance.sqrt());
        Prediction { value, standard_error, interval: self.interval(value, standard_error) }
    }

    /// The confidence interval of a value with this standard error.
    pub fn interval(&self, value: f64, standard_error: Option<f64>) -> Option<[f64; 2]> {
        standard_error.map(|error| [value - self.quantile * error, value + self.quantile * error])
    }
}
