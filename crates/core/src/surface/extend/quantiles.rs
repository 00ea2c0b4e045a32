//! The distribution of the heights of a patch as a function of the material ratio, and heights put into it.

use std::f64::consts::SQRT_2;

/// The quantile function of heights: linear between the heights in their order, the i-th of n at the probability (i + ½)/n
/// (Hyndman and Fan 1996, definition 5, doi:10.1080/00031305.1996.10473566), constant beyond the first and the last.
#[derive(Debug)]
pub(super) struct Quantiles {
    ascending: Vec<f64>,
}

impl Quantiles {
    /// Those of at least one height.
    pub(super) fn of(heights: &[f64]) -> Self {
        let mut ascending = heights.to_vec();
        ascending.sort_unstable_by(f64::total_cmp);
        Self { ascending }
    }

    /// Whether there is one height only.
    pub(super) fn are_equal(&self) -> bool {
        self.ascending.first() == self.ascending.last()
    }

    /// The height that the fraction `probability` of the heights lies below.
    pub(super) fn at(&self, probability: f64) -> f64 {
        let last = self.ascending.len() - 1;
        let place = (probability * self.ascending.len() as f64 - 0.5).clamp(0.0, last as f64);
        let below = place as usize;
        let (low, high) = (self.ascending[below], self.ascending[(below + 1).min(last)]);
        low + (place - below as f64) * (high - low)
    }

    /// The height T(x) that has the place in the distribution that x has in the standard normal one.
    pub(super) fn normal(&self, x: f64) -> f64 {
        self.at(0.5 * libm::erfc(-x / SQRT_2))
    }

    /// Heights in the order of the values of a field: of N values the one of rank r gets the height at (r + ½)/N. Equal values
    /// rank as they stand in the field.
    pub(super) fn by_rank(&self, field: &[f64]) -> Vec<f64> {
        let mut order: Vec<usize> = (0..field.len()).collect();
        order.sort_unstable_by(|one, other| field[*one].total_cmp(&field[*other]).then(one.cmp(other)));
        let mut heights = vec![0.0; field.len()];
        for (rank, cell) in order.into_iter().enumerate() {
            heights[cell] = self.at((rank as f64 + 0.5) / field.len() as f64);
        }
        heights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_values_as_heights_get_these_heights() {
        let quantiles = Quantiles::of(&[3.0, -1.0, 7.0, 2.0]);
        assert_eq!(quantiles.by_rank(&[0.3, 0.1, 0.2, 0.4]), [3.0, -1.0, 2.0, 7.0]);
        // Equal values in the order of the cells.
        assert_eq!(quantiles.by_rank(&[1.0, 1.0, 0.0, 1.0]), [2.0, 3.0, -1.0, 7.0]);
    }

    #[test]
    fn the_normal_distribution_maps_on_itself() {
        // Quantiles of the normal distribution at (i + ½)/n: T(x) = x up to the error of linear interpolation,
        // h²/8 · |d²x/dp²| = (1/n)²/8 · |x|/φ(x)², and beyond the outermost, which are at ±Φ⁻¹(1/(2n)).
        let count = 20_001;
        let phi = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
        // Newton's method on erfc, from the middle outward.
        let mut heights = vec![0.0_f64; count];
        for index in count / 2 + 1..count {
            let target = 1.0 - (index as f64 + 0.5) / count as f64;
            let mut x = heights[index - 1];
            for _ in 0..60 {
                x += (0.5 * libm::erfc(x / SQRT_2) - target) / phi(x);
            }
            heights[index] = x;
            heights[count - 1 - index] = -x;
        }
        let quantiles = Quantiles::of(&heights);
        for step in -30..=30 {
            let x = f64::from(step) / 10.0;
            let error = (x.abs() + 1.0) / (8.0 * (count * count) as f64 * phi(x) * phi(x)) + 1e-9;
            assert!((quantiles.normal(x) - x).abs() < error, "{x}: {} ± {error}", quantiles.normal(x));
        }
    }
}
