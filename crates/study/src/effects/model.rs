//! Models: which terms the response is taken to consist of.

use super::error::EffectsError;

/// Most coefficients of a model: beyond that no one runs a study, and the fit would take minutes.
const MOST_COLUMNS: usize = 2000;

/// What the response is taken to depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Model {
    /// Each factor on its own.
    MainEffects,
    /// Factors and pairs of factors.
    #[default]
    Interactions,
    /// Interactions of all orders, up to the first at which there are as many coefficients as points.
    Full,
    /// Numeric factors, their products and squares; categories and their products with the numbers.
    Quadratic,
}

/// Factors of a term, by index, in ascending order; a square names its factor twice.
pub(super) type Parts = Vec<usize>;

impl Model {
    /// The terms of a model but the mean, lower orders first and squares last.
    ///
    /// `widths` are the coefficients that each factor's own term has, `numeric` tells whose squares there are, and
    /// `points` is the number of distinct points that were observed.
    pub(super) fn terms(self, widths: &[usize], numeric: &[bool], points: usize) -> Result<Vec<Parts>, EffectsError> {
        let order = match self {
            Model::MainEffects => 1,
            Model::Interactions | Model::Quadratic => 2,
            Model::Full => full_order(widths, points),
        };
        let order = order.min(widths.len());
        let squares = (0..widths.len()).filter(|factor| self == Model::Quadratic && numeric[*factor]);
        let squares: Vec<Parts> = squares.map(|factor| vec![factor, factor]).collect();
        let columns: usize = columns_by_order(widths)[..=order].iter().fold(squares.len(), |a, b| a.saturating_add(*b));
        if columns > MOST_COLUMNS {
            return Err(EffectsError::TooManyTerms { columns, most: MOST_COLUMNS });
        }
        let mut terms: Vec<Parts> = Vec::new();
        let mut last: Vec<Parts> = vec![vec![]];
        for _ in 0..order {
            let longer = |parts: &Parts| {
                let first = parts.last().map_or(0, |last| last + 1);
                let parts = parts.clone();
                (first..widths.len()).map(move |factor| [parts.as_slice(), &[factor]].concat())
            };
            last = last.iter().flat_map(longer).collect();
            terms.extend(last.iter().cloned());
        }
        terms.extend(squares);
        Ok(terms)
    }
}

/// The order of interactions at which a full model has as many coefficients as there are points, or the last one before
/// there are too many.
fn full_order(widths: &[usize], points: usize) -> usize {
    let mut columns = 0_usize;
    for (order, more) in columns_by_order(widths).into_iter().enumerate() {
        let with_more = columns.saturating_add(more);
        if order > 1 && (columns >= points || with_more > MOST_COLUMNS) {
            return order - 1;
        }
        columns = with_more;
    }
    widths.len()
}

/// Numbers of coefficients of all terms of each order, from 0: the elementary symmetric polynomials of the widths.
fn columns_by_order(widths: &[usize]) -> Vec<usize> {
    let mut columns = vec![0_usize; widths.len() + 1];
    columns[0] = 1;
    for width in widths {
        for order in (1..columns.len()).rev() {
            columns[order] = columns[order].saturating_add(width.saturating_mul(columns[order - 1]));
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_are_the_subsets_of_factors_in_order() {
        let terms = |model: Model, points| model.terms(&[1, 1, 1], &[true, false, true], points).unwrap();
        let main = [vec![0], vec![1], vec![2]];
        let pairs = [vec![0, 1], vec![0, 2], vec![1, 2]];
        assert_eq!(terms(Model::MainEffects, 8), main);
        assert_eq!(terms(Model::Interactions, 8), [main.clone(), pairs.clone()].concat());
        assert_eq!(terms(Model::Full, 8), [&main[..], &pairs, &[vec![0, 1, 2]]].concat());
        assert_eq!(terms(Model::Quadratic, 8), [&main[..], &pairs, &[vec![0, 0], vec![2, 2]]].concat());
    }

    #[test]
    fn a_full_model_has_no_more_orders_than_points_support() {
        // Half of the 2⁵ combinations have 16 points: 1 + 5 + 10 coefficients. A quarter has 8: those of second order
        // are aliased, which is to be told.
        assert_eq!(full_order(&[1; 5], 16), 2);
        assert_eq!(full_order(&[1; 5], 8), 2);
        assert_eq!(full_order(&[1; 7], 8), 1);
        assert_eq!(full_order(&[1; 5], 32), 5);
        // Three levels each: 1 + 6 + 12 + 8 = 27.
        assert_eq!(full_order(&[2; 3], 27), 3);
        assert_eq!(full_order(&[1; 60], 100_000), 2);
    }

    #[test]
    fn models_too_large_to_fit_are_refused() {
        let refused = Model::Interactions.terms(&[9; 12], &[false; 12], 10_000);
        // 1 + 12 · 9 + 66 · 81
        assert_eq!(refused, Err(EffectsError::TooManyTerms { columns: 5455, most: 2000 }));
    }
}
