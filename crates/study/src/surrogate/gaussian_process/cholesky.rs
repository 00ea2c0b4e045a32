//! Symmetric matrices and their Cholesky factors C = LLᵀ, for some hundred to thousand points.
//!
//! Everything is a dot product of two rows that lie one after the other in memory, taken four at a time, so that each number that
//! is read is used twice; and rows are divided into blocks that stay in the cache. Sums are in one order, whatever the
//! processor: forecasts decide which runs are made, and these are to be the same everywhere.

use nalgebra::{DMatrix, DVector};

/// Rows of a block: of a thousand columns, 256 kB.
const BLOCK: usize = 32;

/// A symmetric matrix: its lower triangle, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Symmetric {
    size: usize,
    values: Vec<f64>,
}

impl Symmetric {
    /// That of values at row and column, of the lower triangle.
    pub fn from_fn(size: usize, mut value: impl FnMut(usize, usize) -> f64) -> Self {
        let mut values = Vec::with_capacity(start(size));
        for row in 0..size {
            values.extend((0..=row).map(|column| value(row, column)));
        }
        Self { size, values }
    }

    /// A value of the lower triangle.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.values[start(row) + column]
    }

    /// L of this matrix; none where it is not positive definite in floating point.
    pub fn cholesky(self) -> Option<Cholesky> {
        let Self { size, mut values } = self;
        for first in (0..size).step_by(BLOCK) {
            let end = (first + BLOCK).min(size);
            let (above, block) = values.split_at_mut(start(first));
            let own = |row: usize| start(row) - start(first);
            // Columns whose rows are done: two of them with two rows of the block at a time.
            for column in (0..first).step_by(2) {
                let columns = [column, column + 1].map(|column| row_of(above, column));
                for row in (first..end).step_by(2) {
                    let pair = [row, (row + 1).min(end - 1)];
                    let sums =
                        dots(pair.map(|row| &block[own(row)..own(row) + column]), columns.map(|row| &row[..column]));
                    for (row, [one, other]) in pair.into_iter().zip(sums).take(end - row) {
                        let found = &mut block[own(row)..];
                        found[column] = (found[column] - one) / columns[0][column];
                        let left = found[column + 1] - other - found[column] * columns[1][column];
                        found[column + 1] = left / columns[1][column + 1];
                    }
                }
            }
            // What the block has of its own.
            for row in first..end {
                for column in first..=row {
                    let sum = dot(&block[own(row)..own(row) + column], &block[own(column)..own(column) + column]);
                    let left = block[own(row) + column] - sum;
                    block[own(row) + column] = if column < row {
                        left / block[own(column) + column]
                    } else if left > 0.0 {
                        left.sqrt()
                    } else {
                        return None;
                    };
                }
            }
        }
        Some(Cholesky { size, values })
    }
}

/// L of a symmetric matrix C = LLᵀ.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cholesky {
    size: usize,
    values: Vec<f64>,
}

impl Cholesky {
    /// Logarithm of the determinant of C.
    pub fn log_determinant(&self) -> f64 {
        2.0 * (0..self.size).map(|at| libm::log(self.row(at)[at])).sum::<f64>()
    }

    /// L⁻¹v.
    pub fn half_solve(&self, right: &DVector<f64>) -> DVector<f64> {
        let mut found = right.clone();
        for row in 0..self.size {
            let own = self.row(row);
            found[row] = (found[row] - dot(&own[..row], &found.as_slice()[..row])) / own[row];
        }
        found
    }

