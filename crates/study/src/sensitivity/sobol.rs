//! Sobol's indices: parts of the variance of a response when all factors vary over the whole of their ranges.
//!
//! I. M. Sobol', Math. Comput. Simul. 55, 271–280 (2001), doi:10.1016/S0378-4754(00)00270-6. Estimators: first order of A. Saltelli
//! et al., Comput. Phys. Commun. 181, 259–270 (2010), doi:10.1016/j.cpc.2009.09.018; total of M. J. W. Jansen, ibid. 117, 35–43
//! (1999), doi:10.1016/S0010-4655(98)00154-4.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use thiserror::Error;

use crate::design::{self, Design, DesignError, Kind, Setting};
use crate::effects::{EffectsError, Factor, FactorKind};
use crate::surrogate::Surrogate;

/// Confidence level at which a surrogate is asked; only its value is used.
const ANY_CONFIDENCE: f64 = 0.95;

/// How indices are estimated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Rows of the sample, best a power of two; the surrogate is asked (factors + 2) times as often.
    pub rows: usize,
    /// Samples that are drawn from it with replacement, for the intervals; none without.
    pub resamples: usize,
    /// Level of the intervals.
    pub confidence: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { rows: 2048, resamples: 300, confidence: 0.95 }
    }
}

/// Why there are no indices.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SensitivityError {
    /// No sample of so many factors.
    #[error("no sample of all ranges: {0}")]
    Sample(#[from] DesignError),
    /// The surrogate has no value somewhere.
    #[error(transparent)]
    Surrogate(#[from] EffectsError),
    /// The response does not vary.
    #[error("the surrogate has the same value everywhere: no factor has a part in its variance")]
    Constant,
}

/// Indices of one response.
#[derive(Debug, Clone, PartialEq)]
pub struct SobolIndices {
    /// First order, by factor: the part of the variance that is gone when the factor is known.
    pub first: Vec<Index>,
    /// Total, by factor: the part that is left when all others are known.
    pub total: Vec<Index>,
    /// Mean of the response over all ranges.
    pub mean: f64,
    /// Its variance.
    pub variance: f64,
}

/// A part of the variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Index {
    /// The part, from 0 to 1 but for the error of the sample.
    pub value: f64,
    /// Interval for the sample's error alone, not for that of the surrogate.
    pub interval: Option<[f64; 2]>,
}

impl Index {
    /// The same as far as it can be: a part of a whole lies between 0 and 1, and the sample's error may lead beyond.
    pub fn possible(&self) -> Self {
        // No −0.
        let held = |part: f64| part.clamp(0.0, 1.0) + 0.0;
        Self { value: held(self.value), interval: self.interval.map(|ends| ends.map(held)) }
    }
}

/// Where a response has to be known: two independent samples A and B of the ranges, and for each factor A with that factor of B.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    factors: Vec<Factor>,
    /// Coordinates of both, between −1 and 1 or levels: first those of A.
    both: Design,
}

/// The response at the places of a [`Sample`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Values {
    /// In A.
    pub a: Vec<f64>,
    /// In B.
    pub b: Vec<f64>,
    /// In A with one factor of B, by factor.
    pub mixed: Vec<Vec<f64>>,
}

impl Sample {
    /// A sample of so many rows: the points of a Sobol sequence of twice as many dimensions.
    ///
    /// # Errors
    /// No factors, no rows, or more than the sequence has dimensions for.
    pub fn new(factors: &[Factor], rows: usize) -> Result<Self, DesignError> {
        let kind = |factor: &Factor| match &factor.kind {
            FactorKind::Categorical(labels) => design::Factor::Levels(labels.len()),
            FactorKind::Levels(values) => design::Factor::Levels(values.len()),
            FactorKind::Range { .. } => design::Factor::Range,
        };
        let kinds: Vec<design::Factor> = factors.iter().chain(factors).map(kind).collect();
        // The first point of the sequence is a corner.
        let both = design::design(&Kind::Sobol { points: rows + 1 }, &kinds)?;
        Ok(Self { factors: factors.to_vec(), both })
    }

    /// Asks for the response at all places.
    ///
    /// # Errors
    /// Those of `response`.
    pub fn ask<E>(&self, mut response: impl FnMut(&[Setting]) -> Result<f64, E>) -> Result<Values, E> {
        let count = self.factors.len();
        let mut values = Values { mixed: vec![Vec::new(); count], ..Values::default() };
        for row in 1..self.both.points() {
            let (a, b) = self.both.point(row).split_at(count);
            values.a.push(response(a)?);
            values.b.push(response(b)?);
            let mut mixed = a.to_vec();
            for (factor, values) in values.mixed.iter_mut().enumerate() {
                mixed[factor] = b[factor];
                values.push(response(&mixed)?);
                mixed[factor] = a[factor];
            }
        }
        Ok(values)
    }
}

