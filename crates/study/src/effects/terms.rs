//! The terms of a fitted model: aliases, tests, effects.

use std::collections::BTreeSet;

use super::distribution::t_tails;
use super::fit::Fit;
use super::regressors::Regressors;
use super::residual::test;
use super::result::{Estimate, Squares, Term, Uncertainty};

/// What terms are measured by.
pub(super) struct Judge {
    /// Total sum of squares.
    pub total: f64,
    /// The residual, unless it is none.
    pub error: Option<Squares>,
    /// Quantile of t.
    pub quantile: f64,
    /// Sums of squares of the columns of the model matrix about their means.
    pub columns: Vec<f64>,
}

/// The blocks' term, if any, and the factors' terms.
pub(super) fn terms(regressors: &Regressors, fit: &Fit, judge: &Judge) -> (Option<Term>, Vec<Term>) {
    let widths = regressors.widths();
    let owners: Vec<usize> = widths.iter().enumerate().flat_map(|(term, width)| vec![term; *width]).collect();
    let mut labels = vec!["mean".to_owned()];
    labels.extend(regressors.has_blocks().then(|| "replicate".to_owned()));
    let before = labels.len();
    labels.extend(regressors.terms.iter().map(|parts| regressors.label(parts)));
    let mut aliases = vec![BTreeSet::new(); labels.len()];
    // A factor of which one level was observed only has no column, and its interactions are those of the others.
    let constant = regressors.terms.iter().enumerate().filter(|(index, _)| widths[before + index] == 0);
    let constant = constant.map(|(index, parts)| {
        let others = regressors.varying(parts);
        let other = regressors.terms.iter().position(|term| *term == others).map_or(0, |other| before + other);
        (before + index, other)
    });
    let dependent = fit.dependent.iter().flat_map(|(column, with)| {
        let with = if with.is_empty() { vec![0] } else { with.clone() };
        with.into_iter().map(|other| (owners[*column], owners[other]))
    });
    for (term, other) in constant.chain(dependent).filter(|(term, other)| term != other) {
        aliases[term].insert(other);
        aliases[other].insert(term);
    }
    let mut positions = vec![vec![]; labels.len()];
    fit.kept.iter().enumerate().for_each(|(position, column)| positions[owners[*column]].push(position));
    let mut all = (1..labels.len()).map(|term| {
        let factors = term.checked_sub(before).map_or(vec![], |index| regressors.terms[index].clone());
        let aliased_with = aliases[term].iter().map(|other| labels[*other].clone()).collect();
        let freedom = positions[term].len();
        let sum_of_squares = if freedom == 0 { 0.0 } else { fit.sum_of_squares(&positions[term]) };
        // What is left of several contrasts is no difference between two levels.
        let estimate = match positions[term].as_slice() {
            [position] if widths[term] == 1 && !factors.is_empty() => Some(judge.estimate(fit, *position)),
            _ => None,
        };
        let inflation = match positions[term].as_slice() {
            [position] if widths[term] == 1 => {
                Some(fit.variance(*position) * judge.columns[fit.kept[*position]]).filter(|inflation| *inflation > 0.0)
            }
            _ => None,
        };
        let test = judge.error.and_then(|error| test(Squares { freedom, sum: sum_of_squares }, error));
        let share = sum_of_squares / judge.total;
        Term {
            label: labels[term].clone(),
            factors,
            freedom,
            aliased_with,
            sum_of_squares,
            share,
            test,
            inflation,
            estimate,
        }
    });
    let blocks = if regressors.has_blocks() { all.next() } else { None };
    (blocks, all.collect())
}

impl Judge {
    fn estimate(&self, fit: &Fit, position: usize) -> Estimate {
        let coefficient = fit.coefficients[position];
        let effect = 2.0 * coefficient;
        let uncertainty = self.error.and_then(|error| {
            let standard_error = 2.0 * (error.mean()? * fit.variance(position)).sqrt();
            let t = effect / standard_error;
            let reach = self.quantile * standard_error;
            let p = t_tails(t, error.freedom as f64);
            Some(Uncertainty { standard_error, t, p, interval: [effect - reach, effect + reach] })
        });
        Estimate { effect, coefficient, uncertainty }
    }
}
