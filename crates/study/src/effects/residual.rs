//! What a fit leaves: lack of fit, pure error, or nothing but rounding.

use nalgebra::DVector;

use super::distribution::f_tail;
use super::fit::Fit;
use super::model::Model;
use super::observation::Usable;
use super::pure_error::PureError;
use super::regressors::Regressors;
use super::result::{ErrorSource, LeftOut, Residual, ResidualParts, Squares, Test};

/// Residuals of a fit.
pub(super) struct Residuals<'a> {
    pub usable: &'a Usable,
    pub fit: &'a Fit,
    /// Those below this are none.
    pub rounding: f64,
}

impl Residuals<'_> {
    /// Whether they are nothing but rounding.
    pub fn are_rounding(&self, residuals: &DVector<f64>) -> bool {
        residuals.norm() <= self.rounding * (residuals.len() as f64).sqrt()
    }

    /// Their sum of squares; nothing if they are but rounding.
    fn squares(&self, residuals: &DVector<f64>, freedom: usize) -> Squares {
        let sum = if freedom == 0 || self.are_rounding(residuals) { 0.0 } else { residuals.norm_squared() };
        Squares { freedom, sum }
    }

    /// What the model leaves.
    pub fn left(&self) -> Squares {
        self.squares(&self.fit.residuals, self.fit.residuals.len() - self.fit.kept.len())
    }

    /// What the model leaves, and which part of that repeated points tell.
    pub fn split(&self, responses: &DVector<f64>, in_blocks: bool) -> Residual {
        let squares = self.left();
        let parts = PureError::new(self.usable, responses, in_blocks).map(|pure| {
            let pure_error = self.squares(&pure.residuals, pure.freedom);
            // Their difference, not that of the sums: it may be far smaller than either.
            let missed = &self.fit.residuals - &pure.residuals;
            let lack_of_fit = self.squares(&missed, squares.freedom.saturating_sub(pure.freedom));
            ResidualParts { lack_of_fit, pure_error, test: test(lack_of_fit, pure_error) }
        });
        Residual { squares, parts }
    }
}

/// Test of a mean square against another; none if either has no degrees of freedom, or the other is zero.
pub(super) fn test(squares: Squares, error: Squares) -> Option<Test> {
    let f = squares.mean()? / error.mean().filter(|mean| *mean > 0.0)?;
    Some(Test { f, p: f_tail(f, squares.freedom as f64, error.freedom as f64) })
}

/// What tells the error, where the model leaves this out.
pub(super) fn error_source(residual: &Residual, exact: bool, left_out: LeftOut) -> ErrorSource {
    if residual.squares.freedom == 0 {
        return ErrorSource::Saturated;
    }
    if exact {
        return ErrorSource::Exact;
    }
    match residual.parts {
        None => ErrorSource::Pooled(left_out),
        Some(parts) if parts.lack_of_fit.freedom == 0 => ErrorSource::Replicates,
        Some(_) => ErrorSource::Both(left_out),
    }
}

/// What a model with all its terms leaves out.
pub(super) fn left_out(regressors: &Regressors, usable: &Usable, model: Model) -> LeftOut {
    match model {
        Model::MainEffects if regressors.leave_interactions_only(usable) => LeftOut::Interactions,
        Model::Interactions if regressors.leave_interactions_only(usable) => LeftOut::HigherInteractions,
        _ => LeftOut::Other,
    }
}
