//! The response as a quadratic surface over the numeric factors, and where it is level.
//!
//! Box, G. E. P. & Wilson, K. B. (1951): On the experimental attainment of optimum conditions. J. R. Stat. Soc. B 13,
//! 1–45, doi:10.1111/j.2517-6161.1951.tb00067.x. With y = c + bᵀ·x + xᵀ·B·x the surface is level at x = −½·B⁻¹·b; the
//! eigenvalues of B are its curvatures along the eigenvectors, halved.

use nalgebra::{DMatrix, DVector};

use super::error::EffectsError;
use super::model::Model;
use super::result::{Effects, Prediction};
use crate::design::Setting;

/// A curvature that is this small beside the largest is none.
const FLAT: f64 = 1e-10;

/// A quadratic response surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The numeric factors, by index.
    pub factors: Vec<usize>,
    /// The response as a function of coded values.
    pub coded: Polynomial,
    /// The response as a function of the factors' own values.
    pub natural: Polynomial,
    /// Eigenvalues of the symmetric matrix of the coded polynomial, in ascending order.
    pub eigenvalues: Vec<f64>,
    /// Unit vectors along which the eigenvalues hold, in coded units.
    pub axes: Vec<Vec<f64>>,
    /// What kind of surface it is.
    pub nature: Nature,
    /// Where it is level; none for ridges.
    pub stationary: Option<Stationary>,
}

/// A polynomial of second degree: constant + linear·x + xᵀ·quadratic·x.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomial {
    /// Value at the origin.
    pub constant: f64,
    /// Coefficient of each variable.
    pub linear: Vec<f64>,
    /// Symmetric matrix: coefficients of squares, and half of those of products.
    pub quadratic: Vec<Vec<f64>>,
}

/// Where the response is level.
#[derive(Debug, Clone, PartialEq)]
pub struct Stationary {
    /// The point, in coded units.
    pub coded: Vec<f64>,
    /// The point, in the factors' own units.
    pub natural: Vec<f64>,
    /// The response there.
    pub response: Prediction,
    /// Whether all factors are within their ranges there.
    pub within_ranges: bool,
}

/// What kind of quadratic surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nature {
    /// Falls in all directions from the stationary point.
    Maximum,
    /// Rises in all directions.
    Minimum,
    /// Rises in some, falls in others.
    Saddle,
    /// Straight in some direction, so that it is level nowhere or along a line.
    Ridge,
}

impl Polynomial {
    /// The value at a point.
    pub fn value(&self, point: &[f64]) -> f64 {
        let linear: f64 = self.linear.iter().zip(point).map(|(coefficient, x)| coefficient * x).sum();
        let form = |row: &Vec<f64>| row.iter().zip(point).map(|(coefficient, x)| coefficient * x).sum::<f64>();
        self.constant + linear + self.quadratic.iter().zip(point).map(|(row, x)| x * form(row)).sum::<f64>()
    }

    /// The polynomial of values that lie as far from their middle, in halves of their range, as this one's from zero.
    fn with_ranges(&self, ranges: &[[f64; 2]]) -> Self {
        let half = |index: usize| 0.5 * (ranges[index][1] - ranges[index][0]);
        let origin: Vec<f64> = ranges.iter().map(|[low, high]| -(low + high) / (high - low)).collect();
        let slope = |index: usize| {
            let row: f64 = self.quadratic[index].iter().zip(&origin).map(|(coefficient, x)| coefficient * x).sum();
            (self.linear[index] + 2.0 * row) / half(index)
        };
        let scaled = |(index, row): (usize, &Vec<f64>)| {
            row.iter().enumerate().map(|(other, coefficient)| coefficient / (half(index) * half(other))).collect()
        };
        Self {
            constant: self.value(&origin),
            linear: (0..ranges.len()).map(slope).collect(),
            quadratic: self.quadratic.iter().enumerate().map(scaled).collect(),
        }
    }
}

