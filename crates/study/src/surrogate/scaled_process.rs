//! A Gaussian process as a surrogate, on the scale of a transform where there is one.

use super::gaussian_process::{GaussianProcess, LeftOut};
use super::{Forecast, Scale, Surrogate};
use crate::design::Setting;
use crate::effects::EffectsError;

/// A process that was fitted to a response on some scale; what it expects goes back from there. The median and the ends of
/// intervals stay what they are, for no transform changes an order.
#[derive(Debug, Clone)]
pub struct ScaledProcess<'a> {
    process: &'a GaussianProcess,
    scale: Scale,
    response: String,
}

impl<'a> ScaledProcess<'a> {
    /// What names begin with.
    pub const NAME: &'static str = "Gaussian process";

    /// What a process of the response, on this scale, expects.
    pub fn new(response: &str, process: &'a GaussianProcess, scale: Scale) -> Self {
        Self { process, scale, response: response.to_owned() }
    }
}

impl Surrogate for ScaledProcess<'_> {
    fn name(&self) -> String {
        match self.scale.transform {
            None => Self::NAME.to_owned(),
            Some(transform) => format!("{} of {}({})", Self::NAME, transform.name(), self.response),
        }
    }

    fn forecast(&self, settings: &[Setting], confidence: f64) -> Result<Forecast, EffectsError> {
        let Forecast { value, mean_interval, run_interval } = self.process.forecast(settings, confidence)?;
        let back = |interval: Option<[f64; 2]>| interval.map(|ends| ends.map(|end| self.scale.back(end)));
        Ok(Forecast {
            value: self.scale.back(value),
            mean_interval: back(mean_interval),
            run_interval: back(run_interval),
        })
    }

    fn value(&self, settings: &[Setting]) -> Result<f64, EffectsError> {
        Ok(self.scale.back(self.process.local(settings)?.mean))
    }

    fn leave_one_out_error(&self) -> Option<f64> {
        let left_out = self.process.left_out_refitted();
        let missed = |point: &LeftOut| (self.scale.back(point.observed) - self.scale.back(point.forecast)).powi(2);
        let mean = left_out.iter().map(missed).sum::<f64>() / left_out.len() as f64;
        Some(mean.sqrt()).filter(|error| error.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Factor, FactorKind, Observation, Transform};
    use crate::surrogate::gaussian_process::Options;

    #[test]
    fn the_process_of_logarithms_is_asked_for_responses() {
        let factors = [Factor { name: "a".into(), kind: FactorKind::Range { low: 0.0, high: 1.0 } }];
        let coded = |run: usize| run as f64 / 4.0 - 1.0;
        let runs = |response: &dyn Fn(f64) -> f64| -> Vec<Observation> {
            let run = |run: usize| Observation {
                settings: vec![Setting::Coded(coded(run))],
                replicate: 0,
                run,
                response: response(coded(run)) * (1.0 + 0.01 * libm::cos(11.0 * run as f64)),
            };
            (0..9).map(run).collect()
        };
        let plain = runs(&|x| libm::exp(3.0 * x) * 2e-9);
        // Millions of the unit, as a volume of mm³ in m³ is.
        let scale = Scale { unit: 1e9, transform: Some(Transform::Logarithm) };
        let logarithms: Vec<Observation> =
            plain.iter().map(|run| Observation { response: scale.of(run.response).unwrap(), ..run.clone() }).collect();
        let process = GaussianProcess::fit(&factors, &logarithms, &Options::default()).unwrap();
        let surrogate = ScaledProcess::new("wear", &process, scale);
        assert_eq!(surrogate.name(), "Gaussian process of log(wear)");
        let at = [Setting::Coded(-0.9)];
        let (found, own) = (surrogate.forecast(&at, 0.95).unwrap(), process.forecast(&at, 0.95).unwrap());
        assert!((found.value - libm::exp(own.value) * 1e-9).abs() < 1e-20);
        let ([low, high], [own_low, own_high]) = (found.run_interval.unwrap(), own.run_interval.unwrap());
        assert!(
            (low / (libm::exp(own_low) * 1e-9) - 1.0).abs() < 1e-12
                && (high / (libm::exp(own_high) * 1e-9) - 1.0).abs() < 1e-12
        );
        assert!(0.0 < low && low < found.value && found.value < high);
        assert_eq!(surrogate.value(&at).unwrap(), found.value);
    }
}