/// Indices of a surrogate, with all factors independent and each even over its range or its levels.
///
/// # Errors
/// [`SensitivityError`].
pub fn sobol_indices(
    factors: &[Factor],
    surrogate: &dyn Surrogate,
    options: &Options,
) -> Result<SobolIndices, SensitivityError> {
    let sample = Sample::new(factors, options.rows)?;
    let values = sample.ask(|settings| surrogate.forecast(settings, ANY_CONFIDENCE).map(|forecast| forecast.value))?;
    indices(&values, options).ok_or(SensitivityError::Constant)
}

/// Indices from the values at a sample; none where these do not vary.
pub fn indices(values: &Values, options: &Options) -> Option<SobolIndices> {
    let rows: Vec<usize> = (0..values.a.len()).collect();
    let all = of_rows(values, &rows)?;
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let count = rows.len() as u64;
    let draw = || -> Option<Moments> {
        let drawn: Vec<usize> = rows.iter().map(|_| (random.next_u64() % count) as usize).collect();
        of_rows(values, &drawn)
    };
    let resampled: Vec<Moments> = std::iter::repeat_with(draw).take(options.resamples).flatten().collect();
    let index = |of: fn(&Moments) -> &Vec<f64>, factor: usize| {
        let mut drawn: Vec<f64> = resampled.iter().map(|moments| of(moments)[factor]).collect();
        drawn.sort_by(f64::total_cmp);
        Index { value: of(&all)[factor], interval: percentiles(&drawn, options.confidence) }
    };
    let factors = 0..values.mixed.len();
    Some(SobolIndices {
        first: factors.clone().map(|factor| index(|moments| &moments.first, factor)).collect(),
        total: factors.map(|factor| index(|moments| &moments.total, factor)).collect(),
        mean: all.mean,
        variance: all.variance,
    })
}

/// The interval that leaves out equally many of sorted numbers at both ends.
fn percentiles(sorted: &[f64], confidence: f64) -> Option<[f64; 2]> {
    let last = sorted.len().checked_sub(1)?;
    let out = 0.5 * (1.0 - confidence) * last as f64;
    Some([sorted[out.floor() as usize], sorted[(last as f64 - out).ceil() as usize]])
}

struct Moments {
    first: Vec<f64>,
    total: Vec<f64>,
    mean: f64,
    variance: f64,
}

