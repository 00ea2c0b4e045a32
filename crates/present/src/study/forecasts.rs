//! What is expected of the responses of a study where no run was made.

use plateau_io::number;
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
        choose(candidates, |error| {
            let unit = &self.scale.unit;
            unit.with_symbol(&number::rounded(unit.difference(error), DIGITS))
        })
    }

    /// A value of the response, SI, in the unit in which it is read, without the unit.
    pub fn shown(&self, value: f64) -> String {
        number::rounded(self.scale.unit.value(value), DIGITS)
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

    /// The cells of a forecast: name, value, interval of means, interval of runs.
    pub fn cells(&self, forecast: &Forecast) -> Vec<String> {
        let intervals = [forecast.mean_interval, forecast.run_interval].map(|interval| self.interval(interval));
        [vec![self.head(), self.shown(forecast.value)], intervals.to_vec()].concat()
    }
}

/// What the columns of [`AnalysedResponse::cells`] are, at a confidence level.
pub fn heads(confidence: f64) -> [String; 4] {
    let level = number::rounded(100.0 * confidence, 4);
    ["response".to_owned(), "predicted".to_owned(), format!("{level} % of means"), format!("{level} % of runs")]
}
