//! Surrogates: what a response is expected to be where no run was made.
//!
//! A polynomial and a Gaussian process answer the same questions, so what predicts, searches for an optimum or tells
//! sensitivities asks a [`Surrogate`] and does not know which one it has.

mod choice;
pub mod gaussian_process;
mod polynomial;
mod scaled_process;

pub use choice::{Choice, choose};

use crate::design::Setting;
use crate::effects::EffectsError;

pub use polynomial::{PolynomialSurrogate, Scale};
pub use scaled_process::ScaledProcess;

/// What a surrogate expects of a response, in the unit of the response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecast {
    /// The response that is expected; its median where the response was transformed for the fit.
    pub value: f64,
    /// Interval that has the mean of many runs (with different seeds) in it; none without an error.
    pub mean_interval: Option<[f64; 2]>,
    /// Interval that has the response of one more run in it; none without an error.
    pub run_interval: Option<[f64; 2]>,
}

impl Forecast {
    /// A value alone, without intervals.
    pub fn of_value(value: f64) -> Self {
        Self { value, mean_interval: None, run_interval: None }
    }
}

/// Something that was fitted to the responses of a study.
pub trait Surrogate: Sync {
    /// What it is, for people: such as `quadratic in log(contact area)` or `Gaussian process`.
    fn name(&self) -> String;

    /// The response at settings, one for each factor; numbers in coded units, also beyond −1 and 1.
    ///
    /// # Errors
    /// If the settings do not fit the factors, or a level was never observed.
    fn forecast(&self, settings: &[Setting], confidence: f64) -> Result<Forecast, EffectsError>;

    /// Whether the runs tell the response at settings. Where they do not, a forecast has no intervals, and takes what cannot be told
    /// from other things for nothing.
    ///
    /// # Errors
    /// Those of [`forecast`](Self::forecast).
    fn tells(&self, _settings: &[Setting]) -> Result<bool, EffectsError> {
        Ok(true)
    }

    /// The response at settings alone, for those who ask often.
    ///
    /// # Errors
    /// Those of [`forecast`](Self::forecast).
    fn value(&self, settings: &[Setting]) -> Result<f64, EffectsError> {
        Ok(self.forecast(settings, 0.95)?.value)
    }

    /// Root mean square of what responses differ by from a fit without their point, in the unit of the response; none
    /// where more than a quarter of the points cannot be left out, for a term depends on one of them alone.
    fn leave_one_out_error(&self) -> Option<f64>;
}
