//! Where responses are best: the settings at which what surrogates expect is liked most.
//!
//! | what | where |
//! |---|---|
//! | how much a response is liked | [`desirability`] |
//! | the largest value in a box | [`search`] |

#![allow(rustdoc::private_intra_doc_links)]

mod desirability;
mod search;

use thiserror::Error;

use crate::design::{self, Kind, Setting};
use crate::effects::EffectsError;
use crate::surrogate::{Forecast, Surrogate};

pub use desirability::{Goal, Wish, overall};

/// Most combinations of levels that are looked at.
const MOST_COMBINATIONS: usize = 100_000;
/// Points that are looked at in all, and at least at each combination of levels.
const POINTS: usize = 4096;
const LEAST_POINTS: usize = 16;
/// Points from which the search goes on.
const STARTS: usize = 16;

/// A response as near to its limit as this part of the difference that counts is on it.
const ON_LIMIT: f64 = 2e-3;

/// Where a factor may be.
#[derive(Debug, Clone, PartialEq)]
pub enum Axis {
    /// Anywhere between −1 and 1 in coded units.
    Range,
    /// At one of these settings; one alone holds the factor.
    Settings(Vec<Setting>),
}

/// What of a response has to keep a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kept {
    /// What is expected: about half of all runs keep it where that lies on the limit.
    #[default]
    Value,
    /// The interval of the mean of many runs.
    Means,
    /// The interval of one more run.
    Runs,
}

/// What a response has to keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Which response, by index.
    pub response: usize,
    /// At least this, if anything.
    pub least: Option<f64>,
    /// At most this, if anything.
    pub most: Option<f64>,
    /// A difference of the response that counts, to weigh how far different limits are missed.
    pub scale: f64,
    /// What has to keep it.
    pub kept: Kept,
}

/// The best settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// One for each factor.
    pub settings: Vec<Setting>,
    /// What is expected of each response there.
    pub forecasts: Vec<Forecast>,
    /// How much each goal's response is liked.
    pub desirabilities: Vec<f64>,
    /// Their mean; 0 where a limit is missed.
    pub overall: f64,
    /// Whether all limits are kept.
    pub keeps_limits: bool,
}

/// Why there is no optimum.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OptimumError {
    /// Nothing is asked for.
    #[error("no goal: at least one response has to be maximised, minimised or brought to a target")]
    NoGoal,
    /// A goal that no response can come nearer to.
    #[error("the values of goal {0} do not ascend")]
    Goal(usize),
    /// Too many combinations of levels.
    #[error(
        "the levels have {found} combinations, at most {MOST_COMBINATIONS} are looked at: hold some of the factors"
    )]
    Combinations {
        /// How many there are.
        found: usize,
    },
    /// No response can be foretold there.
    #[error(transparent)]
    Forecast(#[from] EffectsError),
}

/// What is searched for.
struct Problem<'a> {
    surrogates: &'a [&'a dyn Surrogate],
    goals: &'a [Goal],
    limits: &'a [Limit],
    axes: &'a [Axis],
    confidence: f64,
}

/// Finds the settings with the largest mean desirability at which all limits are kept. `surrogates` are those of the responses
/// that goals and limits name by index; intervals of what they expect have this confidence.
///
/// All combinations of levels are looked at, each at points spread over the ranges; from the best of all points the search
/// goes on step by step. Where no settings keep all limits, or all are worth nothing, those that miss least are given, which
/// [`Optimum::keeps_limits`] and [`Optimum::overall`] tell.
///
/// # Errors
/// [`OptimumError`].
pub fn optimum(
    surrogates: &[&dyn Surrogate],
    goals: &[Goal],
    limits: &[Limit],
    axes: &[Axis],
    confidence: f64,
) -> Result<Optimum, OptimumError> {
    if goals.is_empty() {
        return Err(OptimumError::NoGoal);
    }
    if let Some(unsound) = goals.iter().position(|goal| !goal.wish.is_sound()) {
        return Err(OptimumError::Goal(unsound + 1));
    }
    let problem = Problem { surrogates, goals, limits, axes, confidence };
    let combinations = problem.combinations()?;
    let dimensions = axes.iter().filter(|axis| **axis == Axis::Range).count();
    let points = spread(dimensions, (POINTS / combinations).max(LEAST_POINTS));
    let mut starts: Vec<(f64, usize, &Vec<f64>)> = Vec::new();
    for combination in 0..combinations {
        for point in &points {
            starts.push((problem.merit(combination, point)?, combination, point));
        }
        starts.sort_by(|one, other| other.0.total_cmp(&one.0));
        starts.truncate(STARTS);
    }
    let mut best: Option<(usize, search::Place)> = None;
    for (_, combination, point) in starts {
        // Forecasts that were there at the start are there along the way.
        let found = search::climb(point.clone(), &mut |at| problem.merit(combination, at).unwrap_or(f64::NEG_INFINITY));
        if best.as_ref().is_none_or(|(_, best)| found.value > best.value) {
            best = Some((combination, found));
        }
    }
    let (combination, place) = best.unwrap_or_else(|| (0, search::Place { at: vec![0.0; dimensions], value: 0.0 }));
    problem.at(problem.settings(combination, &place.at))
}

