//! How alike responses are at two points: Matérn's correlation with ν = 5/2 along each axis, and their product.
//!
//! C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning (MIT Press, 2006), eq. 4.17.

/// √5.
const ROOT: f64 = 2.236_067_977_499_79;

/// Beyond this sum along all axes, as a multiple of the lengths, points are not alike at all.
const FARTHEST: f64 = 700.0;

/// What distance is along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    /// The difference of two numbers.
    Number,
    /// 1 between any two categories.
    Category,
}

impl Axis {
    /// The distance, never negative.
    pub fn distance(self, one: f64, other: f64) -> f64 {
        match self {
            Self::Number => (one - other).abs(),
            Self::Category => f64::from(u8::from(one != other)),
        }
    }
}

/// The correlation at a distance, as a multiple of the length.
#[cfg(test)]
pub(super) fn correlation(distance: f64) -> f64 {
    let a = ROOT * distance;
    (1.0 + a + a * a / 3.0) * libm::exp(-a)
}

/// The derivative of the correlation's logarithm by the logarithm of the length: with t the distance over the length and
/// a = √5 t, a² (1 + a)/(3 + 3 a + a²).
pub(super) fn slope(distance: f64) -> f64 {
    let a = ROOT * distance;
    a * a * (1.0 + a) / (3.0 + 3.0 * a + a * a)
}

/// The correlation of two points, axes multiplied: of the exponentials, one of the sum.
pub(super) fn between(axes: &[Axis], lengths: &[f64], one: &[f64], other: &[f64]) -> f64 {
    let (mut product, mut sum) = (1.0, 0.0);
    for ((axis, length), (one, other)) in axes.iter().zip(lengths).zip(one.iter().zip(other)) {
        let a = ROOT * axis.distance(*one, *other) / length;
        product *= 1.0 + a + a * a / 3.0;
        sum += a;
    }
    // So far away the product may be more than there are numbers for, and its exponential is nothing.
    if sum < FARTHEST { product * libm::exp(-sum) } else { 0.0 }
}

/// The derivative of the logarithm of that by the first point's coordinate on one axis of numbers.
pub(super) fn log_derivative(length: f64, one: f64, other: f64) -> f64 {
    let a = ROOT * (one - other).abs() / length;
    let size = ROOT / length * a * (1.0 + a) / (3.0 + 3.0 * a + a * a);
    if one > other { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_correlation() {
        // Central differences of steps h have errors of h²: 1e-10 here.
        let step = 1e-5;
        for distance in [0.01, 0.3, 1.0, 4.0] {
            let by_length = |length: f64| libm::log(correlation(distance / length));
            let difference = (by_length(1.0 + step) - by_length(1.0 - step)) / (2.0 * step);
            assert!((slope(distance) - difference).abs() < 1e-8);
            let by_place = |place: f64| libm::log(correlation((place - 1.0).abs() / 0.7));
            for place in [1.0 + distance, 1.0 - distance] {
                let difference = (by_place(place + step) - by_place(place - step)) / (2.0 * step);
                assert!((log_derivative(0.7, place, 1.0) - difference).abs() < 1e-7, "{place}");
            }
        }
    }

    #[test]
    fn categories_are_alike_or_not() {
        assert_eq!(between(&[Axis::Category], &[0.5], &[2.0], &[2.0]), 1.0);
        let other = between(&[Axis::Category, Axis::Number], &[0.5, 3.0], &[2.0, 0.1], &[1.0, 0.1]);
        assert!((other - correlation(2.0)).abs() < 1e-16);
        let lengths = [0.5, 3.0];
        let both = between(&[Axis::Number, Axis::Number], &lengths, &[2.0, 0.1], &[1.0, 1.0]);
        assert!((both - correlation(2.0) * correlation(0.3)).abs() < 1e-16);
        assert_eq!(between(&[Axis::Number, Axis::Number], &lengths, &[1e200, 0.1], &[1.0, 1.0]), 0.0);
    }
}
