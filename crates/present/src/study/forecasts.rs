//! What is expected of the responses of a study where no run was made.

use plateau_io::number;
use plateau_io::study::bounds::Bounds;
use plateau_study::design::Setting;
use plateau_study::effects::{EffectsError, Transform};
use plateau_study::surrogate::{Choice, Forecast, PolynomialSurrogate, ScaledProcess, Surrogate, choose};

use super::analysis::{AnalysedResponse, Observed};
use super::words::probability;

/// Digits of predictions.
const DIGITS: usize = 4;
/// Digits of leave-one-out errors.
const ERROR_DIGITS: usize = 3;
/// Points for each factor that a process should have.
const POINTS_FOR_EACH: usize = 10;

impl AnalysedResponse {
    /// What forecasts the response: the model or the process, whichever forecasts points better that it does not know; none
    /// where nothing could be fitted.
    pub fn surrogate(&self) -> Option<Box<dyn Surrogate + '_>> {
        self.choice_of_surrogate().map(|choice| choice.surrogate)
    }

    /// Why it is that one, how its error compares with the range of the runs, and whether these are few; none where there was
    /// no choice.
    pub fn reason_of_surrogate(&self) -> Option<String> {
        self.process.as_ref().and(self.effects.as_ref().ok())?;
        self.reason_of_choice()
    }

    /// The same where there was no choice, too.
    pub fn reason_of_choice(&self) -> Option<String> {
        let Choice { surrogate, reason } = self.choice_of_surrogate()?;
        let range = self.observed.map(|Observed { low, high, .. }| {
            format!("; the runs have {} to {}", self.shown(low), self.shown_with_unit(high))
        });
        let error = surrogate.leave_one_out_error();
        let is_useless = error.zip(self.observed).is_some_and(|(error, observed)| error >= observed.deviation);
        let useless = if is_useless {
            "; it foretells a point no better than the mean of the runs does: these runs do not tell the response"
        } else {
            ""
        };
        let is_process = self.effects.is_err() || surrogate.name().starts_with(ScaledProcess::NAME);
        let few = self.note_of_points().filter(|_| is_process);
        Some(reason + &range.unwrap_or_default() + useless + &few.unwrap_or_default())
    }

    /// That the model which forecasts it misses something that the runs show; none where it does not, or a process forecasts.
    pub fn note_of_misfit(&self) -> Option<String> {
        let p = self.misfit.as_ref()?.test.p;
        let is_process = self.surrogate()?.name().starts_with(ScaledProcess::NAME);
        (!is_process).then(|| {
            format!(
                "{}: the model misses something that the runs show (lack of fit p {}), so that intervals may be too short; sweep \
                 effects says what to try",
                self.name,
                probability(p)
            )
        })
    }

    /// That a process has few points.
    fn note_of_points(&self) -> Option<String> {
        let (process, factors) = (self.process.as_ref()?, self.factors);
        (process.points() < POINTS_FOR_EACH * factors).then(|| {
            format!(
                "; {} for {} are few, take {POINTS_FOR_EACH} for each factor or more",
                number::count(process.points(), "point"),
                number::count(factors, "factor"),
            )
        })
    }

    fn choice_of_surrogate(&self) -> Option<Choice<'_>> {
        let mut candidates: Vec<Box<dyn Surrogate + '_>> = Vec::new();
        if let Ok(effects) = &self.effects {
            candidates.push(Box::new(PolynomialSurrogate::new(&self.name, effects, self.scale.scale)));
        }
        if let Some(process) = &self.process {
            candidates.push(Box::new(ScaledProcess::new(&self.name, process, self.scale.scale)));
        }
        let within = |surrogate| Box::new(Within { surrogate, bounds: self.bounds }) as Box<dyn Surrogate + '_>;
        choose(candidates.into_iter().map(within).collect(), |error| {
            let unit = &self.scale.unit;
            let shown = unit.with_symbol(&number::rounded(unit.difference(error), ERROR_DIGITS));
            // The part of the variance of the runs that is foretold: 1 is all of it, 0 no more than the mean does.
            let part = self.observed.map(|Observed { deviation, .. }| 1.0 - (error / deviation).powi(2));
            shown
                + &part.map_or_else(String::new, |part| format!(" (Q² {})", number::with_minus(&format!("{part:.3}"))))
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
        let is_at = |bound: f64| bound.is_finite() && forecast.value == bound;
        let said = match (reached(bounds.least), reached(bounds.most)) {
            _ if is_at(bounds.least) => {
                "the model expects less than 0, which cannot be: it does not hold here, and 0 is shown"
            }
            _ if is_at(bounds.most) => {
                "the model expects more than 1, which cannot be: it does not hold here, and 1 is shown"
            }
            (false, false) => return None,
            (true, false) => "the interval is cut at 0, for less cannot be",
            (false, true) => "the interval is cut at 1, for more cannot be",
            (true, true) => "the interval is cut at 0 and 1, for less or more cannot be",
        };
        let transform = if bounds.most == 1.0 { Transform::Logit } else { Transform::Logarithm };
        let advice = match self.scale.transform() {
            None => format!("; transform = \"{}\" keeps to what can be", transform.name()),
            Some(_) => String::new(),
        };
        Some(format!("{}: {said}{advice}", self.name))
    }

    /// That few sets of seeds make the interval of means as wide as that of runs; none where it is shorter.
    pub fn note_of_few_seeds(&self, forecast: &Forecast) -> Option<String> {
        let [low, high] = forecast.mean_interval.filter(|_| forecast.mean_interval == forecast.run_interval)?;
        let has_seeds = self.effects.as_ref().is_ok_and(|effects| effects.blocks.is_some());
        (low < high && has_seeds).then(|| {
            format!(
                "{}: so few sets of seeds hardly tell by how much others would differ, so that the interval of means is as wide as that \
                 of runs; give [replicates] more seeds",
                self.name
            )
        })
    }

    /// That the runs do not tell the response at a place; none where they do.
    pub fn note_of_place(&self, settings: &[Setting]) -> Option<String> {
        let tells = self.surrogate()?.tells(settings).ok()?;
        (!tells).then(|| {
            format!(
                "{}: the runs do not tell it here, for some terms cannot be told from others; what is predicted takes these for \
                 nothing, and there is no interval",
                self.name
            )
        })
    }

    /// The cells of a forecast: name, value, interval of means, interval of runs.
    pub fn cells(&self, forecast: &Forecast) -> Vec<String> {
        let intervals = [forecast.mean_interval, forecast.run_interval].map(|interval| self.interval(interval));
        [vec![self.head(), self.shown(forecast.value)], intervals.to_vec()].concat()
    }
}

/// A surrogate whose forecasts leave out what a response cannot be. A search for the best place sees what is beyond, so that it
/// knows the way back.
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
        let [value, _] = self.bounds.clipped([value; 2]);
        Ok(Forecast { value, mean_interval: clipped(mean_interval), run_interval: clipped(run_interval) })
    }

    fn tells(&self, settings: &[Setting]) -> Result<bool, EffectsError> {
        self.surrogate.tells(settings)
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