impl Effects {
    /// The surface at the categories of `settings`, whose numbers do not matter.
    ///
    /// # Errors
    /// If the model is not quadratic or no factor is numeric, or the settings do not fit the factors.
    pub fn surface(&self, settings: &[Setting]) -> Result<Surface, EffectsError> {
        let inner = &self.inner;
        let factors: Vec<usize> = (0..inner.factors.len()).filter(|index| inner.factors[*index].is_numeric()).collect();
        if self.model != Model::Quadratic || factors.is_empty() {
            return Err(EffectsError::NoSurface);
        }
        let coded = self.polynomial(&factors, settings)?;
        let ranges: Vec<[f64; 2]> = factors.iter().filter_map(|factor| inner.factors[*factor].range()).collect();
        let count = factors.len();
        let matrix = DMatrix::from_fn(count, count, |row, column| coded.quadratic[row][column]);
        let eigen = matrix.symmetric_eigen();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let eigenvalues: Vec<f64> = order.iter().map(|index| eigen.eigenvalues[*index]).collect();
        let vectors: Vec<DVector<f64>> =
            order.iter().map(|index| eigen.eigenvectors.column(*index).into_owned()).collect();
        let nature = Nature::of(&eigenvalues);
        let stationary = (nature != Nature::Ridge).then(|| {
            let linear = DVector::from_column_slice(&coded.linear);
            let mut point = DVector::zeros(count);
            for (vector, eigenvalue) in vectors.iter().zip(&eigenvalues) {
                point.axpy(-0.5 * vector.dot(&linear) / eigenvalue, vector, 1.0);
            }
            self.stationary(settings, &factors, &ranges, point.as_slice())
        });
        let natural = coded.with_ranges(&ranges);
        let axes = vectors.iter().map(|vector| vector.as_slice().to_vec()).collect();
        Ok(Surface { factors, natural, coded, eigenvalues, axes, nature, stationary: stationary.transpose()? })
    }

    fn stationary(
        &self,
        settings: &[Setting],
        factors: &[usize],
        ranges: &[[f64; 2]],
        point: &[f64],
    ) -> Result<Stationary, EffectsError> {
        let mut settings = settings.to_vec();
        factors.iter().zip(point).for_each(|(factor, coded)| settings[*factor] = Setting::Coded(*coded));
        let natural = |([low, high], coded): (&[f64; 2], &f64)| 0.5 * ((1.0 - coded) * low + (1.0 + coded) * high);
        Ok(Stationary {
            natural: ranges.iter().zip(point).map(natural).collect(),
            response: self.predict(&settings)?,
            within_ranges: point.iter().all(|coded| coded.abs() <= 1.0),
            coded: point.to_vec(),
        })
    }

    /// The polynomial in coded units at the categories of `settings`.
    fn polynomial(&self, factors: &[usize], settings: &[Setting]) -> Result<Polynomial, EffectsError> {
        let inner = &self.inner;
        let row = inner.regressors.row_of_categories(settings)?;
        let widths = inner.regressors.widths();
        let before = widths.len() - inner.regressors.terms.len();
        let count = factors.len();
        let mut polynomial = Polynomial {
            constant: inner.offset + inner.fit.coefficient(0),
            linear: vec![0.0; count],
            quadratic: vec![vec![0.0; count]; count],
        };
        let mut column: usize = widths[..before].iter().sum();
        for (parts, width) in inner.regressors.terms.iter().zip(&widths[before..]) {
            let columns = column..column + width;
            column += width;
            let value: f64 = columns.map(|column| inner.fit.coefficient(column) * row[column]).sum();
            let variables = parts.iter().filter_map(|factor| factors.binary_search(factor).ok());
            match variables.collect::<Vec<_>>().as_slice() {
                [] => polynomial.constant += value,
                [one] => polynomial.linear[*one] += value,
                [one, other, ..] => {
                    polynomial.quadratic[*one][*other] += 0.5 * value;
                    polynomial.quadratic[*other][*one] += 0.5 * value;
                }
            }
        }
        Ok(polynomial)
    }
}

impl Nature {
    /// Of the surface with these eigenvalues, in ascending order.
    fn of(eigenvalues: &[f64]) -> Self {
        let largest = eigenvalues.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        if eigenvalues.iter().any(|value| value.abs() <= FLAT * largest) {
            return Nature::Ridge;
        }
        match (eigenvalues.iter().any(|value| *value < 0.0), eigenvalues.iter().any(|value| *value > 0.0)) {
            (true, false) => Nature::Maximum,
            (false, true) => Nature::Minimum,
            _ => Nature::Saddle,
        }
    }
}
