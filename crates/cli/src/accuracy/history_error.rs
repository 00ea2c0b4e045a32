//! How far a history is from the reference's.

/// Error of a history, relative to the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryError {
    /// √(Σ (a − b)² / Σ b²) with b the reference.
    pub mean_square: f64,
    /// Largest |a − b| / |b| of any window.
    pub largest: f64,
}

impl HistoryError {
    /// Compares the means over the same windows; NaN where one of them is no number.
    pub fn of(values: &[f64], reference: &[f64]) -> Self {
        let pairs = || values.iter().zip(reference);
        let difference: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
        let size: f64 = reference.iter().map(|b| b.powi(2)).sum();
        Self { mean_square: (difference / size).sqrt(), largest: greatest(pairs().map(|(a, b)| ((a - b) / b).abs())) }
    }
}

/// Largest |a − b|.
pub fn largest_difference(values: &[f64], reference: &[f64]) -> f64 {
    greatest(values.iter().zip(reference).map(|(a, b)| (a - b).abs()))
}

/// The greatest of numbers that are not negative; NaN if one of them is no number.
fn greatest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| if number.is_nan() || number > most { number } else { most })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_of_the_definition() {
        // By hand: √((0.3² + 0.4²)/(3² + 4²)) = 0.1; the larger of 0.3/3 and 0.4/4.
        let error = HistoryError::of(&[3.3, 3.6], &[3.0, 4.0]);
        assert!((error.mean_square - 0.1).abs() < 1e-15 && (error.largest - 0.1).abs() < 1e-15, "{error:?}");
        assert_eq!(HistoryError::of(&[3.0, 4.0], &[3.0, 4.0]), HistoryError { mean_square: 0.0, largest: 0.0 });
        assert_eq!(largest_difference(&[1.0, 0.5], &[0.75, 1.0]), 0.5);
    }

    #[test]
    fn what_is_no_number_is_no_small_error() {
        let error = HistoryError::of(&[f64::NAN, 4.0], &[3.0, 4.0]);
        assert!(error.mean_square.is_nan() && error.largest.is_nan());
    }
}
