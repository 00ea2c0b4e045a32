//! What the collected results of a study tell of its factors: from runs to observations, and what is fitted.

use std::collections::HashSet;

use plateau_io::study::bounds::Bounds;
use plateau_io::study::collected::{Collected, unit_of};
use plateau_io::study::level::Level;
use plateau_io::study::plan::Plan;
use plateau_io::study::{DesignSource, Study};
use plateau_study::design::{Kind, Setting};
use plateau_study::effects::{
    self, Advice, BoxCox, Curvature, Effects, EffectsError, Misfit, Model, Observation, Options, Selection, analyse,
    select,
};
use plateau_study::surrogate::gaussian_process::{GaussianProcess, Options as ProcessOptions};
use plateau_study::surrogate::{PolynomialSurrogate, Surrogate};

use super::analysed_factor::AnalysedFactor;
use super::fit_scale::FitScale;
use super::model::Choice;
use crate::quantity::Unit;

/// How much smaller the leave-one-out error has to be for a transform to be advised.
const LOWERED: f64 = 0.95;
/// Predicted R² above which no transform is advised, unless the model misses something: what it would gain nobody would see.
const NOTHING_TO_GAIN: f64 = 0.999;

/// Most values that a factor has in a factorial or a composite design.
const MOST_FACTORIAL_LEVELS: usize = 5;

/// A study's factors as the analysis sees them, and what became of every response.
#[derive(Debug)]
pub struct Analysis {
    /// The factors.
    pub factors: Vec<AnalysedFactor>,
    /// The responses, in the order of the study.
    pub responses: Vec<AnalysedResponse>,
    /// Settings of the runs that were analysed, of all factors in their order, and the values of all responses (NaN where
    /// there is none): for plots of single runs.
    pub runs: Vec<(Vec<Setting>, Vec<f64>)>,
    /// Which one, from 1, each of the runs is in the order in which they are made.
    pub order: Vec<usize>,
}

/// A response.
#[derive(Debug)]
pub struct AnalysedResponse {
    /// Its name.
    pub name: String,
    /// Its SI unit.
    pub unit: &'static str,
    /// What it can be at all.
    pub bounds: Bounds,
    /// What the runs have; none where all have the same.
    pub observed: Option<Observed>,
    /// Number of factors.
    pub factors: usize,
    /// On which scale a model is fitted to it.
    pub scale: FitScale,
    /// What is fitted to it.
    pub choice: Choice,
    /// What the factors do to it, on that scale.
    pub effects: Result<Effects, EffectsError>,
    /// What the model misses.
    pub misfit: Option<Misfit>,
    /// What centre points differ by from a model without squares.
    pub curvature: Option<Curvature>,
    /// The power of the response that the model fits best.
    pub box_cox: Option<BoxCox>,
    /// The transform to try: none where it would not forecast points better that it does not know.
    pub advice: Option<Advice>,
    /// The choice among the terms of the model; none where all are kept.
    pub selected: Option<Selected>,
    /// What may forecast it besides the model: a process, on the same scale.
    pub process: Option<GaussianProcess>,
}

impl AnalysedResponse {
    /// What is fitted: its name, or `log(contact area, mm²)`.
    pub fn title(&self) -> String {
        self.scale.title(&self.name)
    }

    /// What is fitted, in words: the model, or the terms of it that were chosen.
    pub fn model_words(&self) -> String {
        let (Some(_), Ok(effects)) = (&self.selected, &self.effects) else { return self.choice.words() };
        let terms: Vec<&str> = effects.terms.iter().map(|term| term.label.as_str()).collect();
        let terms = if terms.is_empty() { "the mean alone".to_owned() } else { terms.join(", ") };
        format!("model: {terms}; chosen from {}", self.choice.terms())
    }

    /// SI unit of what is fitted.
    pub fn unit_of_fit(&self) -> &'static str {
        self.scale.unit_of_fit(self.unit)
    }

    /// The unit in which the fit and its results are shown.
    pub fn unit_shown(&self, effects: &Effects) -> Unit {
        let largest = effects.responses().map(f64::abs).fold(0.0, f64::max);
        Unit::readable_with_differences(self.unit_of_fit(), largest)
    }
}

