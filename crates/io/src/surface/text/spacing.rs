//! Even spacing of the points of a profile, which coordinates with few digits show only roughly.

use super::error::TextError;

/// Coordinates that are off by no more than this, in steps, are evenly spaced.
const OFF: f64 = 0.02;

/// At least this fraction of the points of a profile has to be there.
const COVERAGE: f64 = 0.9;

/// Evenly spaced points.
#[derive(Debug, PartialEq)]
pub(super) struct Spacing {
    /// Distance of neighbours, in the unit of the coordinates.
    pub(super) step: f64,
    /// Points, also those that are not there.
    pub(super) count: usize,
    /// The place of each coordinate, from 0.
    pub(super) places: Vec<usize>,
    /// What the coordinates are rounded to, where that is seen.
    pub(super) rounded_to: Option<f64>,
}

impl Spacing {
    /// The spacing of coordinates that grow, or fall, from point to point; `lines` are where they stand.
    ///
    /// They are on a grid within [`OFF`], or on one of which a tenth of the points is missing at most, or on one when
    /// their rounding to a decimal place is taken into account.
    ///
    /// # Errors
    /// [`TextError`] with the numbers where they are not evenly spaced.
    pub(super) fn of(coordinates: &[f64], lines: &[usize]) -> Result<Self, TextError> {
        let [first, second, ..] = coordinates else {
            return Err(TextError::ShortProfile { points: coordinates.len() });
        };
        let sign = if second < first { -1.0 } else { 1.0 };
        let along: Vec<f64> = coordinates.iter().map(|x| sign * (x - first)).collect();
        if let Some(at) = along.windows(2).position(|pair| pair[1] <= pair[0]) {
            let (found, before) = (coordinates[at + 1], coordinates[at]);
            return Err(TextError::Disorder { line: lines[at + 1], found, before });
        }
        let last = along.len() - 1;
        let step = along[last] / last as f64;
        let mut gaps: Vec<f64> = along.windows(2).map(|pair| pair[1] - pair[0]).collect();
        gaps.sort_unstable_by(f64::total_cmp);
        let (point, off) = farthest(&along, step);
        if half_range(along.iter().enumerate().map(|(point, x)| x - step * point as f64)) <= OFF * step {
            return Ok(Self { step, count: last + 1, places: (0..=last).collect(), rounded_to: None });
        }
        if let Some(holed) = Self::with_holes(&along, gaps[gaps.len() / 2]) {
            return Ok(holed);
        }
        let rounded_to = rounding(coordinates, step, off, &gaps);
        if rounded_to.is_some() {
            return Ok(Self { step, count: last + 1, places: (0..=last).collect(), rounded_to });
        }
        Err(TextError::Uneven {
            line: lines[point],
            found: coordinates[point],
            expected: first + sign * step * point as f64,
            step,
            gaps: [gaps[0], gaps[gaps.len() - 1]],
        })
    }

    /// Points on a grid of about this step of which some are missing.
    fn with_holes(along: &[f64], step: f64) -> Option<Self> {
        let length = along.last()?;
        let steps = (length / step).round();
        if (along.len() as f64) < COVERAGE * (steps + 1.0) {
            return None;
        }
        let step = length / steps;
        let places: Vec<f64> = along.iter().map(|x| x / step).collect();
        let on_grid = half_range(places.iter().map(|place| place - place.round())) <= OFF;
        let places: Vec<usize> = places.iter().map(|place| place.round() as usize).collect();
        let apart = places.windows(2).all(|pair| pair[0] < pair[1]);
        (on_grid && apart).then(|| Self { step, count: steps as usize + 1, places, rounded_to: None })
    }
}

/// How far numbers are from the middle between the least and the greatest of them: the first point may be off its place as any other.
fn half_range(numbers: impl Iterator<Item = f64>) -> f64 {
    let [least, most] =
        numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], next| [least.min(next), most.max(next)]);
    0.5 * (most - least)
}

/// The point that is farthest from its place on a grid, and how far.
fn farthest(along: &[f64], step: f64) -> (usize, f64) {
    let off = along.iter().enumerate().map(|(point, x)| (point, (x - step * point as f64).abs()));
    off.fold((0, 0.0), |farthest, point| if point.1 > farthest.1 { point } else { farthest })
}

