//! Forecasts of points that lengths and noise do not know either.
//!
//! [`GaussianProcess::left_out`] keeps the lengths of all points, which were chosen with the point that is left out. With few points
//! these find a shape in pure chance, and the error looks smaller than that of a point nobody has seen. Here lengths and noise are
//! fitted anew without each point, which is what a polynomial's leave-one-out error does with its coefficients.

use super::likelihood::most_likely;
use super::{GaussianProcess, Hyperparameters, LeftOut};

/// Most points: with more, one of them hardly moves the lengths, and the fits take long.
const MOST_POINTS: usize = 40;
/// Length and noise from which a second search begins: nothing but chance about the trend.
const CHANCE: [f64; 2] = [3.0, 3.0];

impl GaussianProcess {
    /// Every point with the forecast of it by the others, with lengths and noise of these; with more than forty points as
    /// [`GaussianProcess::left_out`]. It is worked out once.
    pub fn left_out_refitted(&self) -> &[LeftOut] {
        self.refitted.get_or_init(|| {
            let kept = self.left_out();
            if kept.len() > MOST_POINTS {
                return kept;
            }
            kept.iter().enumerate().map(|(at, kept)| self.without(at, kept).unwrap_or(*kept)).collect()
        })
    }

    /// The forecast of a point by a process that was fitted without it; none where that cannot be fitted.
    fn without(&self, at: usize, kept: &LeftOut) -> Option<LeftOut> {
        let mut averages = self.averages.clone();
        let place = averages.points.remove(at);
        averages.means.remove(at);
        averages.weights.remove(at);
        let axes = &self.inputs.axes;
        let [length, noise] = CHANCE;
        let starts = [self.hyperparameters.clone(), Hyperparameters { lengths: vec![length; axes.len()], noise }];
        let found = starts.iter().filter_map(|near| most_likely(axes, self.trend, &averages, Some(near)));
        let (hyperparameters, solved) =
            found.max_by(|one, other| one.1.log_likelihood.total_cmp(&other.1.log_likelihood))?;
        let process = Self {
            averages,
            hyperparameters,
            solved,
            inputs: self.inputs.clone(),
            trend: self.trend,
            likely: Vec::new(),
            calibration: 1.0,
            refitted: Default::default(),
        };
        let local = process.local_at(&place);
        Some(LeftOut { forecast: local.mean, variance: local.variance + process.run_variance(), ..*kept })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Setting;
    use crate::effects::{Factor, FactorKind, Observation};
    use crate::surrogate::gaussian_process::Options;

    /// Points of two factors whose places and responses go round by multiples of irrational numbers.
    fn observed(count: usize, response: impl Fn(&[f64; 2], usize) -> f64) -> Vec<Observation> {
        let part = |run: usize, step: f64| 2.0 * ((run as f64 + 0.5) * step).fract() - 1.0;
        let run = |run: usize| {
            let place = [part(run, 0.754_877_666), part(run, 0.569_840_290)];
            let settings = place.map(Setting::Coded).to_vec();
            Observation { settings, replicate: 0, run, response: response(&place, run) }
        };
        (0..count).map(run).collect()
    }

    /// A number between −1 and 1 by lot (splitmix64).
    fn chance(which: u64) -> f64 {
        let mut bits = (which + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        2.0 * ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
    }

    fn fitted(observations: &[Observation]) -> GaussianProcess {
        let factor = |name: &str| Factor { name: name.into(), kind: FactorKind::Range { low: -1.0, high: 1.0 } };
        GaussianProcess::fit(&[factor("a"), factor("b")], observations, &Options::default()).unwrap()
    }

    /// 1 − mean square of the errors over the variance of what was observed.
    fn share(points: &[LeftOut]) -> f64 {
        let count = points.len() as f64;
        let mean = points.iter().map(|point| point.observed).sum::<f64>() / count;
        let missed: f64 = points.iter().map(|point| (point.observed - point.forecast).powi(2)).sum();
        1.0 - missed / points.iter().map(|point| (point.observed - mean).powi(2)).sum::<f64>()
    }

    #[test]
    fn what_is_refitted_is_a_fit_without_the_point() {
        let all = observed(14, |place, run| libm::sin(3.0 * place[0]) + place[1] + 0.1 * libm::cos(7.0 * run as f64));
        let process = fitted(&all);
        let refitted = process.left_out_refitted();
        for at in [0, 5, 13] {
            let others: Vec<Observation> = all.iter().filter(|each| each.run != at).cloned().collect();
            let forecast = fitted(&others).local(&all[at].settings).unwrap().mean;
            // Both searches end where the gradient is nothing to speak of.
            assert!((forecast - refitted[at].forecast).abs() < 1e-3, "{at}: {forecast} {:?}", refitted[at]);
        }
    }

    #[test]
    fn pure_chance_is_not_foretold() {
        let mut shares = Vec::new();
        for seed in 0..24 {
            let process = fitted(&observed(12, |_, run| chance(100 * seed + run as u64)));
            shares.push([share(&process.left_out()), share(process.left_out_refitted())]);
        }
        // With the lengths of all points a third of these tables look as if they were foretold.
        let is_told = |which: usize| shares.iter().filter(|share| share[which] > 0.1).count();
        assert!(is_told(1) <= 3 && is_told(0) >= 2 * is_told(1), "{shares:?}");
    }
}
