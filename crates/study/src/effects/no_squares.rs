//! Whether the runs of a study allow a model with squares, and why not.

use std::fmt;

use nalgebra::DVector;

use super::factor::Factor;
use super::fit::Fit;
use super::model::Model;
use super::observation::{Observation, Usable};
use super::regressors::Regressors;

/// Degrees of freedom that a model should leave for the error: with fewer, intervals are so wide that hardly anything
/// is significant (the 95 % quantiles of t are 12.7, 4.3 and 3.2 for one, two and three).
const LEAST_FREEDOM: usize = 3;

/// Why a quadratic model is not fitted of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoSquares {
    /// A curve needs three values of a number, and no factor has them.
    TwoValues,
    /// There are fewer points than coefficients.
    FewPoints {
        /// Different points whose runs have a response.
        points: usize,
        /// Coefficients of the quadratic model.
        coefficients: usize,
    },
    /// The runs leave less than three degrees of freedom for the error.
    FewRuns {
        /// Runs that have a response.
        runs: usize,
        /// Coefficients of the quadratic model, with those of blocks.
        coefficients: usize,
    },
    /// The runs cannot tell these terms from others.
    Aliased(Vec<String>),
}

impl fmt::Display for NoSquares {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TwoValues => f.write_str("no factor that is a number has more than two values"),
            Self::FewPoints { points, coefficients } => {
                write!(f, "{points} different points are too few for {coefficients} coefficients")
            }
            Self::FewRuns { runs, coefficients } => {
                write!(f, "{runs} runs are too few for {coefficients} coefficients and an error")
            }
            Self::Aliased(terms) => write!(f, "the runs cannot tell {} from other terms", terms.join(", ")),
        }
    }
}

/// Why these observations do not allow a quadratic model; none if they do, and where nothing can be analysed at all, which
/// [`analyse`](super::analyse) says.
///
/// Squares of numbers that have two values do not count: they are part of the mean.
pub fn no_squares(factors: &[Factor], observations: &[Observation], blocks: bool) -> Option<NoSquares> {
    factors.iter().try_for_each(Factor::check).ok()?;
    no_squares_of(factors, &Usable::new(factors, observations).ok()?, blocks)
}

/// The same of what can be analysed.
pub(super) fn no_squares_of(factors: &[Factor], usable: &Usable, blocks: bool) -> Option<NoSquares> {
    let regressors = Regressors::new(factors, usable, Model::Quadratic, blocks).ok()?;
    let curved: Vec<bool> = (0..factors.len()).map(|factor| regressors.is_curved(factor, usable)).collect();
    if !curved.contains(&true) {
        return Some(NoSquares::TwoValues);
    }
    let widths = regressors.widths();
    let before = widths.len() - regressors.terms.len();
    let owners: Vec<usize> = widths.iter().enumerate().flat_map(|(term, width)| vec![term; *width]).collect();
    // The factors of the term that a column belongs to; none for mean and blocks.
    let parts = |column: usize| owners[column].checked_sub(before).map(|term| &regressors.terms[term]);
    let is_straight =
        |column: &usize| matches!(parts(*column), Some(p) if p.len() == 2 && p[0] == p[1] && !curved[p[0]]);
    let coefficients = owners.len() - (0..owners.len()).filter(is_straight).count();
    let (runs, points) = (usable.responses.len(), usable.point_count());
    let of_blocks: usize = widths[1..before].iter().sum();
    if coefficients - of_blocks > points {
        return Some(NoSquares::FewPoints { points, coefficients: coefficients - of_blocks });
    }
    if coefficients + LEAST_FREEDOM > runs {
        return Some(NoSquares::FewRuns { runs, coefficients });
    }
    // Which columns depend on others does not depend on the responses.
    let matrix = regressors.matrix(usable).ok()?;
    let fit = Fit::new(&matrix, &DVector::zeros(runs));
    let mut aliased: Vec<String> = Vec::new();
    for (column, _) in fit.dependent.iter().filter(|(column, _)| !is_straight(column)) {
        let label = parts(*column).map_or_else(|| "replicate".to_owned(), |parts| regressors.label(parts));
        if !aliased.contains(&label) {
            aliased.push(label);
        }
    }
    (!aliased.is_empty()).then_some(NoSquares::Aliased(aliased))
}
