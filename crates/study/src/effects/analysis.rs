//! The analysis: a least-squares fit, and what follows from it.

use nalgebra::DVector;

use super::distribution::t_quantile;
use super::error::EffectsError;
use super::factor::Factor;
use super::fit::Fit;
use super::lenth::Lenth;
use super::model::{Model, Parts};
use super::observation::{Observation, Usable};
use super::regressors::Regressors;
use super::residual::{Residuals, error_source, left_out};
use super::result::{Effects, Fitted, Inner, LeftOut, Squares, Term};
use super::terms::{Judge, terms};

/// Residuals below this, relative to the largest response, are rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// An observation with more leverage than this has a coefficient of its own.
const SOLE: f64 = 1.0 - 1e-9;

/// How responses are analysed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// What the response is taken to depend on.
    pub model: Model,
    /// Whether replicates are blocks: with the same seeds at all points, a replicate is high or low at all of them.
    pub blocks: bool,
    /// Confidence level of intervals, between 0 and 1.
    pub confidence: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { model: Model::default(), blocks: true, confidence: 0.95 }
    }
}

/// What the responses tell of the factors.
///
/// Observations without a response are left out, whatever that does to the design, and of those of one run all but the
/// first; terms that cannot be told from each
/// other are reported as such.
///
/// # Errors
/// If there is no response or it is the same everywhere, a factor has less than two levels or no range, settings do not
/// fit the factors, or the model has too many coefficients.
pub fn analyse(factors: &[Factor], observations: &[Observation], options: &Options) -> Result<Effects, EffectsError> {
    analyse_terms(factors, observations, options, None)
}

/// The same with some of the terms of the model.
pub(super) fn analyse_terms(
    factors: &[Factor],
    observations: &[Observation],
    options: &Options,
    kept: Option<&[Parts]>,
) -> Result<Effects, EffectsError> {
    let Options { model, confidence, .. } = *options;
    let (usable, mut regressors) = prepared(factors, observations, options)?;
    let is_chosen = kept.is_some_and(|kept| regressors.keep(kept));
    let matrix = regressors.matrix(&usable)?;
    let count = usable.responses.len();
    let largest = usable.responses.iter().fold(0.0_f64, |largest, response| largest.max(response.abs()));
    // Sums of squares about the mean need not bear its digits. Divided first, the sum cannot overflow.
    let offset = usable.responses.iter().map(|response| response / count as f64).sum();
    let centred = DVector::from_iterator(count, usable.responses.iter().map(|response| response - offset));
    let centred_mean: f64 = centred.mean();
    let total = Squares { freedom: count - 1, sum: centred.add_scalar(-centred_mean).norm_squared() };
    let mut fit = Fit::new(&matrix, &centred);
    let rounding = ROUNDING * largest;
    let residual = Residuals { usable: &usable, fit: &fit, rounding };
    let exact = residual.are_rounding(&fit.residuals);
    let residual = residual.split(&centred, regressors.has_blocks());
    let variance = residual.squares.mean().filter(|_| !exact);
    let deviation = variance.map(f64::sqrt);
    let quantile = t_quantile(1.0 - confidence, residual.squares.freedom.max(1) as f64);
    let has_sole = fit.leverages.iter().any(|leverage| *leverage > SOLE);
    let predicted = (residual.squares.freedom > 0 && !has_sole).then(|| 1.0 - press(&fit) / total.sum);
    let adjusted = residual.squares.mean().zip(total.mean()).map(|(residual, total)| 1.0 - residual / total);
    let columns = matrix.column_iter().map(|column| column.add_scalar(-column.mean()).norm_squared()).collect();
    let judge = Judge { total: total.sum, error: variance.map(|_| residual.squares), quantile, columns };
    let (blocks, terms) = terms(&regressors, &fit, &judge);
    let left_out = if is_chosen { LeftOut::Other } else { left_out(&regressors, &usable, model) };
    let error = error_source(&residual, exact, left_out);
    let lenth = if deviation.is_none() { Lenth::new(&effects_of(&terms), confidence) } else { None };
    if exact {
        fit.residuals.fill(0.0);
    }
    let fitted = fitted(&usable, &fit);
    let (mean, repeated) = (offset + centred_mean, usable.repeated);
    let mean_row = [vec![1.0], vec![0.0; matrix.ncols() - 1]].concat();
    let inner = Inner { factors: factors.to_vec(), usable, regressors, fit, offset, rounding, deviation, quantile };
    Ok(Effects {
        model,
        observations: count,
        missing: observations.len() - repeated - count,
        repeated,
        confidence,
        mean,
        constant: inner.predict(&mean_row),
        blocks,
        terms,
        total,
        error,
        r_squared: 1.0 - residual.squares.sum / total.sum,
        adjusted_r_squared: adjusted,
        predicted_r_squared: predicted,
        residual_standard_deviation: deviation,
        residual,
        fitted,
        lenth,
        inner,
    })
}

/// What can be analysed, and the regressors of the model.
fn prepared(
    factors: &[Factor],
    observations: &[Observation],
    options: &Options,
) -> Result<(Usable, Regressors), EffectsError> {
    let Options { model, blocks, confidence } = *options;
    if !(confidence > 0.0 && confidence < 1.0) {
        return Err(EffectsError::Confidence(confidence));
    }
    factors.iter().try_for_each(Factor::check)?;
    let usable = Usable::new(factors, observations)?;
    let regressors = Regressors::new(factors, &usable, model, blocks)?;
    Ok((usable, regressors))
}

/// Each response beside the fit.
fn fitted(usable: &Usable, fit: &Fit) -> Vec<Fitted> {
    let each = usable.indices.iter().zip(&usable.responses).zip(&fit.residuals);
    let fitted = each.map(|((observation, response), residual)| Fitted {
        observation: *observation,
        fitted: response - residual,
        residual: *residual,
    });
    fitted.collect()
}

/// Sum of squares of what each response differs by from the fit to all others.
fn press(fit: &Fit) -> f64 {
    let left = fit.residuals.iter().zip(&fit.leverages);
    left.map(|(residual, leverage)| (residual / (1.0 - leverage)).powi(2)).sum()
}

fn effects_of(terms: &[Term]) -> Vec<f64> {
    terms.iter().filter_map(|term| Some(term.estimate?.effect)).collect()
}