/// What the runs have of a response, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observed {
    /// The least.
    pub low: f64,
    /// The most.
    pub high: f64,
    /// Standard deviation.
    pub deviation: f64,
}

impl Observed {
    /// Of values; none where fewer than two differ.
    fn new(values: impl Iterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mean = values.iter().map(|value| value / values.len() as f64).sum::<f64>();
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        (low < high && square > 0.0).then(|| Self { low, high, deviation: square.sqrt() })
    }
}

/// A choice among the terms of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Selected {
    /// Terms that were left out.
    pub left_out: Vec<String>,
    /// The criterion of those that were kept.
    pub aicc: f64,
    /// That of all; none where so many leave nothing for an error.
    pub aicc_of_all: Option<f64>,
}

/// How responses are to be analysed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// The model; one that the design allows unless given.
    pub model: Option<Model>,
    /// Whether terms that the runs do not support are left out.
    pub by_aicc: bool,
    /// Whether what forecasts a response may be a Gaussian process.
    pub processes: Processes,
    /// Confidence level of intervals.
    pub confidence: f64,
}

/// Which Gaussian processes are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Processes {
    /// None.
    None,
    /// Those for what is expected alone, of any design.
    ForValues,
    /// Those for intervals, too, where points fill the ranges.
    ForForecasts,
}

impl Analysis {
    /// Analyses every response of a study, with the model that is asked for or one that the design allows.
    pub fn new(study: &Study, collected: &Collected, asked: Option<Model>, confidence: f64) -> Self {
        Self::of(study, collected, Asked { model: asked, by_aicc: false, processes: Processes::None, confidence })
    }

    /// Analyses every response of a study as it is asked for.
    pub fn of(study: &Study, collected: &Collected, asked: Asked) -> Self {
        let factors: Vec<AnalysedFactor> = study
            .factors
            .iter()
            .enumerate()
            .map(|(at, factor)| AnalysedFactor::of(factor, &levels(collected, at)))
            .collect();
        let plain: Vec<effects::Factor> = factors.iter().map(|factor| factor.factor.clone()).collect();
        let settings: Vec<Vec<Setting>> = collected
            .runs
            .iter()
            .map(|run| {
                let levels = study.factors.iter().zip(&factors).zip(&run.run.levels);
                levels.map(|((factor, analysed), level)| analysed.setting(factor, level)).collect()
            })
            .collect();
        let responses =
            (0..study.responses.len()).map(|at| analyse_one(study, collected, &plain, &settings, at, asked));
        let responses = responses.collect();
        let runs: Vec<_> = settings.into_iter().zip(collected.runs.iter().map(|run| run.responses.clone())).collect();
        let order = (1..=runs.len()).collect();
        Self { factors, responses, runs, order }
    }

    /// The same with the order in which a plan makes its runs.
    #[must_use]
    pub fn in_order_of(mut self, plan: &Plan) -> Self {
        for (place, number) in plan.order().enumerate() {
            if let Some(own) = self.order.get_mut(number - 1) {
                *own = place + 1;
            }
        }
        self
    }
}

