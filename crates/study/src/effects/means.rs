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
    /// Mean of the responses, or what the model makes of it.
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

    /// The same means adjusted for the other factors (least-squares means): what the model has at these levels, averaged over the
    /// levels of all others, each counted alike however often it was run, with their numbers in the middle of the range. In
    /// balanced designs with all terms they are the means of the runs. A mean that the runs do not tell stays as it is, and so do
    /// those at values of ranges.
    ///
    /// S. R. Searle, F. M. Speed, G. A. Milliken, Population marginal means in the linear model, Am. Stat. 34, 216–221 (1980),
    /// doi:10.1080/00031305.1980.10483031.
    pub fn adjusted_means(&self, factors: &[usize]) -> Vec<Cell> {
        let adjusted = |cell: Cell| {
            let given: Vec<(usize, Setting)> = factors.iter().copied().zip(cell.settings.iter().copied()).collect();
            let has_levels = cell.settings.iter().all(|setting| matches!(setting, Setting::Level(_)));
            let prediction = self.predict_at(&given).ok().filter(|_| has_levels && self.tells_at(&given));
            match prediction {
                Some(prediction) => Cell { mean: prediction.value, interval: prediction.interval, ..cell },
                None => cell,
            }
        };
        self.means(factors).into_iter().map(adjusted).collect()
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

#[cfg(test)]
mod tests {
    use crate::design::Setting;
    use crate::effects::{Factor, FactorKind, Model, Observation, Options, analyse};

    #[test]
    fn adjusted_means_do_not_depend_on_how_often_levels_were_run() {
        // By hand: 10, more by 4 at b and by 100 at y. Runs at a are mostly at y, so that the mean of the runs at a is larger.
        let words = |name: &str, labels: [&str; 2]| Factor {
            name: name.into(),
            kind: FactorKind::Categorical(labels.map(String::from).to_vec()),
        };
        let factors = [words("one", ["a", "b"]), words("other", ["x", "y"])];
        let places = [[0, 0], [0, 1], [0, 1], [0, 1], [1, 0], [1, 0], [1, 0], [1, 1]];
        let run = |(run, place): (usize, &[usize; 2])| Observation {
            settings: place.map(Setting::Level).to_vec(),
            replicate: 0,
            run,
            response: 10.0 + 4.0 * place[0] as f64 + 100.0 * place[1] as f64,
        };
        let observations: Vec<Observation> = places.iter().enumerate().map(run).collect();
        let options = Options { model: Model::MainEffects, ..Options::default() };
        let effects = analyse(&factors, &observations, &options).unwrap();
        let means = |cells: Vec<super::Cell>| cells.iter().map(|cell| cell.mean).collect::<Vec<_>>();
        assert_eq!(means(effects.level_means(0)), [85.0, 39.0]);
        for (found, expected) in means(effects.adjusted_means(&[0])).into_iter().zip([60.0, 64.0]) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
        for (found, expected) in means(effects.adjusted_means(&[0, 1])).into_iter().zip([10.0, 110.0, 14.0, 114.0]) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }
}