    /// C⁻¹v.
    pub fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        let mut found = self.half_solve(right);
        for row in (0..self.size).rev() {
            let own = self.row(row);
            found[row] /= own[row];
            let value = found[row];
            let above = &mut found.as_mut_slice()[..row];
            above.iter_mut().zip(own).for_each(|(above, factor)| *above -= factor * value);
        }
        found
    }

    /// C⁻¹ of all columns of a matrix.
    pub fn solve_columns(&self, right: &DMatrix<f64>) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = right.column_iter().map(|column| self.solve(&column.into_owned())).collect();
        DMatrix::from_columns(&columns)
    }

    /// C⁻¹.
    pub fn inverse(&self) -> Symmetric {
        let lower = self.lower_inverse();
        let column = |at: usize, from: usize| &lower[at * self.size + from..(at + 1) * self.size];
        let mut values = vec![0.0; start(self.size)];
        for first in (0..self.size).step_by(BLOCK) {
            let end = (first + BLOCK).min(self.size);
            for left in (0..end).step_by(2) {
                let others = [left, (left + 1).min(self.size - 1)];
                for row in (first.max(left)..end).step_by(2) {
                    let pair = [row, (row + 1).min(self.size - 1)];
                    let sums = dots(pair.map(|at| column(at, row)), others.map(|at| column(at, row)));
                    for (row, sums) in pair.into_iter().zip(sums).take(end - row) {
                        for (other, sum) in others.into_iter().zip(sums).filter(|(other, _)| *other <= row) {
                            values[start(row) + other] = sum;
                        }
                    }
                }
            }
        }
        Symmetric { size: self.size, values }
    }

    /// The diagonal of C⁻¹.
    pub fn inverse_diagonal(&self) -> Vec<f64> {
        let lower = self.lower_inverse();
        let columns = lower.chunks(self.size.max(1)).enumerate();
        columns.map(|(at, column)| dot(&column[at..], &column[at..])).collect()
    }

    /// L⁻¹, column by column, with its zeros.
    fn lower_inverse(&self) -> Vec<f64> {
        let size = self.size;
        let mut found = vec![0.0; size * size];
        for first in (0..size).step_by(BLOCK) {
            let end = (first + BLOCK).min(size);
            for row in (first..size).step_by(2) {
                let rows = [row, (row + 1).min(size - 1)].map(|row| self.row(row));
                for column in (first..end.min(row + 2)).step_by(2) {
                    let pair = [column, (column + 1).min(end - 1)];
                    let from = column.min(row);
                    let sums = dots(
                        pair.map(|column| &found[column * size + from..column * size + row]),
                        rows.map(|own| &own[from..row]),
                    );
                    for (column, [one, other]) in pair.into_iter().zip(sums).take(end - column) {
                        let own = &mut found[column * size..(column + 1) * size];
                        let unit = |row: usize| f64::from(u8::from(row == column));
                        own[row] = (unit(row) - one) / rows[0][row];
                        if row + 1 < size {
                            own[row + 1] = (unit(row + 1) - other - rows[1][row] * own[row]) / rows[1][row + 1];
                        }
                    }
                }
            }
        }
        found
    }

    fn row(&self, row: usize) -> &[f64] {
        row_of(&self.values, row)
    }
}

/// Where a row of a lower triangle begins.
fn start(row: usize) -> usize {
    row * (row + 1) / 2
}

fn row_of(values: &[f64], row: usize) -> &[f64] {
    &values[start(row)..start(row + 1)]
}

/// Two sums that are taken side by side: every other number of a row belongs to the same one.
type Sums = [f64; 2];

/// Sums with two products more. Written out, so that the compiler makes one operation of both.
fn add(sums: Sums, row: Sums, other: Sums) -> Sums {
    [sums[0] + row[0] * other[0], sums[1] + row[1] * other[1]]
}

