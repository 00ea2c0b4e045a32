//! Which products of keys the data determine where they do not determine the keys.
//!
//! Near the most likely place, −2 ln of the likelihood rises as uᵀHu, where u are the changes of the keys' logarithms as
//! multiples of half their ranges. Along an eigenvector of a large eigenvalue the measurements say how far u may go, along
//! one of a small eigenvalue the range ends first: there is a ridge. Products of powers of keys that stay the same along all
//! ridges are determined.

use nalgebra::{DMatrix, SymmetricEigen};

use super::Fit;

/// Exponents below this, beside one of 1, are taken for none.
const LEAST_EXPONENT: f64 = 0.05;

/// A product of powers of keys, Π keyᵉ.
#[derive(Debug, Clone, PartialEq)]
pub struct Combination {
    /// Keys by index, each with its exponent; the first exponent is 1.
    pub powers: Vec<(usize, f64)>,
    /// By which factor the product may be larger or smaller than at the most likely place, at the level of intervals.
    pub factor: f64,
}

impl Fit {
    /// What is determined where there is a ridge: products of keys, of which single keys are some. Nothing where all keys are
    /// determined, or a key's range has values without a logarithm; an empty list where nothing is determined.
    pub(super) fn combinations(&self) -> Option<Vec<Combination>> {
        let scales: Vec<f64> =
            self.keys.iter().zip(&self.best).map(|(key, coded)| key.coded_by_log(*coded)).collect::<Option<_>>()?;
        // The range of ln key is twice this long.
        let halves: Vec<f64> = self.keys.iter().map(|key| 0.5 * libm::log(key.high / key.low)).collect();
        let slopes: Vec<Vec<f64>> = self
            .likelihood
            .weighted_slopes(&self.best)
            .into_iter()
            .map(|row| {
                row.iter().zip(scales.iter().zip(&halves)).map(|(slope, (scale, half))| slope * scale * half).collect()
            })
            .collect();
        determined(&slopes, &halves, self.threshold(1))
    }
}

/// Products that are determined, from slopes of the responses by u (a row for each response) and halves of the ranges of the
/// logarithms; see [`Fit::combinations`].
fn determined(slopes: &[Vec<f64>], halves: &[f64], threshold: f64) -> Option<Vec<Combination>> {
    let keys = halves.len();
    let curvature = DMatrix::from_fn(keys, keys, |row, column| {
        slopes.iter().map(|slopes| slopes[row] * slopes[column]).sum::<f64>()
    });
    let axes = SymmetricEigen::new(curvature);
    // Along an eigenvector of length 1, uᵀHu reaches the threshold before the range ends.
    let known: Vec<usize> = (0..keys).filter(|axis| axes.eigenvalues[*axis] > threshold).collect();
    if known.len() == keys {
        return None;
    }
    let mut rows: Vec<Vec<f64>> =
        known.iter().map(|axis| (0..keys).map(|key| axes.eigenvectors[(key, *axis)] / halves[key]).collect()).collect();
    reduce(&mut rows);
    // With u along these eigenvectors alone, −2 ln L rises by the threshold where gᵀu changes by √(threshold · gᵀH⁺g).
    let reach = |powers: &[(usize, f64)]| {
        let along = |axis: &usize| {
            let change: f64 =
                powers.iter().map(|(key, power)| power * halves[*key] * axes.eigenvectors[(*key, *axis)]).sum();
            change * change / axes.eigenvalues[*axis]
        };
        (threshold * known.iter().map(along).sum::<f64>()).sqrt()
    };
    let combination = |row: &Vec<f64>| {
        let mut powers: Vec<(usize, f64)> =
            row.iter().copied().enumerate().filter(|(_, exponent)| exponent.abs() >= LEAST_EXPONENT).collect();
        // The one that was made 1 comes first.
        powers.sort_by_key(|(key, exponent)| (*exponent != 1.0, *key));
        let factor = libm::exp(reach(&powers));
        Combination { powers, factor }
    };
    Some(rows.iter().map(combination).collect())
}

/// Gauss–Jordan: each row has a 1 where all other rows have nothing, at its largest exponent.
fn reduce(rows: &mut [Vec<f64>]) {
    for at in 0..rows.len() {
        let largest = (0..rows[at].len()).max_by(|one, other| rows[at][*one].abs().total_cmp(&rows[at][*other].abs()));
        let Some(pivot) = largest.filter(|pivot| rows[at][*pivot] != 0.0) else { continue };
        let by = rows[at][pivot];
        rows[at].iter_mut().for_each(|value| *value /= by);
        rows[at][pivot] = 1.0;
        let own = rows[at].clone();
        for (other, row) in rows.iter_mut().enumerate().filter(|(other, _)| *other != at) {
            let _ = other;
            let times = row[pivot];
            row.iter_mut().zip(&own).for_each(|(value, own)| *value -= times * own);
            row[pivot] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_is_found_where_the_response_is_a_function_of_it() {
        // ln y = ln a + 0.5 ln b does not see c; halves of the ranges 1, 2, 3.
        let rows = [vec![50.0, 50.0, 0.0]];
        let found = determined(&rows, &[1.0, 2.0, 3.0], 3.84).unwrap();
        assert_eq!(found.len(), 1);
        let [(0, one), (1, half)] = found[0].powers[..] else { panic!("{found:?}") };
        assert!(one == 1.0 && (half - 0.5).abs() < 1e-12);
        // −2 ln L is (50·(u₁ + u₂))², and the logarithm of the product u₁ + u₂.
        assert!((libm::log(found[0].factor) - 3.84_f64.sqrt() / 50.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn two_responses_leave_one_ridge_of_three_keys() {
        // a·b and b·c, both exactly: what is left of the row space is a/c and b·c, or the like; each must not change along the
        // ridge (1, −1, 1).
        let rows = [vec![90.0, 90.0, 0.0], vec![0.0, 70.0, 70.0]];
        let found = determined(&rows, &[1.0; 3], 3.84).unwrap();
        assert_eq!(found.len(), 2);
        for combination in &found {
            let along: f64 = combination.powers.iter().map(|(key, power)| power * [1.0, -1.0, 1.0][*key]).sum();
            assert!(along.abs() < 1e-12 && combination.powers.len() == 2, "{found:?}");
        }
    }

    #[test]
    fn where_everything_or_nothing_is_determined() {
        assert_eq!(determined(&[vec![9.0, 0.0], vec![0.0, 9.0]], &[1.0; 2], 3.84), None);
        assert_eq!(determined(&[vec![0.1, 0.2]], &[1.0; 2], 3.84), Some(Vec::new()));
    }
}
