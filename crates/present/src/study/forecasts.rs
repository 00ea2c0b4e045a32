//! What is expected of the responses of a study where no run was made.

use plateau_io::number;
use plateau_io::study::bounds::Bounds;
use plateau_study::design::Setting;
use plateau_study::effects::{EffectsError, Transform};
use plateau_study::surrogate::{Choice, Forecast, PolynomialSurrogate, Surrogate, choose};

use super::analysis::AnalysedResponse;

/// Digits of predictions.
const DIGITS: usize = 4;

impl AnalysedResponse {
    /// What forecasts the response: the model or the process, whichever forecasts points better that it does not know; none
    /// where nothing could be fitted.
    pub fn surrogate(&self) -> Option<Box<dyn Surrogate + '_>> {
        self.choice_of_surrogate().map(|choice| choice.surrogate)
    }

    /// Why it is that one; none where there was no choice.
    pub fn reason_of_surrogate(&self) -> Option<String> {
        self.process.as_ref().and(self.effects.as_ref().ok())?;
        self.choice_of_surrogate().map(|choice| choice.reason)
    }

    fn choice_of_surrogate(&self) -> Option<Choice<'_>> {
        let mut candidates: Vec<Box<dyn Surrogate + '_>> = Vec::new();
        if let Ok(effects) = &self.effects {
            candidates.push(Box::new(PolynomialSurrogate::new(&self.name, effects, self.scale.scale)));
        }
        if let Some(process) = &self.process {
            candidates.push(Box::new(process.clone()));
        }
        let within = |surrogate| Box::new(Within { surrogate, bounds: self.bounds }) as Box<dyn Surrogate + '_>;
        choose(candidates.into_iter().map(within).collect(), |error| {
            let unit = &self.scale.unit;
            unit.with_symbol(&number::rounded(unit.difference(error), DIGITS))
        })
    }

    /// A value of the response, SI, in the unit in which it is read, without the unit.
    pub fn shown(&self, value: f64) -> String {
        match self.scale.unit.value(value) {
            f64::INFINITY => "∞".to_owned(),
            f64::NEG_INFINITY => "−∞".to_owned(),
            value => number::rounded(value, DIGITS),
        }
    }

    /// The same with the unit.
    pub fn shown_with_unit(&self, value: f64) -> String {
        self.scale.unit.with_symbol(&self.shown(value))
    }

    /// Name and unit, as above a column.
    pub fn head(&self) -> String {
        self.scale.unit.label(&self.name)
    }

    /// An interval, or that there is none.
    pub fn interval(&self, interval: Option<[f64; 2]>) -> String {
        interval.map_or_else(|| "–".to_owned(), |ends| ends.map(|end| self.shown(end)).join(" … "))
    }

    /// What is to be known of a forecast that reaches what the response cannot be; none of others.
    pub fn note_of_bounds(&self, forecast: &Forecast) -> Option<String> {
        let ends = [forecast.mean_interval, forecast.run_interval].into_iter().flatten().flatten();
        let bounds = self.bounds;
        let reached = |bound: f64| bound.is_finite() && ends.clone().any(|end| end == bound);
        let said = match (bounds.hold(forecast.value), reached(bounds.least), reached(bounds.most)) {
            (false, ..) => "the model expects what cannot be, so it does not hold here",
            (true, false, false) => return None,
            (true, true, false) => "the interval is cut at 0, for less cannot be",
            (true, false, true) => "the interval is cut at 1, for more cannot be",
            (true, true, true) => "the interval is cut at 0 and 1, for less or more cannot be",
        };
        let transform = if bounds.most == 1.0 { Transform::Logit } else { Transform::Logarithm };
        let advice = match self.scale.transform() {
            None => format!("; transform = \"{}\" keeps to what can be", transform.name()),
            Some(_) => String::new(),
        };
        Some(format!("{}: {said}{advice}", self.name))
    }

    /// The cells of a forecast: name, value, interval of means, interval of runs.
    pub fn cells(&self, forecast: &Forecast) -> Vec<String> {
        let intervals = [forecast.mean_interval, forecast.run_interval].map(|interval| self.interval(interval));
        [vec![self.head(), self.shown(forecast.value)], intervals.to_vec()].concat()
    }
}

/// A surrogate whose intervals leave out what a response cannot be. Its value stays: that a model expects what cannot be says
/// that it does not hold there.
struct Within<'a> {
    surrogate: Box<dyn Surrogate + 'a>,
    bounds: Bounds,
}

impl Surrogate for Within<'_> {
    fn name(&self) -> String {
        self.surrogate.name()
    }

    fn forecast(&self, settings: &[Setting], confidence: f64) -> Result<Forecast, EffectsError> {
        let Forecast { value, mean_interval, run_interval } = self.surrogate.forecast(settings, confidence)?;
        let clipped = |interval: Option<[f64; 2]>| interval.map(|ends| self.bounds.clipped(ends));
        Ok(Forecast { value, mean_interval: clipped(mean_interval), run_interval: clipped(run_interval) })
    }

    fn value(&self, settings: &[Setting]) -> Result<f64, EffectsError> {
        self.surrogate.value(settings)
    }

    fn leave_one_out_error(&self) -> Option<f64> {
        self.surrogate.leave_one_out_error()
    }
}

/// What the columns of [`AnalysedResponse::cells`] are, at a confidence level.
pub fn heads(confidence: f64) -> [String; 4] {
    let level = number::confidence(confidence);
    ["response".to_owned(), "predicted".to_owned(), format!("{level} of means"), format!("{level} of runs")]
}
