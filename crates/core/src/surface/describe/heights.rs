//! Height parameters (ISO 25178-2:2021, 4.2).

use super::grid::sums;

/// Moments and extremes of the heights above their mean: every measured point counts alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightParameters {
    /// z̄, m: the mean that the others are measured from.
    pub mean: f64,
    /// Sa = ⟨|z − z̄|⟩, m.
    pub arithmetical_mean_height: f64,
    /// Sq = √⟨(z − z̄)²⟩, m.
    pub root_mean_square_height: f64,
    /// Ssk = ⟨(z − z̄)³⟩/Sq³; NaN where all heights are equal.
    pub skewness: f64,
    /// Sku = ⟨(z − z̄)⁴⟩/Sq⁴; NaN where all heights are equal.
    pub kurtosis: f64,
    /// Sp, m: the highest point above the mean.
    pub maximum_peak_height: f64,
    /// Sv, m: depth of the lowest point below the mean.
    pub maximum_pit_depth: f64,
}

impl HeightParameters {
    /// Those of the heights that are there; none if there are none.
    pub fn of(heights: &[f64]) -> Option<Self> {
        let [count, sum] = sums(heights, |z| [1.0, z]);
        if count == 0.0 {
            return None;
        }
        // What rounding left of a large offset is taken out by the mean of the differences; added to the first mean for
        // those who need one number, but not here, for that rounds it again.
        let first = sum / count;
        let rest = sums(heights, |z| [z - first])[0] / count;
        let mean = first + rest;
        let moments = sums(heights, |z| {
            let height = (z - first) - rest;
            let square = height * height;
            [height.abs(), square, square * height, square * square]
        });
        let measured = || heights.iter().filter(|height| !height.is_nan());
        let lowest = measured().copied().fold(f64::INFINITY, f64::min);
        let highest = measured().copied().fold(f64::NEG_INFINITY, f64::max);
        let [absolute, square, cube, fourth] = moments.map(|moment| moment / count);
        let (rms, flat) = (square.sqrt(), highest == lowest);
        Some(Self {
            mean,
            arithmetical_mean_height: absolute,
            root_mean_square_height: rms,
            skewness: if flat { f64::NAN } else { cube / (square * rms) },
            kurtosis: if flat { f64::NAN } else { fourth / (square * square) },
            maximum_peak_height: highest - mean,
            maximum_pit_depth: mean - lowest,
        })
    }

    /// Sz = Sp + Sv, m.
    pub fn maximum_height(&self) -> f64 {
        self.maximum_peak_height + self.maximum_pit_depth
    }
}
