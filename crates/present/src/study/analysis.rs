//! What the collected results of a study tell of its factors: from runs to observations, and what is fitted.

use std::collections::BTreeSet;

use plateau_io::study::Study;
use plateau_io::study::collected::{Collected, unit_of};
use plateau_io::study::factor::{Factor, Level, Values};
use plateau_study::design::Setting;
use plateau_study::effects::{self, Effects, EffectsError, FactorKind, Misfit, Model, Observation, Options, analyse};

use super::model::Choice;
use super::reading::Reading;

/// Values of a table of one's own up to which a factor has levels; with more it has a range, and where its values mostly
/// come once.
const MOST_LEVELS: usize = 10;

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
}

/// A factor.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysedFactor {
    /// As the analysis has it.
    pub factor: effects::Factor,
    /// Labels of its levels; empty for ranges.
    pub labels: Vec<String>,
    /// The unit in which the study states it.
    pub reading: Reading,
}

/// A response.
#[derive(Debug)]
pub struct AnalysedResponse {
    /// Its name.
    pub name: String,
    /// Its SI unit.
    pub unit: &'static str,
    /// What is fitted to it.
    pub choice: Choice,
    /// What the factors do to it.
    pub effects: Result<Effects, EffectsError>,
    /// What the model misses.
    pub misfit: Option<Misfit>,
}

impl Analysis {
    /// Analyses every response of a study, with the model that is asked for or one that the design allows.
    pub fn new(study: &Study, collected: &Collected, asked: Option<Model>, confidence: f64) -> Self {
        let different = collected.runs.iter().enumerate().filter(|(place, run)| run.first == *place);
        let points = different.map(|(_, run)| run.run.point).collect::<BTreeSet<_>>().len();
        let factors: Vec<AnalysedFactor> = study
            .factors
            .iter()
            .enumerate()
            .map(|(at, factor)| analysed(factor, &levels(collected, at), points))
            .collect();
        let plain: Vec<effects::Factor> = factors.iter().map(|factor| factor.factor.clone()).collect();
        let settings: Vec<Vec<Setting>> = collected
            .runs
            .iter()
            .map(|run| {
                let levels = study.factors.iter().zip(&factors).zip(&run.run.levels);
                levels.map(|((factor, analysed), level)| setting(factor, analysed, level)).collect()
            })
            .collect();
        let of_response = |at: usize| {
            let runs = collected.runs.iter().zip(&settings);
            let observation = |(run, settings): (&plateau_io::study::collected::CollectedRun, &Vec<Setting>)| {
                let (replicate, response) = (run.run.replicate, run.responses[at]);
                Observation { settings: settings.clone(), replicate, run: run.first, response }
            };
            let observations: Vec<Observation> = runs.map(observation).collect();
            let options = Options { confidence, ..Options::default() };
            let choice = Choice::new(asked, study, &plain, &observations, options.blocks);
            let options = Options { model: choice.model, ..options };
            (choice, analyse(&plain, &observations, &options))
        };
        let responses = study.responses.iter().enumerate().map(|(at, response)| {
            let (choice, effects) = of_response(at);
            let unit = response.unit(unit_of(&response.series));
            let misfit = effects.as_ref().ok().and_then(Effects::misfit);
            AnalysedResponse { name: response.name.clone(), unit, choice, effects, misfit }
        });
        let responses = responses.collect();
        let runs = settings.into_iter().zip(collected.runs.iter().map(|run| run.responses.clone())).collect();
        Self { factors, responses, runs }
    }
}

/// The different levels that a factor has in the runs, in the order in which they appear.
fn levels(collected: &Collected, factor: usize) -> Vec<Level> {
    let mut levels: Vec<Level> = Vec::new();
    for run in &collected.runs {
        let level = &run.run.levels[factor];
        if !levels.contains(level) {
            levels.push(level.clone());
        }
    }
    levels
}

fn analysed(factor: &Factor, found: &[Level], points: usize) -> AnalysedFactor {
    let stated: Vec<&Level> = match &factor.values {
        // One end may be zero, which is so in any unit.
        Values::Range { low, high, .. } => vec![high, low],
        Values::Levels(levels) => levels.iter().chain(found).collect(),
    };
    let logarithmic = matches!(factor.values, Values::Range { logarithmic: true, .. });
    let reading = Reading::of(stated, logarithmic);
    let range = |name: String, low: f64, high: f64| AnalysedFactor {
        factor: effects::Factor { name, kind: FactorKind::Range { low, high } },
        labels: Vec::new(),
        reading: reading.clone(),
    };
    let numbers = |levels: &[Level]| levels.iter().map(|level| level.number).collect::<Option<Vec<f64>>>();
    let is_table = matches!(&factor.values, Values::Levels(levels) if levels.is_empty());
    let listed = match &factor.values {
        Values::Range { low, high, logarithmic } => {
            let (low, high) = (low.number.unwrap_or(-1.0), high.number.unwrap_or(1.0));
            if *logarithmic {
                return range(format!("log₁₀ {}", factor.name), libm::log10(low), libm::log10(high));
            }
            return range(factor.name.clone(), low, high);
        }
        // What a table of one's own has.
        Values::Levels(levels) if levels.is_empty() => found,
        Values::Levels(levels) => levels,
    };
    let kind = match numbers(listed) {
        // Between two levels there are points of a response surface.
        Some(numbers) if numbers.len() == 2 && found.len() > 2 => {
            return range(factor.name.clone(), numbers[0], numbers[1]);
        }
        Some(numbers) if numbers.len() > MOST_LEVELS || is_table && numbers.len() > 2 && 2 * numbers.len() > points => {
            let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
            return range(factor.name.clone(), least, numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        }
        Some(numbers) => FactorKind::Levels(numbers),
        None => FactorKind::Categorical(listed.iter().map(|level| level.label.clone()).collect()),
    };
    let labels = listed.iter().map(|level| level.label.clone()).collect();
    AnalysedFactor { factor: effects::Factor { name: factor.name.clone(), kind }, labels, reading }
}

/// Where a level lies along a factor.
fn setting(factor: &Factor, analysed: &AnalysedFactor, level: &Level) -> Setting {
    match analysed.factor.kind {
        FactorKind::Range { low, high } => {
            let coded = factor.coded(level);
            let of_table = || level.number.map(|value| (2.0 * value - (low + high)) / (high - low));
            Setting::Coded(coded.or_else(of_table).unwrap_or(0.0))
        }
        FactorKind::Levels(_) | FactorKind::Categorical(_) => {
            Setting::Level(analysed.labels.iter().position(|label| *label == level.label).unwrap_or(0))
        }
    }
}