/// The analysis of a response, by its place in the study.
fn analyse_one(
    study: &Study,
    collected: &Collected,
    factors: &[effects::Factor],
    settings: &[Vec<Setting>],
    at: usize,
    asked: Asked,
) -> AnalysedResponse {
    let response = &study.responses[at];
    let unit = response.unit(unit_of(&response.series));
    let finite = collected.runs.iter().map(|run| run.responses[at].abs()).filter(|value| value.is_finite());
    let largest = finite.fold(0.0, f64::max);
    let scale = FitScale::new(response.transform, unit, largest);
    let (mut observations, mut beyond) = (Vec::new(), None);
    for (place, (run, settings)) in collected.runs.iter().zip(settings).enumerate() {
        let value = scale.scale.of(run.responses[at]);
        if value.is_none() && beyond.is_none() {
            beyond = Some(scale.beyond(run.run.number, run.responses[at]));
        }
        // What was measured elsewhere was measured for each run by itself.
        let own = if response.is_imported() { place } else { run.first };
        let (replicate, settings) = (run.run.replicate, settings.clone());
        observations.push(Observation { settings, replicate, run: own, response: value.unwrap_or(f64::NAN) });
    }
    let options = Options { confidence: asked.confidence, ..Options::default() };
    let choice = Choice::new(asked.model, study, factors, &observations, options.blocks);
    let options = Options { model: choice.model, ..options };
    let mut selected = None;
    let is_on_scale = beyond.is_none();
    let effects = match beyond {
        Some(error) => Err(error),
        None if asked.by_aicc => select(factors, &observations, &options).map(|selection| {
            let Selection { effects, left_out, aicc, aicc_of_all } = selection;
            selected = Some(Selected { left_out, aicc, aicc_of_all });
            effects
        }),
        None => analyse(factors, &observations, &options),
    };
    // Terms were left out because the runs do not support them: it would be no news that they explain something. What
    // replicates tell is.
    let misfit = effects.as_ref().ok().and_then(Effects::misfit);
    let misfit = misfit.filter(|misfit| selected.is_none() || misfit.by_replicates);
    let curvature = effects.as_ref().ok().and_then(Effects::curvature);
    let box_cox = effects.as_ref().ok().and_then(|effects| effects.box_cox(response.transform));
    let advice = box_cox.zip(effects.as_ref().ok()).and_then(|(found, effects)| {
        let advice = found.advice(response.transform)?;
        if effects.predicted_r_squared.is_some_and(|share| share > NOTHING_TO_GAIN) && misfit.is_none() {
            return None;
        }
        let transform = match advice {
            Advice::Try(transform) => Some(transform),
            Advice::NoTransform => None,
            Advice::OtherPower => return Some(advice),
        };
        let other = FitScale::new(transform, unit, largest).scale;
        let on_other = |each: &Observation| {
            let response = other.of(scale.scale.back(each.response)).unwrap_or(f64::NAN);
            Observation { response, ..each.clone() }
        };
        let other_effects = analyse(factors, &observations.iter().map(on_other).collect::<Vec<_>>(), &options).ok()?;
        let error = |effects, scale| PolynomialSurrogate::new("", effects, scale).leave_one_out_error();
        match (error(effects, scale.scale), error(&other_effects, other)) {
            (Some(own), Some(other)) if other > LOWERED * own => None,
            _ => Some(advice),
        }
    });
    // Without the responses that the transform is not for a process would know what the model does not.
    let fitted = || GaussianProcess::fit(factors, &observations, &ProcessOptions::default()).ok();
    let process = match asked.processes {
        Processes::ForValues if is_on_scale => fitted(),
        Processes::ForForecasts if is_on_scale && fills_ranges(study) => {
            fitted().map(GaussianProcess::with_likely_lengths)
        }
        _ => None,
    };
    let observed = Observed::new(collected.runs.iter().map(|run| run.responses[at]));
    let (name, bounds, factors) = (response.name.clone(), response.bounds(), factors.len());
    AnalysedResponse {
        name,
        unit,
        bounds,
        observed,
        factors,
        scale,
        choice,
        effects,
        misfit,
        curvature,
        box_cox,
        advice,
        selected,
        process,
    }
}

/// Whether points of the design lie all over the ranges, and not at few levels.
fn fills_ranges(study: &Study) -> bool {
    match &study.source {
        DesignSource::Kind(kind) => matches!(kind, Kind::LatinHypercube { .. } | Kind::Sobol { .. }),
        // A table of a few levels is a factorial or a composite design: between its points a polynomial knows more.
        DesignSource::File(points) => (0..study.factors.len()).all(|factor| {
            let mut values: Vec<f64> = points.iter().filter_map(|point| point[factor].number).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values.is_empty() || values.len() > MOST_FACTORIAL_LEVELS
        }),
    }
}

/// The different levels that a factor has in the runs, in the order in which they appear.
fn levels(collected: &Collected, factor: usize) -> Vec<Level> {
    let mut known = HashSet::new();
    let of_runs = collected.runs.iter().map(|run| &run.run.levels[factor]);
    of_runs.filter(|level| known.insert((&level.text, &level.label))).cloned().collect()
}