/// Estimates from some rows of a sample; none where the values do not vary.
fn of_rows(values: &Values, rows: &[usize]) -> Option<Moments> {
    let count = rows.len() as f64;
    let both = || rows.iter().flat_map(|row| [values.a[*row], values.b[*row]]);
    let mean = both().sum::<f64>() / (2.0 * count);
    let variance = both().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (2.0 * count);
    if variance.is_nan() || variance <= (1e-12 * mean).powi(2) {
        return None;
    }
    // An estimate of the first order has the least error where the values are centred: at the mean of all of them.
    let of_all = values.mixed.iter().map(|mixed| rows.iter().map(|row| mixed[*row]).sum::<f64>()).sum::<f64>();
    let centre = (of_all + 2.0 * count * mean) / (count * (values.mixed.len() + 2) as f64);
    let over_rows = |term: &dyn Fn(usize) -> f64| rows.iter().map(|row| term(*row)).sum::<f64>() / count;
    let first = |mixed: &Vec<f64>| over_rows(&|row| (values.b[row] - centre) * (mixed[row] - values.a[row])) / variance;
    let total = |mixed: &Vec<f64>| over_rows(&|row| (values.a[row] - mixed[row]).powi(2)) / (2.0 * variance);
    Some(Moments {
        first: values.mixed.iter().map(first).collect(),
        total: values.mixed.iter().map(total).collect(),
        mean,
        variance,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranges(count: usize, half: f64) -> Vec<Factor> {
        let range = |at| Factor { name: format!("x{at}"), kind: FactorKind::Range { low: -half, high: half } };
        (0..count).map(range).collect()
    }

    fn coded(settings: &[Setting]) -> Vec<f64> {
        settings.iter().map(|setting| if let Setting::Coded(coded) = setting { *coded } else { f64::NAN }).collect()
    }

    fn of(count: usize, rows: usize, function: impl Fn(&[f64]) -> f64) -> SobolIndices {
        let sample = Sample::new(&ranges(count, 1.0), rows).unwrap();
        let values = sample.ask(|settings| Ok::<_, DesignError>(function(&coded(settings)))).unwrap();
        indices(&values, &Options { rows, resamples: 50, confidence: 0.95 }).unwrap()
    }

    #[test]
    fn the_function_of_ishigami() {
        // sin x₁ + a sin² x₂ + b x₃⁴ sin x₁ on (−π, π)³ with a = 7, b = 0.1; T. Ishigami, T. Homma, ISUMA'90, 398–403. Its
        // variance is a²/8 + bπ⁴/5 + b²π⁸/18 + 1/2, of which (1 + bπ⁴/5)²/2 belong to x₁, a²/8 to x₂ and 8b²π⁸/225 to x₁ and x₃.
        let (a, b, pi) = (7.0_f64, 0.1, std::f64::consts::PI);
        let found = of(3, 1 << 14, |x| {
            let [x, y, z] = [0, 1, 2].map(|at| pi * x[at]);
            libm::sin(x) * (1.0 + b * z.powi(4)) + a * libm::sin(y).powi(2)
        });
        let variance = a * a / 8.0 + b * pi.powi(4) / 5.0 + b * b * pi.powi(8) / 18.0 + 0.5;
        let parts = [0.5 * (1.0 + b * pi.powi(4) / 5.0).powi(2), a * a / 8.0, 8.0 * b * b * pi.powi(8) / 225.0];
        assert!((found.variance / variance - 1.0).abs() < 0.005, "{found:?}");
        assert!((found.mean - 0.5 * a).abs() < 0.01);
        let first = [parts[0], parts[1], 0.0].map(|part| part / variance);
        let total = [parts[0] + parts[2], parts[1], parts[2]].map(|part| part / variance);
        // A random sample of 2¹⁴ rows has errors of 1/√2¹⁴ = 0.008 each; evenly spread points have less.
        for at in 0..3 {
            assert!((found.first[at].value - first[at]).abs() < 0.008, "{found:?}");
            assert!((found.total[at].value - total[at]).abs() < 0.008, "{found:?}");
            let [low, high] = found.total[at].interval.unwrap();
            assert!(low <= found.total[at].value && found.total[at].value <= high && high - low < 0.06);
        }
    }

    #[test]
    fn the_g_function() {
        // Π (|4u − 2| + a)/(1 + a) on (0, 1)ⁿ: variances of the factors Vᵢ = 1/(3(1 + aᵢ)²), total Vᵢ Π(1 + Vⱼ) over the
        // others, of a variance Π(1 + Vⱼ) − 1 (A. Saltelli, I. M. Sobol', 1995).
        let a = [0.0, 1.0, 4.5, 9.0, 99.0];
        let parts = a.map(|a: f64| 1.0 / (3.0 * (1.0 + a).powi(2)));
        let product: f64 = parts.iter().map(|part| 1.0 + part).product();
        let found = of(5, 1 << 14, |x| x.iter().zip(a).map(|(x, a)| ((2.0 * x).abs() + a) / (1.0 + a)).product());
        assert!((found.variance / (product - 1.0) - 1.0).abs() < 0.01 && (found.mean - 1.0).abs() < 0.005);
        for (at, part) in parts.iter().enumerate() {
            let (first, total) = (part / (product - 1.0), part * product / (1.0 + part) / (product - 1.0));
            assert!((found.first[at].value - first).abs() < 0.008, "{at} {found:?}");
            assert!((found.total[at].value - total).abs() < 0.008, "{at} {found:?}");
        }
    }

    #[test]
    fn levels_have_equal_shares_and_constants_are_refused() {
        // y = 1, 2 or 6 by level, plus x of variance 1/3: the level's variance is 14/3.
        let level =
            Factor { name: "c".into(), kind: FactorKind::Categorical(["a", "b", "c"].map(String::from).to_vec()) };
        let sample = Sample::new(&[level, ranges(1, 1.0).remove(0)], 1 << 12).unwrap();
        let value = |settings: &[Setting]| match settings {
            [Setting::Level(level), Setting::Coded(x)] => [1.0, 2.0, 6.0][*level] + x,
            _ => f64::NAN,
        };
        let found = indices(&sample.ask(|s| Ok::<_, DesignError>(value(s))).unwrap(), &Options::default()).unwrap();
        assert!((found.first[0].value - 14.0 / 15.0).abs() < 0.02 && (found.total[1].value - 1.0 / 15.0).abs() < 0.02);
        let beyond = Index { value: -1e-5, interval: Some([-0.01, 1.002]) }.possible();
        assert_eq!(format!("{beyond:?}"), "Index { value: 0.0, interval: Some([0.0, 1.0]) }");
        let constant = sample.ask(|_| Ok::<_, DesignError>(3.0)).unwrap();
        assert_eq!(indices(&constant, &Options::default()), None);
    }
}
