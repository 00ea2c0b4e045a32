//! Predictions of the model.

use super::error::EffectsError;
use super::result::{Effects, Inner, Prediction};
use crate::design::Setting;

impl Effects {
    /// The response at settings, averaged over blocks. Terms without an estimate of their own count as zero. In a
    /// quadratic model, factors with numeric levels may be set between them, in coded units.
    ///
    /// # Errors
    /// If the settings do not fit the factors, or a level was never observed.
    pub fn predict(&self, settings: &[Setting]) -> Result<Prediction, EffectsError> {
        Ok(self.inner.predict(&self.inner.regressors.row(settings, None)?))
    }

    /// Whether the runs tell the response at settings. Where terms cannot be told from each other, they do at some settings alone,
    /// those of the runs among them; elsewhere a prediction takes terms without an estimate of their own for nothing.
    ///
    /// # Errors
    /// If the settings do not fit the factors, or a level was never observed.
    pub fn tells(&self, settings: &[Setting]) -> Result<bool, EffectsError> {
        Ok(self.inner.fit.tells(&self.inner.regressors.row(&self.by_value(settings), None)?))
    }

    /// The response where some factors, by index, have these settings: averaged over the levels of all others and over
    /// blocks, with their numbers at the middle of the range. Its interval is that of the mean with the seeds of the runs;
    /// [`mean_at`](Self::mean_at) has that with any seeds.
    ///
    /// # Errors
    /// If there is no such factor, a setting does not fit its factor, or a level was never observed.
    pub fn predict_at(&self, given: &[(usize, Setting)]) -> Result<Prediction, EffectsError> {
        Ok(self.inner.predict(&self.row_at(given)?))
    }

    /// Whether the runs tell that response.
    pub(super) fn tells_at(&self, given: &[(usize, Setting)]) -> bool {
        self.row_at(given).is_ok_and(|row| self.inner.fit.tells(&row))
    }

    pub(super) fn row_at(&self, given: &[(usize, Setting)]) -> Result<Vec<f64>, EffectsError> {
        let mut settings = vec![None; self.inner.factors.len()];
        for (factor, setting) in given {
            let found = EffectsError::Settings { found: factor + 1, expected: settings.len() };
            *settings.get_mut(*factor).ok_or(found)? = Some(*setting);
        }
        self.inner.regressors.row_at(&settings)
    }
}

impl Inner {
    /// The response for a row of the model matrix.
    pub fn predict(&self, row: &[f64]) -> Prediction {
        let (value, variance) = self.fit.predict(row);
        let value = self.offset + value;
        let standard_error = self.deviation.map(|deviation| deviation * variance.sqrt());
        Prediction { value, standard_error, interval: self.interval(value, standard_error) }
    }

    /// The confidence interval of a value with this standard error.
    pub fn interval(&self, value: f64, standard_error: Option<f64>) -> Option<[f64; 2]> {
        standard_error.map(|error| [value - self.quantile * error, value + self.quantile * error])
    }
}

#[cfg(test)]
mod tests {
    use crate::design::Setting;
    use crate::effects::{Factor, FactorKind, Observation, Options, analyse};

    #[test]
    fn factors_that_are_not_given_are_averaged_over() {
        // By hand: y = 10 + 2·x, more by 0, 3 or 6 at the three levels; their mean is 3.
        let factors = [
            Factor { name: "x".into(), kind: FactorKind::Range { low: 0.0, high: 1.0 } },
            Factor { name: "c".into(), kind: FactorKind::Categorical(["a", "b", "c"].map(String::from).to_vec()) },
        ];
        let point = |(run, (coded, level)): (usize, (f64, usize))| Observation {
            settings: vec![Setting::Coded(coded), Setting::Level(level)],
            replicate: 0,
            run,
            response: 10.0 + 2.0 * coded + 3.0 * level as f64 + if level == 2 { 0.5 * coded } else { 0.0 },
        };
        let points = [(-1.0, 0), (1.0, 0), (-1.0, 1), (1.0, 1), (-1.0, 2), (1.0, 2)];
        let observations: Vec<Observation> = points.into_iter().enumerate().map(point).collect();
        let effects = analyse(&factors, &observations, &Options::default()).unwrap();
        let at = |given: &[(usize, Setting)]| effects.predict_at(given).unwrap().value;
        assert!((at(&[]) - 13.0).abs() < 1e-12);
        assert!((at(&[(0, Setting::Coded(1.0))]) - (15.0 + 0.5 / 3.0)).abs() < 1e-12);
        assert!((at(&[(1, Setting::Level(2))]) - 16.0).abs() < 1e-12);
        let all = [Setting::Coded(0.3), Setting::Level(2)];
        assert_eq!(at(&[(0, all[0]), (1, all[1])]), effects.predict(&all).unwrap().value);
        assert!(effects.predict_at(&[(2, all[0])]).is_err());
    }
}
