//! Least squares with columns that may depend on each other.
//!
//! Columns are taken in turn; one that is a linear combination of those before it is left out, and what it is a
//! combination of is remembered. So of terms that cannot be told from each other the first keeps the estimate.

use nalgebra::{DMatrix, DVector};

/// A column depends on others if no more of it than this is left over, relative to its length.
const DEPENDENT: f64 = 1e-8;
/// A column takes part in a combination if it contributes more than this, relative to the length of the result.
const CONTRIBUTES: f64 = 1e-6;

/// A fit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fit {
    /// Columns that have a coefficient.
    pub kept: Vec<usize>,
    /// Columns that are combinations, and the kept columns they consist of.
    pub dependent: Vec<(usize, Vec<usize>)>,
    /// How many of each kept column there are in the columns that are combinations, in the order of `dependent`.
    pub relations: Vec<DVector<f64>>,
    /// Coefficients of the kept columns.
    pub coefficients: DVector<f64>,
    /// Inverse of the triangle that the kept columns were brought to: times its transpose it is the covariance of the
    /// coefficients in units of the error's variance.
    pub root: DMatrix<f64>,
    /// What the fit leaves.
    pub residuals: DVector<f64>,
    /// How much each observation determines its own fitted value, 0..1.
    pub leverages: Vec<f64>,
}

impl Fit {
    /// Fits the responses.
    pub fn new(matrix: &DMatrix<f64>, responses: &DVector<f64>) -> Self {
        let whole = matrix.clone().qr();
        let triangle = whole.r();
        let mut turned = responses.clone();
        whole.q_tr_mul(&mut turned);
        let kept = independent(&triangle);
        if kept.is_empty() {
            return Self::nothing(matrix, responses);
        }
        let small = triangle.select_columns(&kept).qr();
        let mut heads = turned.rows(0, triangle.nrows()).into_owned();
        small.q_tr_mul(&mut heads);
        let identity = DMatrix::identity(kept.len(), kept.len());
        let upper = small.r();
        // The diagonal has no zero, for the columns are independent.
        let root = upper.solve_upper_triangular(&identity).unwrap_or(identity);
        let coefficients = &root * heads.rows(0, kept.len());
        let columns = matrix.select_columns(&kept);
        let residuals = responses - &columns * &coefficients;
        let leverages = (&columns * &root).row_iter().map(|row| row.norm_squared().min(1.0)).collect();
        let combination = |column: usize| {
            let mut target = triangle.columns(column, 1).into_owned();
            small.q_tr_mul(&mut target);
            let weights = &root * target.rows(0, kept.len());
            let threshold = CONTRIBUTES * triangle.column(column).norm();
            let contributes =
                |position: &usize| weights[*position].abs() * triangle.column(kept[*position]).norm() > threshold;
            let parts: Vec<usize> = (0..kept.len()).filter(contributes).map(|position| kept[position]).collect();
            ((column, parts), weights.column(0).into_owned())
        };
        let dependent = (0..matrix.ncols()).filter(|column| kept.binary_search(column).is_err());
        let (dependent, relations) = dependent.map(combination).unzip();
        Self { kept, dependent, relations, coefficients, root, residuals, leverages }
    }

    /// The fit to a matrix without any length.
    fn nothing(matrix: &DMatrix<f64>, responses: &DVector<f64>) -> Self {
        Self {
            kept: vec![],
            dependent: (0..matrix.ncols()).map(|column| (column, vec![])).collect(),
            relations: vec![DVector::zeros(0); matrix.ncols()],
            coefficients: DVector::zeros(0),
            root: DMatrix::zeros(0, 0),
            residuals: responses.clone(),
            leverages: vec![0.0; responses.len()],
        }
    }

    /// How much the residual sum of squares would grow without some of the kept columns, given by position.
    pub fn sum_of_squares(&self, positions: &[usize]) -> f64 {
        // With the covariance C = W·Wᵀ of these coefficients b, it is bᵀ·C⁻¹·b; Wᵀ = Q·S gives C = Sᵀ·S.
        let triangle = self.root.select_rows(positions).transpose().qr().r();
        let coefficients = DVector::from_iterator(positions.len(), positions.iter().map(|p| self.coefficients[*p]));
        triangle.tr_solve_upper_triangular(&coefficients).map_or(0.0, |solution| solution.norm_squared())
    }

    /// Variance of a kept coefficient, given by position, in units of the error's variance.
    pub fn variance(&self, position: usize) -> f64 {
        self.root.row(position).norm_squared()
    }

    /// The fitted value for a row of the model matrix, and its variance in units of the error's variance.
    pub fn predict(&self, row: &[f64]) -> (f64, f64) {
        let row = DVector::from_iterator(self.kept.len(), self.kept.iter().map(|column| row[*column]));
        (row.dot(&self.coefficients), self.root.tr_mul(&row).norm_squared())
    }

    /// Whether the observations tell the fitted value for a row of the model matrix: whether the columns that are combinations
    /// are the same ones there. What is a multiple of the mean, as the square of a number with two values is, does not count.
    pub fn tells(&self, row: &[f64]) -> bool {
        let own = DVector::from_iterator(self.kept.len(), self.kept.iter().map(|column| row[*column]));
        let is_same = |((column, parts), weights): (&(usize, Vec<usize>), &DVector<f64>)| {
            let size = row.iter().fold(1.0_f64, |size, value| size.max(value.abs()));
            parts.iter().all(|part| *part == 0) || (row[*column] - own.dot(weights)).abs() <= CONTRIBUTES * size
        };
        self.dependent.iter().zip(&self.relations).all(is_same)
    }

    /// The coefficient of a column; zero if it has none of its own.
    pub fn coefficient(&self, column: usize) -> f64 {
        self.kept.binary_search(&column).map_or(0.0, |position| self.coefficients[position])
    }
}

/// Columns that do not depend on those before them.
fn independent(matrix: &DMatrix<f64>) -> Vec<usize> {
    let (mut kept, mut basis): (Vec<usize>, Vec<DVector<f64>>) = (vec![], vec![]);
    for (index, column) in matrix.column_iter().enumerate() {
        let (mut rest, length) = (column.into_owned(), column.norm());
        // Twice, so that rounding leaves nothing along the basis.
        for _ in 0..2 {
            for direction in &basis {
                let along = direction.dot(&rest);
                rest.axpy(-along, direction, 1.0);
            }
        }
        let left = rest.norm();
        if basis.len() < matrix.nrows() && left > DEPENDENT * length {
            kept.push(index);
            basis.push(rest / left);
        }
    }
    kept
}
