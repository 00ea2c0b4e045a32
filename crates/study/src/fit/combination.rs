//! Which products of keys the data determine where they do not determine the keys.
//!
//! Near the most likely place, −2 ln of the likelihood rises as uᵀHu, where u are the changes of the keys' logarithms as
//! multiples of half their ranges. Along an eigenvector of a large eigenvalue the measurements say how far u may go, along
//! one of a small eigenvalue the range ends first: there is a ridge. Products of powers of keys that stay the same along all
//! ridges are determined.
//!
//! Where no range ends a ridge, H⁻¹ is the covariance of the logarithms. With each divided by its own deviation that is a matrix of
//! correlations, whose eigenvectors of small eigenvalues are products that are known better than the keys in them: the likely
//! values lie in a strip.

use nalgebra::{DMatrix, SymmetricEigen};

use super::Fit;

/// Exponents below this, beside one of 1, are taken for none.
const LEAST_EXPONENT: f64 = 0.05;

/// How many times as well as its leading key a product is known, at least, to be told beside the keys: of two keys, where their
/// correlation is 0.944 or more.
const BETTER: f64 = 3.0;

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
        let (slopes, halves) = self.slopes_by_logarithms()?;
        determined(&slopes, &halves, self.threshold(1))
    }

    /// What is known better than the keys where all are determined: products along a strip. Empty where there is none.
    pub(super) fn better_known(&self) -> Vec<Combination> {
        let strip = |(slopes, halves): (Vec<Vec<f64>>, Vec<f64>)| better_known(&slopes, &halves, self.threshold(1));
        self.slopes_by_logarithms().map(strip).unwrap_or_default()
    }

    /// Slopes of the responses by logarithms of the keys as multiples of half their ranges, a row for each response, and these
    /// halves.
    fn slopes_by_logarithms(&self) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let scales: Vec<f64> =
            self.keys.iter().zip(&self.best).map(|(key, coded)| key.coded_by_log(*coded)).collect::<Option<_>>()?;
        // The range of ln key is twice this long.
        let halves: Vec<f64> = self.keys.iter().map(|key| 0.5 * libm::log(key.high / key.low)).collect();
        let by_logarithm = |row: Vec<f64>| {
            row.iter().zip(scales.iter().zip(&halves)).map(|(slope, (scale, half))| slope * scale * half).collect()
        };
        Some((self.likelihood.weighted_slopes(&self.best).into_iter().map(by_logarithm).collect(), halves))
    }
}

/// Products that are determined, from slopes of the responses by u (a row for each response) and halves of the ranges of the
/// logarithms; see [`Fit::combinations`].
fn determined(slopes: &[Vec<f64>], halves: &[f64], threshold: f64) -> Option<Vec<Combination>> {
    let keys = halves.len();
    let axes = SymmetricEigen::new(curvature(slopes, keys));
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
    Some(rows.iter().map(|row| product(row, reach)).collect())
}

/// Products that are known [`BETTER`] than their leading key, from the same.
fn better_known(slopes: &[Vec<f64>], halves: &[f64], threshold: f64) -> Vec<Combination> {
    let keys = halves.len();
    let curvature = curvature(slopes, keys);
    if SymmetricEigen::new(curvature.clone()).eigenvalues.iter().any(|value| *value <= threshold) {
        return Vec::new();
    }
    let Some(inverse) = curvature.try_inverse() else { return Vec::new() };
    // Of ln key, in place of multiples of the halves.
    let covariance = DMatrix::from_fn(keys, keys, |row, column| inverse[(row, column)] * halves[row] * halves[column]);
    let deviations: Vec<f64> = (0..keys).map(|key| covariance[(key, key)].sqrt()).collect();
    let axes = SymmetricEigen::new(DMatrix::from_fn(keys, keys, |row, column| {
        covariance[(row, column)] / (deviations[row] * deviations[column])
    }));
    // The product in which the leading key, over its deviation, has the exponent 1.
    let is_better = |axis: &usize| {
        let leading = axes.eigenvectors.column(*axis).amax();
        axes.eigenvalues[*axis].max(0.0).sqrt() * BETTER <= leading
    };
    let row = |axis: usize| (0..keys).map(|key| axes.eigenvectors[(key, axis)] / deviations[key]).collect();
    let mut rows: Vec<Vec<f64>> = (0..keys).filter(is_better).map(row).collect();
    reduce(&mut rows);
    let reach = |powers: &[(usize, f64)]| {
        let pairs = powers.iter().flat_map(|one| powers.iter().map(move |other| (one, other)));
        let variance: f64 = pairs.map(|((one, p), (other, q))| p * q * covariance[(*one, *other)]).sum();
        (threshold * variance.max(0.0)).sqrt()
    };
    let products = rows.iter().map(|row| product(row, reach));
    products.filter(|product| product.powers.len() > 1).collect()
}

/// H.
fn curvature(slopes: &[Vec<f64>], keys: usize) -> DMatrix<f64> {
    DMatrix::from_fn(keys, keys, |row, column| slopes.iter().map(|slopes| slopes[row] * slopes[column]).sum::<f64>())
}

/// A row of exponents, and how far the logarithm of the product may be off.
fn product(row: &[f64], reach: impl Fn(&[(usize, f64)]) -> f64) -> Combination {
    let mut powers: Vec<(usize, f64)> =
        row.iter().copied().enumerate().filter(|(_, exponent)| exponent.abs() >= LEAST_EXPONENT).collect();
    // The one that was made 1 comes first.
    powers.sort_by_key(|(key, exponent)| (*exponent != 1.0, *key));
    let factor = libm::exp(reach(&powers));
    Combination { powers, factor }
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
    fn along_a_strip_the_product_is_known_better_than_the_keys() {
        // ln a + ln b and ln a − ln b are measured with deviations s and t; halves of the ranges 2 and 3. So the deviation of
        // either key is √(s² + t²)/2, and that of the product s.
        let rows = |s: f64, t: f64| [vec![2.0 / s, 3.0 / s], vec![2.0 / t, -3.0 / t]];
        let halves = [2.0, 3.0];
        assert_eq!(determined(&rows(0.02, 0.3), &halves, 3.84), None, "both keys are determined");
        let found = better_known(&rows(0.02, 0.3), &halves, 3.84);
        assert_eq!(found.len(), 1);
        let [(_, one), (_, other)] = found[0].powers[..] else { panic!("{found:?}") };
        assert!(one == 1.0 && (other - 1.0).abs() < 1e-9, "{found:?}");
        assert!((libm::log(found[0].factor) - 0.02 * 3.84_f64.sqrt()).abs() < 1e-9, "{found:?}");
        // Three times as well begins where 2s = √(s² + t²)/3: at t = 5.92 s.
        assert_eq!(better_known(&rows(0.02, 0.117), &halves, 3.84), Vec::new());
        assert_eq!(better_known(&rows(0.02, 0.120), &halves, 3.84).len(), 1);
        // One key far better known than another is no strip.
        assert_eq!(better_known(&[vec![500.0, 0.0], vec![0.0, 9.0]], &halves, 3.84), Vec::new());
    }

    #[test]
    fn where_everything_or_nothing_is_determined() {
        assert_eq!(determined(&[vec![9.0, 0.0], vec![0.0, 9.0]], &[1.0; 2], 3.84), None);
        assert_eq!(determined(&[vec![0.1, 0.2]], &[1.0; 2], 3.84), Some(Vec::new()));
    }
}
