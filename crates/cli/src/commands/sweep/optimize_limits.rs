//! What is said of the limits of an optimum: which of them hold it back, and which cannot be kept.

use plateau_present::study::goals::{limit_words, observed};
use plateau_present::study::place::Space;
use plateau_study::design::Setting;
use plateau_study::optimum::{Axis, Goal, Kept, Limit, Optimum, Wish};
use plateau_study::surrogate::Forecast;
use serde::Serialize;

use super::analysed::Analysed;
use super::optimize_search::search;
use crate::failure::Failure;

/// A coded value as near to an end of the range as this is at it.
const AT_END: f64 = 1e-3;
/// How many ranges of the runs away a response is worth nothing or everything, where the most or least of it is looked for.
const FAR: f64 = 100.0;

/// An optimum's limits.
#[derive(Clone, Copy)]
pub struct Limited<'a> {
    pub analysed: &'a Analysed,
    pub limits: &'a [Limit],
    pub axes: &'a [Axis],
    /// What is expected of each response at the optimum.
    pub forecasts: &'a [Option<Forecast>],
}

impl Limited<'_> {
    /// What is said below the table.
    pub fn text(&self, best: &Optimum, confidence: f64) -> Result<String, Failure> {
        let mut lines = Vec::new();
        for limit in self.limits {
            let Some(forecast) = &self.forecasts[limit.response] else { continue };
            let response = &self.analysed.analysis.responses[limit.response];
            let words = format!("{} {}", response.name, limit_words(response, limit));
            if limit.missed_by(forecast) > 0.0 {
                lines.push(format!("{words}: missed; {}", self.alone(limit, confidence)?));
            } else if limit.holds(forecast) {
                let risk = match limit.kept {
                    Kept::Value => {
                        "; the predicted mean lies on it, so that about half of all runs will miss it: --limit-on runs keeps a margin"
                    }
                    _ => "",
                };
                lines.push(format!("held back by {words}{risk}"));
            }
        }
        let ends = self.at_ends(best);
        if !ends.is_empty() {
            lines.push(format!("at an end of the range: {}; the study knows nothing beyond it", ends.join(", ")));
        }
        Ok(lines.into_iter().map(|line| format!("  {line}\n")).collect())
    }

    /// How near a response comes to its limit where nothing else is wanted.
    fn alone(&self, limit: &Limit, confidence: f64) -> Result<String, Failure> {
        let analysis = &self.analysed.analysis;
        let response = &analysis.responses[limit.response];
        let [low, high] = observed(analysis, limit.response).unwrap_or([0.0, 1.0]);
        let reach = FAR * limit.scale;
        let ends = [low - reach, high + reach];
        let wish = if limit.least.is_some() { Wish::Maximum(ends) } else { Wish::Minimum(ends) };
        let goal = Goal { response: limit.response, wish, weight: 1.0, importance: 1.0 };
        let (best, forecasts) = search(self.analysed, &[goal], &[], self.axes, confidence)?;
        let Some(forecast) = &forecasts[limit.response] else { return Ok(String::new()) };
        let space = Space::new(self.analysed.plan.study(), analysis);
        let place = space.of(best.settings).map_err(Failure::input)?;
        let end = if limit.least.is_some() { "most" } else { "least" };
        let value = response.shown_with_unit(forecast.value);
        let can = if limit.missed_by(forecast) > 0.0 {
            ""
        } else {
            ", so that it can be kept alone, but not with the others"
        };
        Ok(format!("the {end} within the ranges is {value}, at {}{can}", space.words(&place)))
    }

    /// Factors that may move and are at an end of their range, with the end.
    pub fn at_ends(&self, best: &Optimum) -> Vec<String> {
        let space = Space::new(self.analysed.plan.study(), &self.analysed.analysis);
        let end = |(factor, setting): (usize, &Setting)| match (setting, &self.axes[factor]) {
            (Setting::Coded(coded), Axis::Range) if coded.abs() > 1.0 - AT_END => {
                Some(format!("{} ({})", self.analysed.plan.study().factors[factor].name, space.shown(factor, *coded)))
            }
            _ => None,
        };
        best.settings.iter().enumerate().filter_map(end).collect()
    }

    /// The limits in JSON.
    pub fn reports(&self) -> Vec<LimitReport> {
        let report = |limit: &Limit| {
            let forecast = self.forecasts[limit.response].as_ref();
            LimitReport {
                response: self.analysed.analysis.responses[limit.response].name.clone(),
                least: limit.least,
                most: limit.most,
                on: match limit.kept {
                    Kept::Value => "mean",
                    Kept::Means => "means",
                    Kept::Runs => "runs",
                },
                is_kept: forecast.is_some_and(|forecast| limit.missed_by(forecast) <= 0.0),
                holds_back: forecast.is_some_and(|forecast| limit.holds(forecast)),
            }
        };
        self.limits.iter().map(report).collect()
    }
}

/// A limit. Numbers are in SI units.
#[derive(Debug, Serialize)]
pub struct LimitReport {
    response: String,
    least: Option<f64>,
    most: Option<f64>,
    /// What has to keep it.
    on: &'static str,
    is_kept: bool,
    /// Whether it lies at the limit.
    holds_back: bool,
}
