//! Means of the responses at levels of factors, as main-effect and interaction plots show them.

use std::collections::BTreeMap;

use super::observation::key;
use super::result::Effects;
use crate::design::Setting;

/// A range with more distinct values than this has no levels to average at; lines are drawn from predictions then.
const MOST_VALUES: usize = 10;

/// Observations that have a setting, or two, in common.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// The setting of each factor asked for.
    pub settings: Vec<Setting>,
    /// Observations that have a response.
    pub count: usize,
    /// Mean of the responses.
    pub mean: f64,
    /// Its confidence interval, from the error of the whole study; none without an error.
    pub interval: Option<[f64; 2]>,
}

impl Effects {
    /// Means at each level of a factor, in ascending order; empty for ranges with more than ten values.
    pub fn level_means(&self, factor: usize) -> Vec<Cell> {
        self.means(&[factor])
    }

    /// Means at each pair of levels of two factors, those of the second varying fastest; pairs that were never observed
    /// are left out. Empty if either is a range with more than ten values.
    pub fn cell_means(&self, first: usize, second: usize) -> Vec<Cell> {
        self.means(&[first, second])
    }

    fn means(&self, factors: &[usize]) -> Vec<Cell> {
        let inner = &self.inner;
        if factors.iter().any(|factor| *factor >= inner.factors.len()) {
            return vec![];
        }
        let mut cells: BTreeMap<Vec<i64>, (Vec<Setting>, usize, f64)> = BTreeMap::new();
        for (settings, response) in inner.usable.settings.iter().zip(&inner.usable.responses) {
            let settings: Vec<Setting> = factors.iter().map(|factor| settings[*factor]).collect();
            let keys = settings.iter().copied().map(key).collect();
            let cell = cells.entry(keys).or_insert((settings, 0, 0.0));
            cell.1 += 1;
            cell.2 += response - inner.offset;
        }
        let has_too_many = |position: usize| {
            let mut keys: Vec<i64> = cells.keys().map(|keys| keys[position]).collect();
            keys.sort_unstable();
            keys.dedup();
            matches!(cells.values().next(), Some((settings, ..)) if matches!(settings[position], Setting::Coded(_)))
                && keys.len() > MOST_VALUES
        };
        if (0..factors.len()).any(has_too_many) {
            return vec![];
        }
        let cell = |(settings, count, sum): (Vec<Setting>, usize, f64)| {
            let mean = inner.offset + sum / count as f64;
            let standard_error = inner.deviation.map(|deviation| deviation / (count as f64).sqrt());
            Cell { settings, count, mean, interval: inner.interval(mean, standard_error) }
        };
        cells.into_values().map(cell).collect()
    }
}
