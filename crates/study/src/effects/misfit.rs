//! What a model misses although the runs show it, and which model shows more.

use nalgebra::{DMatrix, DVector};

use super::fit::Fit;
use super::model::Model;
use super::no_squares::no_squares_of;
use super::regressors::Regressors;
use super::residual::{Residuals, test};
use super::result::{Effects, Squares, Test};

/// Models that may do better, the smaller ones first.
const MODELS: [Model; 4] = [Model::MainEffects, Model::Interactions, Model::Quadratic, Model::Full];

/// Most coefficients of a model that is tried beside the one that was asked for: larger ones take longer than they help.
const MOST_COLUMNS: usize = 300;

/// A significant lack of fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Test of what the model misses; F is infinite where the other model leaves nothing.
    pub test: Test,
    /// Whether replicates tell it: it is then tested against the pure error. Else the better model does: what that adds
    /// is tested against what it leaves.
    pub by_replicates: bool,
    /// The model to try; none if no other one explains more.
    pub better: Option<Better>,
}

/// A model that explains more than the one that was fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Better {
    /// The model.
    pub model: Model,
    /// Share of the total sum of squares that it explains.
    pub r_squared: f64,
}

/// Another model that was fitted to the same responses.
struct Candidate {
    model: Model,
    matrix: DMatrix<f64>,
    left: Squares,
    /// Residual mean square by the total one, which needless terms raise.
    ratio: f64,
}

impl Effects {
    /// What the model misses, if that is significant at the confidence level. Replicates tell it, or a model that has all
    /// terms of this one and more: with several such models the level is divided by their number, after Bonferroni.
    pub fn misfit(&self) -> Option<Misfit> {
        let own = self.residual.squares;
        let own_ratio = own.mean()? / self.total.mean()?;
        self.residual_standard_deviation?;
        let level = 1.0 - self.confidence;
        let candidates: Vec<Candidate> = MODELS.into_iter().filter_map(|model| self.candidate(model)).collect();
        let better = |candidate: &Candidate| Better {
            model: candidate.model,
            r_squared: 1.0 - candidate.left.sum / self.total.sum,
        };
        if let Some(test) = self.residual.parts.and_then(|parts| parts.test).filter(|test| test.p < level) {
            let explains_more = |candidate: &&Candidate| candidate.left.sum < own.sum;
            let best = candidates.iter().filter(|candidate| candidate.ratio < own_ratio).filter(explains_more);
            let best = best.min_by(|one, other| one.ratio.total_cmp(&other.ratio));
            return Some(Misfit { test, by_replicates: true, better: best.map(better) });
        }
        let matrix = self.inner.regressors.matrix(&self.inner.usable).ok()?;
        let is_larger =
            |candidate: &&Candidate| candidate.left.freedom < own.freedom && contains(&candidate.matrix, &matrix);
        let larger: Vec<&Candidate> = candidates.iter().filter(is_larger).collect();
        let level = level / larger.len().max(1) as f64;
        let tested = larger.into_iter().filter_map(|candidate| {
            let left = candidate.left;
            let added = Squares { freedom: own.freedom - left.freedom, sum: (own.sum - left.sum).max(0.0) };
            let certain = Test { f: f64::INFINITY, p: 0.0 };
            let test = if left.sum > 0.0 { test(added, left)? } else { certain };
            (test.p < level).then_some((test, candidate))
        });
        let (test, best) = tested.min_by(|one, other| one.1.ratio.total_cmp(&other.1.ratio))?;
        Some(Misfit { test, by_replicates: false, better: Some(better(best)) })
    }

    /// Another model; none if it cannot be fitted or leaves no error.
    fn candidate(&self, model: Model) -> Option<Candidate> {
        if model == self.model {
            return None;
        }
        let inner = &self.inner;
        // Squares that the runs do not allow are no advice: they would be told from nothing.
        let has_blocks = inner.regressors.has_blocks();
        if model == Model::Quadratic && no_squares_of(&inner.factors, &inner.usable, has_blocks).is_some() {
            return None;
        }
        let regressors = Regressors::new(&inner.factors, &inner.usable, model, has_blocks).ok()?;
        if regressors.widths().iter().sum::<usize>() > MOST_COLUMNS {
            return None;
        }
        let matrix = regressors.matrix(&inner.usable).ok()?;
        let centred = inner.usable.responses.iter().map(|response| response - inner.offset);
        let fit = Fit::new(&matrix, &DVector::from_iterator(matrix.nrows(), centred));
        let left = Residuals { usable: &inner.usable, fit: &fit, rounding: inner.rounding }.left();
        let ratio = left.mean()? / self.total.mean()?;
        Some(Candidate { model, matrix, left, ratio })
    }
}

/// Whether a model has all that another one has: whether each column of the other is a combination of its columns.
fn contains(larger: &DMatrix<f64>, smaller: &DMatrix<f64>) -> bool {
    let count = larger.ncols();
    let mut both = larger.clone().resize_horizontally(count + smaller.ncols(), 0.0);
    both.columns_mut(count, smaller.ncols()).copy_from(smaller);
    Fit::new(&both, &DVector::zeros(both.nrows())).kept.iter().all(|column| *column < count)
}
