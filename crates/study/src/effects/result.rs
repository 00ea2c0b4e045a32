//! What an analysis tells.

use std::fmt;

use super::distribution::f_quantile;
use super::factor::Factor;
use super::fit::Fit;
use super::lenth::{Lenth, half_normal_quantiles};
use super::model::Model;
use super::observation::Usable;
use super::regressors::Regressors;

/// What the responses tell of the factors.
#[derive(Debug, Clone, PartialEq)]
pub struct Effects {
    /// What the response was taken to depend on.
    pub model: Model,
    /// Runs that have a response; each counts once, however often it was observed.
    pub observations: usize,
    /// Runs that have none.
    pub missing: usize,
    /// Observations that were left out because another one is of the same run.
    pub repeated: usize,
    /// Confidence level of all intervals.
    pub confidence: f64,
    /// Mean of the responses, which is that of the model over the points of the design.
    pub mean: f64,
    /// The response of the model where all numbers are 0 in coded units, averaged over levels and blocks: in a quadratic
    /// model that in the middle of the ranges, not the mean.
    pub constant: Prediction,
    /// What replicates differ by, at all points alike; none if there is one only or blocks are not wanted.
    pub blocks: Option<Term>,
    /// What the factors do: single factors first, squares last.
    pub terms: Vec<Term>,
    /// What the model leaves.
    pub residual: Residual,
    /// Deviations from the mean response.
    pub total: Squares,
    /// What tells how uncertain all this is.
    pub error: ErrorSource,
    /// Share of the total sum of squares that the model explains.
    pub r_squared: f64,
    /// The same with mean squares, so that needless terms lower it.
    pub adjusted_r_squared: Option<f64>,
    /// The same for responses that the model was not fitted to, each by a fit without it; none where a term depends on
    /// one observation alone.
    pub predicted_r_squared: Option<f64>,
    /// Standard deviation of the error, in the unit of the response.
    pub residual_standard_deviation: Option<f64>,
    /// Each observation that has a response, in their order.
    pub fitted: Vec<Fitted>,
    /// Which terms stand out if no error is known.
    pub lenth: Option<Lenth>,
    pub(super) inner: Inner,
}

/// What predictions, means and surfaces are made of.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Inner {
    pub factors: Vec<Factor>,
    pub usable: Usable,
    pub regressors: Regressors,
    pub fit: Fit,
    /// The mean response, which the fit is without.
    pub offset: f64,
    /// Residuals below this are none.
    pub rounding: f64,
    /// Standard deviation of the error.
    pub deviation: Option<f64>,
    /// How many standard errors intervals reach.
    pub quantile: f64,
}

/// A term of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// Such as `load`, `load × speed` or `load²`; `replicate` for blocks.
    pub label: String,
    /// Its factors, by index; a square names its factor twice, blocks have none.
    pub factors: Vec<usize>,
    /// Degrees of freedom; 0 if other terms have the estimate.
    pub freedom: usize,
    /// Terms that it cannot be told from, wholly or in part: with degrees of freedom left, the estimate is that of the
    /// sum.
    pub aliased_with: Vec<String>,
    /// How much the residual sum of squares grows without the term, all others kept: type III. In orthogonal designs
    /// these add up to what the model explains.
    pub sum_of_squares: f64,
    /// Share of the sum of squares in the total.
    pub share: f64,
    /// Test against the error.
    pub test: Option<Test>,
    /// How many times as large the variance of the estimate is as it would be if the term were not correlated with any other
    /// (variance inflation factor); of terms with one degree of freedom.
    pub inflation: Option<f64>,
    /// How large the effect is; for terms with one degree of freedom.
    pub estimate: Option<Estimate>,
}

impl Term {
    /// Sum of squares by degrees of freedom.
    pub fn mean_square(&self) -> Option<f64> {
        Squares { freedom: self.freedom, sum: self.sum_of_squares }.mean()
    }
}

/// An F test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Test {
    /// Mean square by that of the error.
    pub f: f64,
    /// Probability of a larger one if there were no effect.
    pub p: f64,
}

/// An effect, in the unit of the response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Twice the coefficient: the difference between the responses at the upper and at the lower end or level. Of a
    /// product, it is half the difference between one factor's effects at the ends of the other.
    pub effect: f64,
    /// In coded units, −1 to 1.
    pub coefficient: f64,
    /// How uncertain the effect is; none without an error.
    pub uncertainty: Option<Uncertainty>,
}

/// How uncertain an effect is. Standard error and interval of the coefficient are half of these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncertainty {
    /// Standard error of the effect.
    pub standard_error: f64,
    /// Effect by standard error.
    pub t: f64,
    /// Probability of a t that is farther from 0 if there were no effect.
    pub p: f64,
    /// Confidence interval of the effect.
    pub interval: [f64; 2],
}

