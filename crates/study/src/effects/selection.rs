//! Which terms of a model the runs support: the choice with the least corrected criterion of Akaike.
//!
//! Hurvich, C. M. & Tsai, C.-L. (1989): Regression and time series model selection in small samples. Biometrika 76,
//! 297–307, doi:10.1093/biomet/76.2.297. AICc = n·ln(RSS/n) + 2·k + 2·k·(k + 1)/(n − k − 1), with k coefficients, the
//! error's variance among them. Terms come and go one at a time, whichever lowers it most; a term stays while one that it is a
//! part of is there.

use nalgebra::{DMatrix, DVector};

use super::analysis::{Options, analyse_terms};
use super::error::EffectsError;
use super::factor::Factor;
use super::fit::Fit;
use super::model::Parts;
use super::observation::{Observation, Usable};
use super::regressors::Regressors;
use super::result::Effects;

/// Less than this is no improvement but rounding.
const IMPROVEMENT: f64 = 1e-9;
/// Residuals below this, relative to the largest response, are rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A model with the terms that the runs support.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// The analysis with these terms.
    pub effects: Effects,
    /// Terms of the model that were left out.
    pub left_out: Vec<String>,
    /// The criterion of the terms that were kept.
    pub aicc: f64,
    /// That of all terms; none where so many leave nothing for an error.
    pub aicc_of_all: Option<f64>,
}

/// Analyses with the terms of a model that have the least AICc. Blocks stay.
///
/// # Errors
/// Those of [`analyse`](super::analyse).
pub fn select(factors: &[Factor], observations: &[Observation], options: &Options) -> Result<Selection, EffectsError> {
    factors.iter().try_for_each(Factor::check)?;
    let usable = Usable::new(factors, observations)?;
    let regressors = Regressors::new(factors, &usable, options.model, options.blocks)?;
    let search = Search::new(&regressors, &usable)?;
    let all = search.with_columns();
    let from_all = search.improve(all.clone());
    let from_none = search.improve(vec![false; all.len()]);
    let kept = if search.criterion(&from_all) <= search.criterion(&from_none) { from_all } else { from_none };
    let terms = regressors.terms.iter().zip(&kept).filter(|(_, kept)| **kept);
    let terms: Vec<Parts> = terms.map(|(parts, _)| parts.clone()).collect();
    let left_out = regressors.terms.iter().zip(&kept).filter(|(_, kept)| !**kept);
    let left_out = left_out.map(|(parts, _)| regressors.label(parts)).collect();
    let (aicc, aicc_of_all) = (search.criterion(&kept), search.criterion(&all));
    Ok(Selection {
        effects: analyse_terms(factors, observations, options, Some(&terms))?,
        left_out,
        aicc,
        aicc_of_all: Some(aicc_of_all).filter(|aicc| aicc.is_finite()),
    })
}

/// The terms to choose from, in coordinates in which all models are small.
struct Search<'a> {
    terms: &'a [Parts],
    /// Columns of mean and blocks, which stay.
    fixed: usize,
    /// Columns of each term.
    columns: Vec<std::ops::Range<usize>>,
    /// The model matrix and the responses along its orthogonal basis.
    triangle: DMatrix<f64>,
    heads: DVector<f64>,
    /// Sum of squares of the responses beyond the model.
    beyond: f64,
    /// Sums of squares below this are rounding.
    rounding: f64,
    observations: f64,
}

impl<'a> Search<'a> {
    fn new(regressors: &'a Regressors, usable: &Usable) -> Result<Self, EffectsError> {
        let matrix = regressors.matrix(usable)?;
        let count = usable.responses.len();
        let offset: f64 = usable.responses.iter().map(|response| response / count as f64).sum();
        let centred = DVector::from_iterator(count, usable.responses.iter().map(|response| response - offset));
        let largest = usable.responses.iter().fold(0.0_f64, |largest, response| largest.max(response.abs()));
        let widths = regressors.widths();
        let before = widths.len() - regressors.terms.len();
        let fixed = widths[..before].iter().sum();
        let ends = widths[before..].iter().scan(fixed, |end, width| {
            *end += width;
            Some(*end - width..*end)
        });
        let columns = ends.collect();
        let whole = matrix.qr();
        let mut turned = centred;
        whole.q_tr_mul(&mut turned);
        let triangle = whole.r();
        let beyond = turned.rows(triangle.nrows(), count - triangle.nrows()).norm_squared();
        let heads = turned.rows(0, triangle.nrows()).into_owned();
        let rounding = count as f64 * (ROUNDING * largest).powi(2);
        Ok(Self {
            terms: &regressors.terms,
            fixed,
            columns,
            triangle,
            heads,
            beyond,
            rounding,
            observations: count as f64,
        })
    }

    /// Terms that have a column of their own if all are there.
    fn with_columns(&self) -> Vec<bool> {
        let fit = Fit::new(&self.triangle, &self.heads);
        let has_own = |columns: &std::ops::Range<usize>| fit.kept.iter().any(|column| columns.contains(column));
        self.columns.iter().map(has_own).collect()
    }

    /// AICc with some of the terms; infinite where nothing is left for the error.
    fn criterion(&self, kept: &[bool]) -> f64 {
        let own = self.columns.iter().zip(kept).filter(|(_, kept)| **kept).flat_map(|(columns, _)| columns.clone());
        let columns: Vec<usize> = (0..self.fixed).chain(own).collect();
        let fit = Fit::new(&self.triangle.select_columns(&columns), &self.heads);
        let left = (fit.residuals.norm_squared() + self.beyond).max(self.rounding);
        let (n, k) = (self.observations, fit.kept.len() as f64 + 1.0);
        if n - k - 1.0 <= 0.0 {
            return f64::INFINITY;
        }
        n * (left / n).ln() + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0)
    }

    /// Whether a term may come or go.
    fn may_change(&self, kept: &[bool], term: usize) -> bool {
        let mut others = (0..self.terms.len()).filter(|other| *other != term);
        if kept[term] {
            !others.any(|other| kept[other] && is_part(&self.terms[term], &self.terms[other]))
        } else {
            others.all(|other| kept[other] || !is_part(&self.terms[other], &self.terms[term]))
        }
    }

    /// Changes one term after the other, while that lowers the criterion.
    fn improve(&self, mut kept: Vec<bool>) -> Vec<bool> {
        let mut least = self.criterion(&kept);
        // Each change lowers the criterion, so no choice comes twice; the bound is for what rounding might do.
        for _ in 0..4 * self.terms.len().max(1) {
            let changed = (0..self.terms.len()).filter(|term| self.may_change(&kept, *term)).map(|term| {
                let mut other = kept.clone();
                other[term] = !other[term];
                (self.criterion(&other), other)
            });
            let Some((criterion, best)) = changed.min_by(|one, other| one.0.total_cmp(&other.0)) else { break };
            // From infinity any number is better; between two infinities fewer terms are.
            let fewer = criterion == f64::INFINITY && least == f64::INFINITY;
            let goes = best.iter().filter(|kept| **kept).count() < kept.iter().filter(|kept| **kept).count();
            if !(criterion < least - IMPROVEMENT || fewer && goes) {
                break;
            }
            (least, kept) = (criterion, best);
        }
        kept
    }
}

/// Whether a term is a part of another one, which needs it: a main effect of an interaction or of a square.
fn is_part(part: &Parts, whole: &Parts) -> bool {
    part.len() < whole.len() && part.iter().all(|factor| whole.contains(factor))
}
