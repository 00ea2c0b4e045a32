//! What was observed at which settings.

use std::collections::BTreeSet;

use super::error::EffectsError;
use super::factor::Factor;
use crate::design::Setting;

/// What a run was made at, and what came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// One for each factor. Factors with levels have levels, or −1 and 1 for the first and the second of two; ranges
    /// have coded values.
    pub settings: Vec<Setting>,
    /// Which repetition of the study: repetitions are made with the same seeds at all points, which makes them blocks.
    pub replicate: usize,
    /// Which run it is of, by any number. A program that computes the same from the same gives a run's response whenever
    /// it is asked, so observations of one run are one observation: they tell nothing of the error.
    pub run: usize,
    /// The response, NaN if there is none.
    pub response: f64,
}

/// Observations that have a response, each run once, with canonical settings.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Usable {
    /// Which of all observations, in their order.
    pub indices: Vec<usize>,
    /// Settings, by observation.
    pub settings: Vec<Vec<Setting>>,
    /// Responses.
    pub responses: Vec<f64>,
    /// Replicates, renumbered without gaps.
    pub blocks: Vec<usize>,
    /// Distinct settings, numbered as they appear.
    pub points: Vec<usize>,
    /// Observations of a run that another one is of.
    pub repeated: usize,
}

/// Responses beyond this have no squares.
const LARGEST_RESPONSE: f64 = 1e150;
/// Responses that differ by less than this have none either.
const SMALLEST_SPREAD: f64 = 1e-150;

impl Usable {
    /// Those that have a response, if it varies.
    pub fn new(factors: &[Factor], observations: &[Observation]) -> Result<Self, EffectsError> {
        let (mut indices, mut settings, mut responses, mut replicates) = (vec![], vec![], vec![], vec![]);
        let (mut seen, mut repeated) = (BTreeSet::new(), 0);
        for (index, each) in observations.iter().enumerate() {
            let canonical = canonical(factors, &each.settings)?;
            if !seen.insert(each.run) {
                repeated += 1;
                continue;
            }
            if each.response.is_nan() {
                continue;
            }
            if each.response.abs() > LARGEST_RESPONSE {
                return Err(EffectsError::Response { observation: index, value: each.response });
            }
            indices.push(index);
            settings.push(canonical);
            responses.push(each.response);
            replicates.push(each.replicate);
        }
        let range = responses.iter().fold(None, |range: Option<(f64, f64)>, response| {
            Some(range.map_or((*response, *response), |(low, high)| (low.min(*response), high.max(*response))))
        });
        let Some((low, high)) = range else {
            return Err(EffectsError::Empty { missing: observations.len() - repeated });
        };
        // Equal but for rounding.
        if high - low <= (16.0 * f64::EPSILON * low.abs().max(high.abs())).max(SMALLEST_SPREAD) {
            return Err(EffectsError::Constant { value: responses[0], observations: responses.len() });
        }
        let blocks = numbered(replicates.iter().copied());
        let points = numbered(settings.iter().map(|point| point.iter().copied().map(key).collect::<Vec<_>>()));
        Ok(Self { indices, settings, responses, blocks, points, repeated })
    }

    /// Number of distinct settings.
    pub fn point_count(&self) -> usize {
        count(&self.points)
    }
}

/// The settings of a point in their canonical form.
fn canonical(factors: &[Factor], settings: &[Setting]) -> Result<Vec<Setting>, EffectsError> {
    if settings.len() != factors.len() {
        return Err(EffectsError::Settings { found: settings.len(), expected: factors.len() });
    }
    factors.iter().zip(settings).map(|(factor, setting)| factor.canonical(*setting)).collect()
}

/// What tells one setting of a factor from another: coded values that differ by rounding only are the same.
pub(super) fn key(setting: Setting) -> i64 {
    match setting {
        Setting::Level(level) => level as i64,
        Setting::Coded(value) => (value * 1e9).round() as i64,
    }
}

/// Equal things get equal numbers, in ascending order of the things.
fn numbered<T: Ord>(things: impl Iterator<Item = T>) -> Vec<usize> {
    let things: Vec<T> = things.collect();
    let mut distinct: Vec<&T> = things.iter().collect();
    distinct.sort_unstable();
    distinct.dedup();
    things.iter().map(|thing| distinct.partition_point(|other| *other < thing)).collect()
}

/// How many numbers [`numbered`] gave.
pub(super) fn count(numbers: &[usize]) -> usize {
    numbers.iter().max().map_or(0, |largest| largest + 1)
}
