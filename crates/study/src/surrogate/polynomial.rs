//! A polynomial as a surrogate: least squares, on the scale of a transform where there is one.

use super::{Forecast, Surrogate};
use crate::design::Setting;
use crate::effects::{Effects, EffectsError, Model, Transform, Variance};

/// Part of the points that must be there to be left out for an error to be known. A single centre point of a response surface,
/// without which there are no squares, is no reason to know nothing.
const LEAST_PART: f64 = 0.75;

/// The scale on which a model was fitted to a response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// How many of the unit that was transformed there are in the unit of the response.
    pub unit: f64,
    /// What was done to the response in that unit; none if it was fitted as it is.
    pub transform: Option<Transform>,
}

impl Scale {
    /// The response itself.
    pub const PLAIN: Self = Self { unit: 1.0, transform: None };

    /// A response on this scale; none beyond the domain of the transform.
    pub fn of(&self, response: f64) -> Option<f64> {
        self.transform.map_or(Some(response), |transform| transform.of(response * self.unit))
    }

    /// The response of a value on this scale.
    pub fn back(&self, value: f64) -> f64 {
        self.transform.map_or(value, |transform| transform.back(value) / self.unit)
    }
}

/// A polynomial that was fitted to a response.
#[derive(Debug, Clone, PartialEq)]
pub struct PolynomialSurrogate<'a> {
    effects: &'a Effects,
    scale: Scale,
    response: String,
}

impl<'a> PolynomialSurrogate<'a> {
    /// What an analysis of the response, on this scale, expects.
    pub fn new(response: &str, effects: &'a Effects, scale: Scale) -> Self {
        Self { effects, scale, response: response.to_owned() }
    }
}

impl Surrogate for PolynomialSurrogate<'_> {
    fn name(&self) -> String {
        let model = match self.effects.model {
            Model::MainEffects => "main effects",
            Model::Interactions => "main effects and interactions",
            Model::Full => "interactions of all orders",
            Model::Quadratic => "quadratic",
        };
        match self.scale.transform {
            None => format!("{model} in {}", self.response),
            Some(transform) => format!("{model} in {}({})", transform.name(), self.response),
        }
    }

    fn forecast(&self, settings: &[Setting], confidence: f64) -> Result<Forecast, EffectsError> {
        if !(confidence > 0.0 && confidence < 1.0) {
            return Err(EffectsError::Confidence(confidence));
        }
        let spread = self.effects.spread(settings)?;
        if !self.effects.tells(settings)? {
            return Ok(Forecast { value: self.scale.back(spread.value), mean_interval: None, run_interval: None });
        }
        let interval = |variance: Variance| {
            let reach = variance.reach(confidence);
            [spread.value - reach, spread.value + reach].map(|end| self.scale.back(end))
        };
        let [mean_interval, of_run] = [spread.mean, spread.run].map(|variance| variance.map(interval));
        // With few seeds the variance of means rests on few degrees of freedom, and that of runs on more: taken by itself, the
        // interval of one run could be the shorter one.
        let run_interval = of_run.map(|[low, high]| {
            mean_interval.map_or([low, high], |[mean_low, mean_high]| [low.min(mean_low), high.max(mean_high)])
        });
        Ok(Forecast { value: self.scale.back(spread.value), mean_interval, run_interval })
    }

    fn tells(&self, settings: &[Setting]) -> Result<bool, EffectsError> {
        self.effects.tells(settings)
    }

    fn value(&self, settings: &[Setting]) -> Result<f64, EffectsError> {
        Ok(self.scale.back(self.effects.spread(settings)?.value))
    }

    fn leave_one_out_error(&self) -> Option<f64> {
        let held_out = self.effects.held_out()?;
        let missed = |[response, without]: &[f64; 2]| (self.scale.back(*response) - self.scale.back(*without)).powi(2);
        let known: Vec<f64> = held_out.iter().flatten().map(missed).collect();
        let are_most = LEAST_PART * held_out.len() as f64 <= known.len() as f64;
        are_most.then(|| (known.iter().sum::<f64>() / known.len() as f64).sqrt())
    }
}
