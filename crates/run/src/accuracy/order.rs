//! The observed order of convergence between neighbouring rungs of a ladder.

use std::fmt;

use super::choice::CLEAR;

/// A rung as it counts for the order: how coarse it is, and its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Time acceleration, or cells of the scene's mesh along a cell.
    pub size: f64,
    /// Its error.
    pub error: f64,
}

impl Point {
    /// Whether the error of the reference is small beside that of this rung.
    fn is_far_from(&self, reference: Self) -> bool {
        self.size >= FAR * reference.size && self.error >= CLEAR * reference.error
    }
}

/// Why two errors have no meaningful order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaningless {
    /// One of the errors is 0 or not known.
    NoError,
    /// The finer rung has less than [`FAR`] times the size of the reference, or less than [`CLEAR`] times its error, which is
    /// then not small beside it.
    NearReference,
    /// The coarser rung has not the greater error: what is seen is chance.
    NotGrowing,
}

/// How much coarser than the reference the finer rung must be.
pub const FAR: f64 = 3.0;

impl fmt::Display for Meaningless {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoError => "no error to compare with",
            Self::NearReference => "too near to the reference, whose own error is not small beside it",
            Self::NotGrowing => "the error does not grow: what is seen is chance",
        })
    }
}

/// log(error ratio)/log(size ratio) of a rung and the next finer one, or why that means nothing.
///
/// # Errors
/// [`Meaningless`], with the ratio where there is one.
pub fn observed(finer: Point, coarser: Point, reference: Point) -> Result<f64, (Meaningless, Option<f64>)> {
    let usable = |error: f64| error.is_finite() && error > 0.0;
    if !usable(finer.error) || !usable(coarser.error) {
        return Err((Meaningless::NoError, None));
    }
    let order = (coarser.error / finer.error).ln() / (coarser.size / finer.size).ln();
    if coarser.error <= finer.error {
        Err((Meaningless::NotGrowing, Some(order)))
    } else if !finer.is_far_from(reference) {
        Err((Meaningless::NearReference, Some(order)))
    } else {
        Ok(order)
    }
}

/// The order over all rungs that are [`FAR`] from the reference: the slope of a line through log(error) against log(size),
/// by least squares; none for less than three rungs.
pub fn fitted(points: &[Point], reference: Point) -> Option<f64> {
    let usable = |point: &&Point| point.is_far_from(reference) && point.error > 0.0 && point.error.is_finite();
    let logarithms: Vec<[f64; 2]> =
        points.iter().filter(usable).map(|point| [point.size.ln(), point.error.ln()]).collect();
    if logarithms.len() < 3 {
        return None;
    }
    let mean = |axis: usize| logarithms.iter().map(|point| point[axis]).sum::<f64>() / logarithms.len() as f64;
    let middle = [mean(0), mean(1)];
    let (products, squares) = logarithms.iter().fold((0.0, 0.0), |(products, squares), [size, error]| {
        (products + (size - middle[0]) * (error - middle[1]), squares + (size - middle[0]).powi(2))
    });
    (squares > 0.0).then(|| products / squares)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The model itself.
    const MODEL: Point = Point { size: 1.0, error: 0.0 };

    fn point(size: f64, error: f64) -> Point {
        Point { size, error }
    }

    #[test]
    fn power_laws_have_their_exponent() {
        for power in [0.5, 1.0, 2.0, 3.7] {
            let law = |size: f64| point(size, 1e-6 * size.powf(power));
            let order = observed(law(10.0), law(30.0), MODEL).unwrap();
            assert!((order - power).abs() < 1e-12, "{order}, expected {power}");
        }
    }

    #[test]
    fn the_fitted_order_of_a_power_law_is_its_exponent() {
        let mut points: Vec<Point> =
            [3.0, 10.0, 30.0, 100.0].map(|size: f64| point(size, 1e-5 * size.powf(0.7))).to_vec();
        // Too near to the reference, and without an error: they do not count.
        points.extend([point(2.0, 1.0), point(50.0, 0.0)]);
        assert!((fitted(&points, MODEL).unwrap() - 0.7).abs() < 1e-12);
        assert_eq!(fitted(&points[..2], MODEL), None);
        // By hand: errors e^0, e^2, e^1 at sizes e^2, e^3, e^4 have the slope (−1·−1 + 1·0)/2 = 1/2.
        let scattered =
            [(2.0, 0.0), (3.0, 2.0), (4.0, 1.0)].map(|(size, error): (f64, f64)| point(size.exp(), error.exp()));
        assert!((fitted(&scattered, MODEL).unwrap() - 0.5).abs() < 1e-12);
    }

    #[test]
    fn what_means_nothing_is_said() {
        // Errors of first order, seen from a reference of size 1: (3 − 1)/(2 − 1) = 2, log 2/log 1.5 = 1.71, not 1.
        let Err((Meaningless::NearReference, Some(order))) = observed(point(2.0, 1.0), point(3.0, 2.0), MODEL) else {
            panic!("near the reference")
        };
        assert!((order - 2_f64.ln() / 1.5_f64.ln()).abs() < 1e-15);
        let none = |finer, coarser| observed(finer, coarser, MODEL).unwrap_err().0;
        assert_eq!(none(point(5.0, 0.0), point(10.0, 1.0)), Meaningless::NoError);
        assert_eq!(none(point(5.0, 1.0), point(10.0, f64::NAN)), Meaningless::NoError);
        assert_eq!(none(point(5.0, 1.0), point(10.0, 0.5)), Meaningless::NotGrowing);
        // Far in size, but with an error of less than three times the reference's.
        let near = observed(point(10.0, 1.0), point(30.0, 2.0), point(2.0, 0.4)).unwrap_err().0;
        assert_eq!(near, Meaningless::NearReference);
        assert!(observed(point(10.0, 1.3), point(30.0, 2.0), point(2.0, 0.4)).is_ok());
    }
}
