//! The distribution of measured heights: their Abbott-Firestone curve, read either way.

/// Heights in order, as quantiles: the k-th of n stands for the probability (k + ½)/n, with straight lines between.
#[derive(Debug)]
pub(super) struct Quantiles(Vec<f64>);

impl Quantiles {
    /// Of some heights, at least one, all finite.
    pub fn of(mut heights: Vec<f64>) -> Self {
        heights.sort_by(f64::total_cmp);
        Self(heights)
    }

    /// The height that the fraction `probability` of all heights does not exceed.
    pub fn height(&self, probability: f64) -> f64 {
        let last = self.0.len() - 1;
        let place = (probability * self.0.len() as f64 - 0.5).clamp(0.0, last as f64);
        let below = (place as usize).min(last);
        let above = (below + 1).min(last);
        self.0[below] + (place - below as f64) * (self.0[above] - self.0[below])
    }

    /// The height for a standard normal number.
    pub fn of_normal(&self, x: f64) -> f64 {
        self.height(0.5 * libm::erfc(-x / std::f64::consts::SQRT_2))
    }

    /// Kurtosis of the heights, 3 for normal ones; NaN where all are alike.
    pub fn kurtosis(&self) -> f64 {
        let count = self.0.len() as f64;
        let mean = self.0.iter().sum::<f64>() / count;
        let moment = |power: i32| self.0.iter().map(|height| (height - mean).powi(power)).sum::<f64>() / count;
        moment(4) / (moment(2) * moment(2))
    }

    /// Gives a field exactly these heights in the order of its values: the lowest place gets the lowest height. Of equal values
    /// the first is the lower.
    pub fn impose(&self, field: &mut [f64]) {
        let mut order: Vec<u32> = (0..field.len() as u32).collect();
        order.sort_unstable_by(|a, b| field[*a as usize].total_cmp(&field[*b as usize]).then(a.cmp(b)));
        for (place, index) in order.into_iter().enumerate() {
            field[index as usize] = self.height((place as f64 + 0.5) / field.len() as f64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_imposed_on_as_many_places_are_the_measured_ones() {
        let quantiles = Quantiles::of(vec![5.0, -1.0, 2.0, 2.0]);
        let mut field = vec![0.3, 0.1, -7.0, 9.0];
        quantiles.impose(&mut field);
        assert_eq!(field, [2.0, 2.0, -1.0, 5.0]);
    }

    #[test]
    fn a_normal_number_has_the_height_of_its_probability() {
        let quantiles = Quantiles::of((0..1000).map(f64::from).collect());
        assert!((quantiles.of_normal(0.0) - 499.5).abs() < 1e-9);
        // Φ(1) = 0.841344746068543 (NIST DLMF 7.17).
        assert!((quantiles.of_normal(1.0) - (841.344746068543 - 0.5)).abs() < 1e-9);
        assert_eq!(quantiles.of_normal(40.0), 999.0);
    }
}