/// The dot products of each of two rows with each of two others, all equally long.
fn dots(rows: [&[f64]; 2], others: [&[f64]; 2]) -> [[f64; 2]; 2] {
    let [(a, a_rest), (b, b_rest)] = rows.map(|row| row.as_chunks::<2>());
    let [(c, c_rest), (d, d_rest)] = others.map(|row| row.as_chunks::<2>());
    let [mut ac, mut ad, mut bc, mut bd] = [[0.0; 2]; 4];
    for (((a, b), c), d) in a.iter().zip(b).zip(c).zip(d) {
        ac = add(ac, *a, *c);
        ad = add(ad, *a, *d);
        bc = add(bc, *b, *c);
        bd = add(bd, *b, *d);
    }
    let with_rest = |[one, other]: Sums, rest: &[f64], rest_of_other: &[f64]| {
        one + other + rest.first().zip(rest_of_other.first()).map_or(0.0, |(one, other)| one * other)
    };
    [
        [with_rest(ac, a_rest, c_rest), with_rest(ad, a_rest, d_rest)],
        [with_rest(bc, b_rest, c_rest), with_rest(bd, b_rest, d_rest)],
    ]
}

/// The dot product of two rows, in the same order.
fn dot(row: &[f64], other: &[f64]) -> f64 {
    let ((own, rest), (others, rest_of_other)) = (row.as_chunks::<2>(), other.as_chunks::<2>());
    let [one, next] = own.iter().zip(others).fold([0.0; 2], |sums, (own, other)| add(sums, *own, *other));
    one + next + rest.first().zip(rest_of_other.first()).map_or(0.0, |(one, other)| one * other)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Correlations exp(−|i − j|/5), whose inverse has three diagonals, with something on the diagonal.
    fn matrix(size: usize) -> Symmetric {
        let value = |row: usize, column: usize| libm::exp(-0.2 * (row - column) as f64);
        Symmetric::from_fn(size, |row, column| value(row, column) + if row == column { 0.01 } else { 0.0 })
    }

    fn full(matrix: &Symmetric) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.size, matrix.size, |row, column| matrix.at(row.max(column), row.min(column)))
    }

    #[test]
    fn all_that_is_solved_is_what_nalgebra_solves() {
        // About the ends of blocks and of pairs.
        for size in [1, 2, 3, 5, 31, 32, 33, 34, 63, 64, 65, 97, 130] {
            let full = full(&matrix(size));
            let expected = nalgebra::Cholesky::new(full.clone()).unwrap();
            let found = matrix(size).cholesky().unwrap();
            let right = DVector::from_fn(size, |row, _| libm::sin(row as f64));
            let near = |one: f64, other: f64| (one - other).abs() < 1e-10 * (1.0 + other.abs());
            let lower = expected.l();
            assert!((0..size).all(|row| (0..=row).all(|column| near(found.row(row)[column], lower[(row, column)]))));
            let log = 2.0 * lower.diagonal().map(libm::log).sum();
            assert!(near(found.log_determinant(), log), "{size}");
            let half = lower.solve_lower_triangular(&right).unwrap();
            assert!(found.half_solve(&right).iter().zip(&half).all(|(one, other)| near(*one, *other)), "{size}");
            let solution = expected.solve(&right);
            assert!(found.solve(&right).iter().zip(&solution).all(|(one, other)| near(*one, *other)), "{size}");
            assert_eq!(
                found.solve_columns(&DMatrix::from_columns(std::slice::from_ref(&right))).column(0),
                found.solve(&right)
            );
            let (inverse, own) = (expected.inverse(), found.inverse());
            let is_same = |row: usize, column: usize| near(own.at(row, column), inverse[(row, column)]);
            assert!((0..size).all(|row| (0..=row).all(|column| is_same(row, column))), "{size}");
            let diagonal = found.inverse_diagonal();
            assert!((0..size).all(|at| near(diagonal[at], inverse[(at, at)])), "{size}");
        }
    }

    #[test]
    fn what_is_not_positive_definite_has_none() {
        assert_eq!(Symmetric::from_fn(40, |_, _| 1.0).cholesky(), None);
        assert_eq!(Symmetric::from_fn(2, |row, column| if row == column { 1.0 } else { 2.0 }).cholesky(), None);
        assert_eq!(Symmetric::from_fn(3, |_, _| f64::NAN).cholesky(), None);
    }
}
