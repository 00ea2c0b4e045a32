//! From the points of the file, one after the other, to a patch.

use plateau_core::surface::Patch;

use super::error::X3pError;
use super::matrix::{Axis, Matrix, Number};
use crate::surface::profiles::Profiles;

/// How far a coordinate may be from a regular grid, in pitches. float32 coordinates of up to 16 000 columns are rounded
/// by less than that.
const TOLERANCE: f64 = 1e-3;

/// Takes the points of a matrix, x growing fastest.
pub(super) struct Points {
    matrix: Matrix,
    /// One bit a point, the least significant first; without it every point is valid unless it is NaN.
    valid: Option<Vec<u8>>,
    heights: Profiles,
    x: Track,
    y: Track,
    /// Points of which a coordinate was stored as +inf.
    infinite: usize,
}

impl Points {
    /// Room for a matrix that has been compared with the size of the file.
    pub(super) fn new(matrix: Matrix, valid: Option<Vec<u8>>) -> Self {
        let heights = Profiles::new(matrix.columns, matrix.rows);
        let (x, y) = (Track::new(&matrix.x, matrix.columns), Track::new(&matrix.y, matrix.rows));
        Self { matrix, valid, heights, x, y, infinite: 0 }
    }

    /// Takes a point of a text: its coordinates along the absolute axes.
    ///
    /// # Errors
    /// [`X3pError::Point`] when one of them is of another type or infinite.
    pub(super) fn push(&mut self, coordinates: &[f64]) -> Result<(), X3pError> {
        let mut numbers = coordinates.iter().copied();
        self.take(|stored| {
            let number = numbers.next().unwrap_or(f64::NAN);
            if stored.holds(number) { Ok(number) } else { Err((number, stored.name())) }
        })
    }

    /// Takes a point of a binary file.
    ///
    /// # Errors
    /// [`X3pError::Point`] when a coordinate is infinite.
    #[inline]
    pub(super) fn push_raw(&mut self, mut bytes: &[u8]) -> Result<(), X3pError> {
        self.take(|stored| {
            let number;
            (number, bytes) = stored.split(bytes);
            Ok(number)
        })
    }

    #[inline]
    fn take(&mut self, mut next: impl FnMut(Number) -> Result<f64, (f64, &'static str)>) -> Result<(), X3pError> {
        let index = self.heights.len();
        let valid =
            self.valid.as_ref().is_none_or(|bits| bits.get(index / 8).is_some_and(|b| b >> (index % 8) & 1 == 1));
        let Matrix { columns, x, y, z, .. } = self.matrix;
        let mut is_infinite = false;
        let mut coordinate = |axis: Axis| {
            let Some(stored) = axis.stored else { return Ok(f64::NAN) };
            let at =
                |found, expected| X3pError::Point { column: index % columns, row: index / columns, found, expected };
            let number = next(stored).map_err(|(found, expected)| at(found, expected))?;
            // The mark of Alicona's instruments.
            if number == f64::INFINITY {
                is_infinite = true;
                return Ok(f64::NAN);
            }
            let coordinate = axis.coordinate(number);
            let expected = "a finite number of m, or NaN or +inf for a missing point";
            if coordinate.is_infinite() { Err(at(coordinate, expected)) } else { Ok(coordinate) }
        };
        let (x, y, z) = (coordinate(x)?, coordinate(y)?, coordinate(z)?);
        self.infinite += usize::from(valid && is_infinite);
        // Invalid points may hold anything.
        if valid {
            self.x.add(index % columns, x);
            self.y.add(index / columns, y);
        }
        self.heights.push(if valid && !is_infinite { z } else { f64::NAN });
        Ok(())
    }

    /// What is to be known of the heights, once all points are taken.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let Axis { increment, .. } = self.matrix.z;
        if increment != 1.0 {
            notes.push(format!("heights are the stored numbers times the increment of the z axis, {increment:e} m"));
        }
        if self.infinite > 0 {
            notes.push(format!("{} missing points are stored as +inf", self.infinite));
        }
        notes
    }

    /// The heights with their pitch.
    ///
    /// # Errors
    /// [`X3pError::NotEquidistant`] when coordinates are no regular grid.
    pub(super) fn finish(self) -> Result<Patch, X3pError> {
        let Matrix { columns, rows, x, y, .. } = self.matrix;
        let column_pitch = if x.stored.is_some() { self.x.pitch("x", &x)? } else { x.increment };
        let row_pitch = if y.stored.is_some() { self.y.pitch("y", &y)? } else { y.increment };
        Ok(Patch { columns, rows, column_pitch, row_pitch, heights: self.heights.finish() })
    }
}

/// Smallest and largest coordinate at each place along an absolute axis; nothing along one that counts.
struct Track(Vec<[f64; 2]>);

impl Track {
    fn new(axis: &Axis, places: usize) -> Self {
        Self(vec![[f64::INFINITY, f64::NEG_INFINITY]; if axis.stored.is_some() { places } else { 0 }])
    }

    #[inline]
    fn add(&mut self, place: usize, coordinate: f64) {
        if let Some([low, high]) = self.0.get_mut(place) {
            // Not NaN, wherever one of the two is.
            *low = low.min(coordinate);
            *high = high.max(coordinate);
        }
    }

    /// The distance of neighbouring places, if they are equidistant and the same in every profile.
    fn pitch(&self, name: &'static str, axis: &Axis) -> Result<f64, X3pError> {
        let known: Vec<(usize, [f64; 2])> =
            self.0.iter().copied().enumerate().filter(|(_, [low, high])| low <= high).collect();
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let refuse = |index, found, expected| Err(X3pError::NotEquidistant { axis: name, index, found, expected });
        let (Some((first, start)), Some((last, end))) = (known.first(), known.last()) else {
            return refuse(0, f64::NAN, 0.0);
        };
        let pitch = (middle(*end) - middle(*start)) / (last - first) as f64;
        if !(pitch > 0.0 && pitch.is_finite()) {
            return refuse(*last, middle(*end), middle(*start));
        }
        let rounding = match axis.stored {
            Some(Number::Int16 | Number::Int32) => 0.5 * axis.increment,
            _ => 0.0,
        };
        for (index, range) in &known {
            let expected = middle(*start) + (index - first) as f64 * pitch;
            for found in range {
                if (found - expected).abs() > TOLERANCE * pitch + rounding {
                    return refuse(*index, *found, expected);
                }
            }
        }
        Ok(pitch)
    }
}
