//! The sensitivities of a study, and what `plateau sweep sensitivity --json` prints of them.

use plateau_study::sensitivity::{ElementaryEffect, Index, SobolIndices};
use serde::Serialize;

/// What is known of one response, or why nothing is.
pub(super) enum Known {
    /// Indices from a surrogate, and which one it is and why.
    Indices(SobolIndices, String),
    /// Elementary effects from the runs themselves.
    Effects(Vec<ElementaryEffect>),
    /// Why there are none.
    Nothing(String),
}

/// The sensitivities of all responses.
pub(super) struct Told {
    /// Names of the factors.
    pub factors: Vec<String>,
    /// Name, SI unit, largest size.
    pub responses: Vec<(String, &'static str, f64, Known)>,
    /// Confidence level of intervals.
    pub confidence: f64,
}

/// The reports of all responses.
pub fn reports(told: &Told) -> Vec<Report<'_>> {
    let report = |(name, unit, _, known): &'_ (String, &'static str, f64, Known)| {
        let mut report = Report { unit, ..Report::default() };
        name.clone_into(&mut report.name);
        match known {
            Known::Nothing(why) => report.error = Some(why.clone()),
            Known::Indices(indices, reason) => {
                report.surrogate = Some(reason.clone());
                report.variance = Some(indices.variance);
                let index = |index: &Index| IndexReport { value: index.value, interval: index.interval };
                let of = |at: usize| (index(&indices.first[at]), index(&indices.total[at]));
                report.indices = (0..told.factors.len())
                    .map(|at| FactorIndices { factor: &told.factors[at], first_order: of(at).0, total: of(at).1 })
                    .collect();
            }
            Known::Effects(effects) => {
                report.elementary_effects = (told.factors.iter().zip(effects))
                    .map(|(factor, effect)| FactorEffects {
                        factor,
                        mean_size: effect.mean_size,
                        mean: effect.mean,
                        deviation: effect.deviation,
                        standard_error: effect.error,
                        effects: effect.count,
                    })
                    .collect();
            }
        }
        report
    };
    told.responses.iter().map(report).collect()
}

/// What `plateau sweep sensitivity --json` prints.
#[derive(Debug, Serialize)]
pub struct Document<'a> {
    pub study: &'a str,
    pub responses: Vec<Report<'a>>,
    pub files: Vec<String>,
}

/// A response in it.
#[derive(Debug, Serialize, Default)]
pub struct Report<'a> {
    name: String,
    unit: &'a str,
    /// Why nothing is known.
    error: Option<String>,
    /// What the indices are of, and why.
    surrogate: Option<String>,
    /// Variance of the response over all ranges.
    variance: Option<f64>,
    indices: Vec<FactorIndices<'a>>,
    elementary_effects: Vec<FactorEffects<'a>>,
}

/// Indices of a factor.
#[derive(Debug, Serialize)]
pub struct FactorIndices<'a> {
    factor: &'a str,
    first_order: IndexReport,
    total: IndexReport,
}

/// An index.
#[derive(Debug, Serialize)]
pub struct IndexReport {
    value: f64,
    interval: Option<[f64; 2]>,
}

/// Elementary effects of a factor.
#[derive(Debug, Serialize)]
pub struct FactorEffects<'a> {
    factor: &'a str,
    mean_size: f64,
    mean: f64,
    deviation: f64,
    standard_error: f64,
    effects: usize,
}