/// A sum of squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Squares {
    /// Degrees of freedom.
    pub freedom: usize,
    /// The sum, in the square of the response's unit.
    pub sum: f64,
}

impl Squares {
    /// Mean square; none without degrees of freedom.
    pub fn mean(&self) -> Option<f64> {
        (self.freedom > 0).then(|| self.sum / self.freedom as f64)
    }
}

/// What the model leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// All of it.
    pub squares: Squares,
    /// Its parts where points are repeated.
    pub parts: Option<ResidualParts>,
}

/// What the model misses, and what no model can explain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResidualParts {
    /// What means of points differ by from the model.
    pub lack_of_fit: Squares,
    /// What observations of the same point differ by, but for their blocks.
    pub pure_error: Squares,
    /// Test of the lack of fit against the pure error.
    pub test: Option<Test>,
}

/// What tells the error that effects are tested against: the mean square of the residual.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorSource {
    /// Repeated points.
    Replicates,
    /// What the model leaves out, taken to be none.
    Pooled(LeftOut),
    /// Repeated points and what the model leaves out.
    Both(LeftOut),
    /// Nothing: there are as many coefficients as observations, or points.
    Saturated,
    /// Nothing: the model reproduces all responses but for rounding.
    Exact,
}

/// What a model leaves out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeftOut {
    /// All interactions.
    Interactions,
    /// Those of more than two factors.
    HigherInteractions,
    /// Anything.
    Other,
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            LeftOut::Interactions => "interactions",
            LeftOut::HigherInteractions => "interactions of third and higher order",
            LeftOut::Other => "what the model leaves out",
        })
    }
}

impl fmt::Display for ErrorSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ErrorSource::Replicates => f.write_str("replicates"),
            ErrorSource::Pooled(left_out) => write!(f, "pooled: {left_out}"),
            ErrorSource::Both(left_out) => write!(f, "replicates, pooled with {left_out}"),
            ErrorSource::Saturated => f.write_str("none: the model is saturated"),
            ErrorSource::Exact => f.write_str("none: the model reproduces all responses"),
        }
    }
}

/// An observation beside the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// Which observation, from 0.
    pub observation: usize,
    /// What the model makes of it, with its block.
    pub fitted: f64,
    /// How much more was observed.
    pub residual: f64,
}

/// A response that the model predicts, averaged over blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// The response.
    pub value: f64,
    /// Standard error of its mean; none without an error.
    pub standard_error: Option<f64>,
    /// Confidence interval of its mean.
    pub interval: Option<[f64; 2]>,
}

/// An effect in a half-normal plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfNormal {
    /// Which term.
    pub term: usize,
    /// Size of its effect.
    pub size: f64,
    /// Where a normal deviate of this rank would be, in standard deviations.
    pub quantile: f64,
}

impl Effects {
    /// What was observed of the response, in the order of the observations that have one.
    pub fn responses(&self) -> impl Iterator<Item = f64> {
        self.fitted.iter().map(|fitted| fitted.fitted + fitted.residual)
    }

    /// The effects of terms with one degree of freedom for a half-normal plot, from the smallest.
    pub fn half_normal(&self) -> Vec<HalfNormal> {
        let size = |(term, each): (usize, &Term)| Some((term, each.estimate?.effect.abs()));
        let mut sizes: Vec<(usize, f64)> = self.terms.iter().enumerate().filter_map(size).collect();
        sizes.sort_by(|a, b| a.1.total_cmp(&b.1));
        let quantiles = half_normal_quantiles(sizes.len());
        sizes.iter().zip(quantiles).map(|(&(term, size), quantile)| HalfNormal { term, size, quantile }).collect()
    }

    /// The F beyond which a term of so many degrees of freedom is significant at the confidence level; none without an
    /// error.
    pub fn critical_f(&self, freedom: usize) -> Option<f64> {
        self.residual_standard_deviation?;
        let error = self.residual.squares.freedom;
        (freedom > 0).then(|| f_quantile(1.0 - self.confidence, freedom as f64, error as f64))
    }

    /// Whether a term stands out at the confidence level: by its test, or by the margin of error of Lenth's method. None
    /// where neither is there.
    pub fn is_significant(&self, term: &Term) -> Option<bool> {
        let by_test = term.test.map(|test| test.p < 1.0 - self.confidence);
        by_test.or_else(|| Some(term.estimate?.effect.abs() > self.lenth?.margin))
    }

    /// All rows of the table of variances but the residual and the total: blocks, if any, and terms.
    pub fn rows(&self) -> impl Iterator<Item = &Term> {
        self.blocks.iter().chain(&self.terms)
    }
}
