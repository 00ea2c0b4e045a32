//! The figures of an optimum.
//!
//! | figure | where |
//! |---|---|
//! | responses and desirability against each factor | [`profiler`] |
//! | the desirability over two factors | [`contour`] |

mod contour;
mod profiler;

use plateau_study::design::Setting;
use plateau_study::optimum::{Axis, Goal, Kept, Limit, overall};
use plateau_study::surrogate::{Forecast, Surrogate};

use super::format::Figure;
use crate::study::analysis::Analysis;

/// What is shown.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// The study's results.
    pub analysis: &'a Analysis,
    /// What is wanted; responses by their place in the study.
    pub goals: &'a [Goal],
    /// What has to be kept.
    pub limits: &'a [Limit],
    /// Where each factor may be.
    pub axes: &'a [Axis],
    /// The best settings.
    pub best: &'a [Setting],
    /// Confidence level of bands.
    pub confidence: f64,
}

/// The figures; the contour is over two factors, by index, and left out where the desirability is the same all over.
pub fn figures(shown: &Shown<'_>, pair: Option<[usize; 2]>) -> Vec<Figure> {
    profiler::figures(shown).into_iter().chain(pair.and_then(|pair| contour::figure(shown, pair))).collect()
}

impl<'a> Shown<'a> {
    /// What foretells each response; none where nothing could be fitted.
    fn surrogates(&self) -> Vec<Option<Box<dyn Surrogate + 'a>>> {
        self.analysis.responses.iter().map(|response| response.surrogate()).collect()
    }

    /// The best settings with some others in their place.
    fn with(&self, changed: &[(usize, Setting)]) -> Vec<Setting> {
        let mut settings = self.best.to_vec();
        for (factor, setting) in changed {
            settings[*factor] = *setting;
        }
        settings
    }

    /// The mean desirability at settings; 0 where a limit is missed.
    fn desirability(&self, surrogates: &[Option<Box<dyn Surrogate + 'a>>], settings: &[Setting]) -> Option<f64> {
        let value = |response: usize| surrogates.get(response)?.as_ref()?.value(settings).ok();
        for limit in self.limits {
            if self.margin(surrogates, limit, settings)? < 0.0 {
                return Some(0.0);
            }
        }
        let worth = self.goals.iter().map(|goal| Some(goal.desirability(value(goal.response)?)));
        Some(overall(self.goals, &worth.collect::<Option<Vec<_>>>()?))
    }

    /// How far settings are from a limit: negative where it is missed.
    fn margin(
        &self,
        surrogates: &[Option<Box<dyn Surrogate + 'a>>],
        limit: &Limit,
        settings: &[Setting],
    ) -> Option<f64> {
        let surrogate = surrogates.get(limit.response)?.as_ref()?;
        let forecast = match limit.kept {
            Kept::Value => Forecast { value: surrogate.value(settings).ok()?, mean_interval: None, run_interval: None },
            _ => surrogate.forecast(settings, self.confidence).ok()?,
        };
        Some(limit.margin(&forecast))
    }

    /// The two ranges along which the desirability changes most about the optimum; none where fewer are searched.
    pub fn pair(&self) -> Option<[usize; 2]> {
        let surrogates = self.surrogates();
        let mut spans: Vec<(usize, f64)> = (0..self.axes.len())
            .filter(|factor| self.axes[*factor] == Axis::Range)
            .map(|factor| {
                let values = (0..=20).filter_map(|at| {
                    let setting = Setting::Coded(-1.0 + 0.1 * f64::from(at));
                    self.desirability(&surrogates, &self.with(&[(factor, setting)]))
                });
                let (low, high) =
                    values.fold((1.0_f64, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
                (factor, high - low)
            })
            .collect();
        spans.sort_by(|one, other| other.1.total_cmp(&one.1));
        match spans[..] {
            [(one, _), (other, _), ..] => Some([one.min(other), one.max(other)]),
            _ => None,
        }
    }
}
