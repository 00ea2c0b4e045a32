//! Why nothing can be told of the factors.

use thiserror::Error;

/// Why there are no effects.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EffectsError {
    /// Nothing to analyse.
    #[error("fewer than two runs have a value of it ({missing} have none)")]
    Empty {
        /// Observations without a response.
        missing: usize,
    },
    /// A response that is the same everywhere tells nothing.
    #[error("the response is {value:?} in all {observations} observations: no factor has an effect on it")]
    Constant {
        /// The response.
        value: f64,
        /// Observations that have it.
        observations: usize,
    },
    /// A response that is no number to calculate with.
    #[error("observation {}: the response {value:e} is beyond ±1e150", .observation + 1)]
    Response {
        /// Which, from 0.
        observation: usize,
        /// The response.
        value: f64,
    },
    /// A response that its transform is not for.
    #[error(
        "run {run} has the response {value}, and transform = \"{transform}\" takes values {domain}: leave the transform out, \
         or ask for another response"
    )]
    Domain {
        /// Number of the run.
        run: usize,
        /// The response, with its unit.
        value: String,
        /// What the study calls the transform.
        transform: &'static str,
        /// What it takes.
        domain: &'static str,
    },
    /// A factor that is none.
    #[error("factor `{factor}`: {problem}")]
    Factor {
        /// Its name.
        factor: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// Settings for another number of factors.
    #[error("{found} settings for {expected} factors")]
    Settings {
        /// Number of settings.
        found: usize,
        /// Number of factors.
        expected: usize,
    },
    /// A setting that its factor does not have.
    #[error("factor `{factor}` {problem}")]
    Setting {
        /// Name of the factor.
        factor: String,
        /// What it does not have.
        problem: String,
    },
    /// A model that no study is for.
    #[error("the model has {columns} coefficients, at most {most} can be estimated: leave out interactions or factors")]
    TooManyTerms {
        /// Coefficients of the model.
        columns: usize,
        /// Most that are.
        most: usize,
    },
    /// A confidence level that is no probability.
    #[error("confidence level {0}: it lies between 0 and 1, such as 0.95")]
    Confidence(f64),
    /// Surfaces are for models of numbers.
    #[error("a response surface needs the quadratic model and a factor with a range or numeric levels")]
    NoSurface,
}
