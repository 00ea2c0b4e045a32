//! Elementary effects: what the response changes by when one factor does, at several places.
//!
//! M. D. Morris, Technometrics 33(2), 161–174 (1991), doi:10.1080/00401706.1991.10484804; μ*: F. Campolongo, J. Cariboni, A.
//! Saltelli, Environ. Model. Softw. 22, 1509–1518 (2007), doi:10.1016/j.envsoft.2006.10.004.

use crate::design::Setting;
use crate::effects::Factor;

/// What one factor does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementaryEffect {
    /// Mean of the effects' sizes: how much the factor matters. Effects are per whole range.
    pub mean_size: f64,
    /// Mean of the effects.
    pub mean: f64,
    /// Their standard deviation: large beside the mean size where the factor acts on a curve or together with others. NaN of
    /// fewer than two effects.
    pub deviation: f64,
    /// Standard error of the mean size; NaN of fewer than two effects.
    pub error: f64,
    /// How many effects there are.
    pub count: usize,
}

/// The elementary effects of all factors, from the points of a Morris design in their order with the response at each, NaN
/// where there is none: trajectories of one point more than there are factors, in each of which two points that follow each other
/// and differ in one factor give an effect of it.
///
/// A factor with categories has effects of a change of level; of numbers an effect is per whole range.
pub fn elementary_effects(factors: &[Factor], points: &[(Vec<Setting>, f64)]) -> Vec<ElementaryEffect> {
    let mut effects: Vec<Vec<f64>> = vec![Vec::new(); factors.len()];
    for pair in points.chunks(factors.len() + 1).flat_map(|trajectory| trajectory.windows(2)) {
        let (before, after) = (&pair[0].0, &pair[1].0);
        let changed: Vec<usize> = (0..factors.len()).filter(|at| before.get(*at) != after.get(*at)).collect();
        let ([factor], true) = (changed.as_slice(), (pair[1].1 - pair[0].1).is_finite()) else { continue };
        let step = match (factors[*factor].coded(before[*factor]), factors[*factor].coded(after[*factor])) {
            (Some(before), Some(after)) => 0.5 * (after - before),
            _ => 1.0,
        };
        effects[*factor].push((pair[1].1 - pair[0].1) / step);
    }
    effects.iter().map(|effects| summary(effects)).collect()
}

fn summary(effects: &[f64]) -> ElementaryEffect {
    let count = effects.len() as f64;
    let mean = |values: &dyn Fn(&f64) -> f64| effects.iter().map(values).sum::<f64>() / count;
    let (all, sizes) = (mean(&|effect| *effect), mean(&|effect| effect.abs()));
    let spread = |middle: f64, values: &dyn Fn(&f64) -> f64| match effects.len() {
        0 | 1 => f64::NAN,
        _ => (effects.iter().map(|effect| (values(effect) - middle).powi(2)).sum::<f64>() / (count - 1.0)).sqrt(),
    };
    ElementaryEffect {
        mean_size: sizes,
        mean: all,
        deviation: spread(all, &|effect| *effect),
        error: spread(sizes, &|effect| effect.abs()) / count.sqrt(),
        count: effects.len(),
    }
}