impl Problem<'_> {
    fn combinations(&self) -> Result<usize, OptimumError> {
        let levels = self.axes.iter().map(|axis| match axis {
            Axis::Range => 1,
            Axis::Settings(settings) => settings.len().max(1),
        });
        let found = levels.fold(1_usize, usize::saturating_mul);
        if found > MOST_COMBINATIONS { Err(OptimumError::Combinations { found }) } else { Ok(found) }
    }

    /// The settings of a combination of levels, by its number, at a place in the ranges.
    fn settings(&self, combination: usize, place: &[f64]) -> Vec<Setting> {
        let (mut left, mut place) = (combination, place.iter());
        let setting = |axis: &Axis| match axis {
            Axis::Range => Setting::Coded(place.next().copied().unwrap_or(0.0)),
            Axis::Settings(settings) => {
                let count = settings.len().max(1);
                let own = settings.get(left % count).copied().unwrap_or(Setting::Coded(0.0));
                left /= count;
                own
            }
        };
        self.axes.iter().map(setting).collect()
    }

    /// What the settings are worth: above 0 the mean desirability; where a limit is missed, or a response is worth nothing,
    /// below 0 by how far, so that the search knows the way back.
    fn merit(&self, combination: usize, place: &[f64]) -> Result<f64, EffectsError> {
        let settings = self.settings(combination, place);
        let values = self.surrogates.iter().map(|surrogate| surrogate.value(&settings));
        let values: Vec<f64> = values.collect::<Result<_, _>>()?;
        let mut missed = 0.0;
        for limit in self.limits {
            missed += match limit.kept {
                Kept::Value => limit.missed_by(&Forecast::of_value(values[limit.response])),
                _ => limit.missed_by(&self.surrogates[limit.response].forecast(&settings, self.confidence)?),
            };
        }
        let desirabilities = self.desirabilities(&values);
        let overall = overall(self.goals, &desirabilities);
        if missed > 0.0 {
            // A limit that is kept comes before any goal; goals still tell apart what misses alike.
            return Ok(-2.0 - missed);
        }
        if overall > 0.0 {
            return Ok(overall);
        }
        let short: f64 = self.goals.iter().map(|goal| goal.wish.part(values[goal.response]).min(0.0)).sum();
        Ok((short / (1.0 - short)).max(-1.0))
    }

    fn desirabilities(&self, values: &[f64]) -> Vec<f64> {
        self.goals.iter().map(|goal| goal.desirability(values[goal.response])).collect()
    }

    fn at(&self, settings: Vec<Setting>) -> Result<Optimum, OptimumError> {
        let forecasts = self.surrogates.iter().map(|surrogate| surrogate.forecast(&settings, self.confidence));
        let forecasts: Vec<Forecast> = forecasts.collect::<Result<_, _>>()?;
        let values: Vec<f64> = forecasts.iter().map(|forecast| forecast.value).collect();
        let desirabilities = self.desirabilities(&values);
        let keeps_limits = self.limits.iter().all(|limit| limit.missed_by(&forecasts[limit.response]) <= 0.0);
        let overall = if keeps_limits { overall(self.goals, &desirabilities) } else { 0.0 };
        Ok(Optimum { settings, forecasts, desirabilities, overall, keeps_limits })
    }
}

impl Limit {
    /// How far what has to keep the limit is beyond it, in differences that count. Without an interval that is what is expected.
    pub fn missed_by(&self, forecast: &Forecast) -> f64 {
        (-self.margin(forecast)).max(0.0)
    }

    /// How far what has to keep the limit is from it, in differences that count: negative beyond it, 0 on it.
    pub fn margin(&self, forecast: &Forecast) -> f64 {
        let [low, high] = self.kept_by(forecast);
        let above = self.least.map_or(f64::INFINITY, |least| low - least);
        let below = self.most.map_or(f64::INFINITY, |most| most - high);
        above.min(below) / self.scale
    }

    /// Whether the limit holds an optimum back: what has to keep it lies on it.
    pub fn holds(&self, forecast: &Forecast) -> bool {
        let [low, high] = self.kept_by(forecast);
        let is_on =
            |limit: Option<f64>, end: f64| limit.is_some_and(|limit| (limit - end).abs() < ON_LIMIT * self.scale);
        is_on(self.least, low) || is_on(self.most, high)
    }

    /// The ends of what has to keep the limit.
    fn kept_by(&self, forecast: &Forecast) -> [f64; 2] {
        let interval = match self.kept {
            Kept::Value => None,
            Kept::Means => forecast.mean_interval,
            Kept::Runs => forecast.run_interval,
        };
        interval.unwrap_or([forecast.value; 2])
    }
}

/// So many points spread over a box, with its middle; one where there are no dimensions.
fn spread(dimensions: usize, count: usize) -> Vec<Vec<f64>> {
    let mut points = vec![vec![0.0; dimensions]];
    if dimensions == 0 {
        return points;
    }
    // A power of two of points of the sequence is evenly spread. It has no more than 101 dimensions; then the middle is all.
    let kind = Kind::Sobol { points: count.next_power_of_two() };
    let Ok(design) = design::design(&kind, &vec![design::Factor::Range; dimensions]) else { return points };
    let coded = |setting: &Setting| if let Setting::Coded(coded) = setting { *coded } else { 0.0 };
    points.extend((0..design.points()).map(|point| design.point(point).iter().map(coded).collect()));
    points
}
