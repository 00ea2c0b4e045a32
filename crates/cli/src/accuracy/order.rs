//! The observed order of convergence between neighbouring rungs of a ladder.

use std::fmt;

/// A rung as it counts for the order: how coarse it is, and its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Time acceleration, or cells of the scene's mesh along a cell.
    pub size: f64,
    /// Its error.
    pub error: f64,
}

/// Why two errors have no meaningful order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaningless {
    /// One of the errors is 0 or not known.
    NoError,
    /// The finer rung has less than [`FAR`] times the size of the reference, whose own error is then not small beside it.
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
pub fn observed(finer: Point, coarser: Point, reference_size: f64) -> Result<f64, (Meaningless, Option<f64>)> {
    let usable = |error: f64| error.is_finite() && error > 0.0;
    if !usable(finer.error) || !usable(coarser.error) {
        return Err((Meaningless::NoError, None));
    }
    let order = (coarser.error / finer.error).ln() / (coarser.size / finer.size).ln();
    if coarser.error <= finer.error {
        Err((Meaningless::NotGrowing, Some(order)))
    } else if finer.size < FAR * reference_size {
        Err((Meaningless::NearReference, Some(order)))
    } else {
        Ok(order)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(size: f64, error: f64) -> Point {
        Point { size, error }
    }

    #[test]
    fn power_laws_have_their_exponent() {
        for power in [0.5, 1.0, 2.0, 3.7] {
            let law = |size: f64| point(size, 1e-6 * size.powf(power));
            let order = observed(law(10.0), law(30.0), 1.0).unwrap();
            assert!((order - power).abs() < 1e-12, "{order}, expected {power}");
        }
    }

    #[test]
    fn what_means_nothing_is_said() {
        // Errors of first order, seen from a reference of size 1: (3 − 1)/(2 − 1) = 2, log 2/log 1.5 = 1.71, not 1.
        let Err((Meaningless::NearReference, Some(order))) = observed(point(2.0, 1.0), point(3.0, 2.0), 1.0) else {
            panic!("near the reference")
        };
        assert!((order - 2_f64.ln() / 1.5_f64.ln()).abs() < 1e-15);
        let none = |finer, coarser| observed(finer, coarser, 1.0).unwrap_err().0;
        assert_eq!(none(point(5.0, 0.0), point(10.0, 1.0)), Meaningless::NoError);
        assert_eq!(none(point(5.0, 1.0), point(10.0, f64::NAN)), Meaningless::NoError);
        assert_eq!(none(point(5.0, 1.0), point(10.0, 0.5)), Meaningless::NotGrowing);
    }
}
