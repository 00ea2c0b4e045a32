//! Which effects stand out where nothing tells the error.
//!
//! Lenth, R. V. (1989): Quick and easy analysis of unreplicated factorials. Technometrics 31, 469–473,
//! doi:10.1080/00401706.1989.10488595. Most effects are taken to be none, so the smaller ones show the error.

use super::distribution::{half_normal_quantile, t_quantile};

/// Fewest effects that show an error: of fewer the method has less than two degrees of freedom, and margins of many times the error.
const FEWEST_EFFECTS: usize = 6;
/// Effects that are this small beside the largest are rounding.
const ROUNDING: f64 = 1e-12;

/// What Lenth's method makes of effects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lenth {
    /// Pseudo standard error of an effect.
    pub pseudo_standard_error: f64,
    /// An effect beyond this is likely one, if it is the only one that is looked at.
    pub margin: f64,
    /// An effect beyond this is likely one, although it is picked from all.
    pub simultaneous_margin: f64,
}

impl Lenth {
    /// Judges effects that have equal errors, such as all of a design with two levels; none for fewer than six, and
    /// where more than half of them are zero.
    pub fn new(effects: &[f64], confidence: f64) -> Option<Self> {
        let mut sizes: Vec<f64> = effects.iter().map(|effect| effect.abs()).collect();
        if sizes.len() < FEWEST_EFFECTS || !sizes.iter().all(|size| size.is_finite()) {
            return None;
        }
        sizes.sort_unstable_by(f64::total_cmp);
        let first = 1.5 * median(&sizes);
        if first <= ROUNDING * sizes[sizes.len() - 1] {
            return None;
        }
        let small = sizes.partition_point(|size| *size < 2.5 * first);
        let pseudo_standard_error = 1.5 * median(&sizes[..small]);
        let count = sizes.len() as f64;
        let freedom = count / 3.0;
        let each = 1.0 - confidence.powf(1.0 / count);
        let margin = t_quantile(1.0 - confidence, freedom) * pseudo_standard_error;
        let simultaneous_margin = t_quantile(each, freedom) * pseudo_standard_error;
        Some(Self { pseudo_standard_error, margin, simultaneous_margin })
    }
}

/// Of sorted values, at least one.
fn median(sorted: &[f64]) -> f64 {
    let half = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[half] } else { 0.5 * (sorted[half - 1] + sorted[half]) }
}

/// Where the sizes of so many effects are expected, from the smallest, if all were normal deviates of unit standard
/// deviation: the half-normal quantiles of (i − ½)/m.
///
/// Daniel, C. (1959): Use of half-normal plots in interpreting factorial two-level experiments. Technometrics 1,
/// 311–341, doi:10.1080/00401706.1959.10489866.
pub fn half_normal_quantiles(count: usize) -> Vec<f64> {
    (0..count).map(|index| half_normal_quantile((index as f64 + 0.5) / count as f64)).collect()
}