/// The decimal place to which evenly spaced coordinates are rounded: all are multiples of it, the gaps differ by no more
/// than it, and no point is off by more (half for its own rounding, half for that of the ends).
fn rounding(coordinates: &[f64], step: f64, off: f64, gaps: &[f64]) -> Option<f64> {
    /// Of the place, for the rounding of decimal numbers.
    const SAME: f64 = 1e-6;
    let exponent: i32 = format!("{step:e}").split_once('e')?.1.parse().ok()?;
    (exponent.saturating_sub(2)..=exponent).rev().find_map(|exponent| {
        let place: f64 = format!("1e{exponent}").parse().ok()?;
        let is_multiple = |x: &f64| (x / place - (x / place).round()).abs() <= SAME;
        let most = place * (1.0 + SAME);
        let fits = off <= most && gaps[gaps.len() - 1] - gaps[0] <= most && coordinates.iter().all(is_multiple);
        fits.then_some(place)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(coordinates: &[f64]) -> Result<Spacing, TextError> {
        let lines: Vec<usize> = (11..11 + coordinates.len()).collect();
        Spacing::of(coordinates, &lines)
    }

    fn rounded(count: usize, step: f64, digits: i32) -> Vec<f64> {
        let scale = 10_f64.powi(digits);
        (0..count).map(|n| (n as f64 * step * scale).round() / scale).collect()
    }

    #[test]
    fn even_points_are_spaced_evenly_whatever_their_digits() {
        let even = |count: usize| (0..count).collect::<Vec<_>>();
        for (step, digits, rounded_to) in
            [(0.5, 1, None), (0.156_25, 1, Some(0.1)), (9.951e-5, 6, None), (1.75, 0, Some(1.0))]
        {
            for sign in [1.0, -1.0] {
                let coordinates: Vec<f64> = rounded(9600, step, digits).iter().map(|x| 3.0 + sign * x).collect();
                let found = of(&coordinates).unwrap();
                // The last coordinate is rounded: half a place over 9599 steps.
                let error = 0.5 * 10_f64.powi(-digits) / 9599.0;
                assert!((found.step - step).abs() <= error * 1.001, "{} for {step}", found.step);
                assert_eq!((found.count, &found.places, found.rounded_to), (9600, &even(9600), rounded_to));
            }
        }
        assert_eq!(of(&[4.0, 6.0]).unwrap(), Spacing { step: 2.0, count: 2, places: even(2), rounded_to: None });
    }

    #[test]
    fn points_that_are_not_there_leave_holes() {
        let mut coordinates: Vec<f64> = (0..40).map(f64::from).collect();
        coordinates.drain(17..19);
        coordinates.remove(30);
        let found = of(&coordinates).unwrap();
        assert_eq!((found.step, found.count), (1.0, 40));
        let places: Vec<usize> = coordinates.iter().map(|x| *x as usize).collect();
        assert_eq!(found.places, places);
    }

    #[test]
    fn every_point_may_be_off_its_place_also_the_first() {
        let coordinates: Vec<f64> =
            [-0.015, 0.015, 0.0, 0.015, -0.015].iter().zip(0..).map(|(off, at)| f64::from(at) + off).collect();
        assert_eq!((of(&coordinates).unwrap().step, of(&coordinates).unwrap().count), (1.0, 5));
    }

    #[test]
    fn uneven_points_are_refused_with_the_numbers() {
        assert_eq!(
            of(&[0.0, 1.0, 2.0, 3.31, 4.0]).unwrap_err(),
            TextError::Uneven { line: 14, found: 3.31, expected: 3.0, step: 1.0, gaps: [4.0 - 3.31, 3.31 - 2.0] }
        );
        // A third of the points is not there; integers with gaps of 1 and 3 are no rounded coordinates.
        for uneven in [&[0.0, 1.0, 3.0, 4.0, 7.0, 8.0][..], &[0.0, 1.0, 2.0, 4.0, 6.0, 8.0], &[0.0, 1.0, 1.5, 4.0]] {
            assert!(matches!(of(uneven), Err(TextError::Uneven { .. })), "{uneven:?}");
        }
        assert_eq!(of(&[0.0, 2.0, 1.0]).unwrap_err(), TextError::Disorder { line: 13, found: 1.0, before: 2.0 });
        assert_eq!(of(&[1.0, 1.0]).unwrap_err(), TextError::Disorder { line: 12, found: 1.0, before: 1.0 });
        assert_eq!(of(&[1.0]).unwrap_err(), TextError::ShortProfile { points: 1 });
    }
}
