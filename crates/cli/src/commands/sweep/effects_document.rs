//! What `plateau sweep effects --json` prints.

use plateau_present::study::analysed_factor::AnalysedFactor;
use plateau_present::study::analysis::{AnalysedResponse, Analysis};
use plateau_present::study::equation::{equations, product};
use plateau_present::study::model::name;
use plateau_study::effects::{Effects, Equation, EquationTerm, Squares, Term, Test, Transform};
use serde::Serialize;

/// The whole document.
#[derive(Debug, Serialize)]
pub struct Document<'a> {
    study: &'a str,
    /// Runs that repeat another one and count once with it.
    repeats: usize,
    responses: Vec<Report>,
    files: Vec<String>,
}

impl<'a> Document<'a> {
    /// Of a study that was analysed.
    pub fn new(study: &'a str, repeats: usize, analysis: &Analysis, files: Vec<String>) -> Self {
        let responses = analysis.responses.iter().map(|response| Report::new(response, analysis)).collect();
        Self { study, repeats, responses, files }
    }
}

/// A response in it.
#[derive(Debug, Serialize)]
struct Report {
    name: String,
    unit: &'static str,
    /// What was done to the response before the fit; all results are those of `fitted`.
    transform: Option<&'static str>,
    fitted: String,
    /// Why there are no effects.
    error: Option<String>,
    /// As `--model` calls it.
    model: &'static str,
    /// Why it is that one.
    model_reason: String,
    /// Runs that have a response, each counted once.
    runs: usize,
    missing: usize,
    /// Mean of the responses.
    mean: f64,
    /// What the model says where all ranges are in the middle, averaged over levels.
    middle: f64,
    r_squared: f64,
    adjusted_r_squared: Option<f64>,
    predicted_r_squared: Option<f64>,
    residual_standard_deviation: Option<f64>,
    error_from: String,
    /// What the model leaves.
    residual: Option<SquaresReport>,
    /// The part of it that replicates do not show; absent without replicates.
    lack_of_fit: Option<SquaresReport>,
    /// The part of it that replicates show.
    pure_error: Option<SquaresReport>,
    misfit: Option<MisfitReport>,
    curvature: Option<CurvatureReport>,
    box_cox: Option<BoxCoxReport>,
    terms_left_out: Option<Vec<String>>,
    aicc: Option<f64>,
    /// In coded units, and in the units of the study.
    equations: Vec<EquationReport>,
    lenth: Option<LenthReport>,
    terms: Vec<TermReport>,
}

/// A sum of squares, and its test if there is one.
#[derive(Debug, Serialize)]
struct SquaresReport {
    degrees_of_freedom: usize,
    sum_of_squares: f64,
    f: Option<f64>,
    p: Option<f64>,
}

/// What the model misses, where that is significant.
#[derive(Debug, Serialize)]
struct MisfitReport {
    /// Absent where the other model leaves nothing.
    f: Option<f64>,
    p: f64,
    /// Whether replicates tell it; else the model to try does.
    by_replicates: bool,
    model_to_try: Option<&'static str>,
    /// Of the model to try.
    r_squared: Option<f64>,
}

/// What centre points differ by from the plane of the others.
#[derive(Debug, Serialize)]
struct CurvatureReport {
    difference: f64,
    interval: [f64; 2],
    f: f64,
    p: f64,
}

/// Powers of the response that the model fits best.
#[derive(Debug, Serialize)]
struct BoxCoxReport {
    lambda: f64,
    interval: [f64; 2],
}

/// The fitted model, in the SI unit of what is fitted.
#[derive(Debug, Serialize)]
struct EquationReport {
    units: &'static str,
    terms: Vec<EquationTermReport>,
}

#[derive(Debug, Serialize)]
struct EquationTermReport {
    /// Empty for the constant.
    variables: String,
    coefficient: f64,
}

/// What judges effects where there is no error.
#[derive(Debug, Serialize)]
struct LenthReport {
    pseudo_standard_error: f64,
    margin_of_error: f64,
    simultaneous_margin_of_error: f64,
}

#[derive(Debug, Serialize)]
struct TermReport {
    label: String,
    degrees_of_freedom: usize,
    sum_of_squares: f64,
    share: f64,
    /// Of the variance of the estimate, by correlation with other terms.
    variance_inflation: Option<f64>,
    f: Option<f64>,
    p: Option<f64>,
    effect: Option<f64>,
    standard_error: Option<f64>,
    interval: Option<[f64; 2]>,
    aliased_with: Vec<String>,
}

impl Report {
    fn new(response: &AnalysedResponse, analysis: &Analysis) -> Self {
        let effects = response.effects.as_ref().ok();
        let number = |value: fn(&Effects) -> f64| effects.map_or(f64::NAN, value);
        let optional = |value: fn(&Effects) -> Option<f64>| effects.and_then(value);
        let parts = effects.and_then(|effects| effects.residual.parts);
        Self {
            name: response.name.clone(),
            unit: response.unit,
            transform: response.scale.transform().map(Transform::name),
            fitted: response.title(),
            error: response.effects.as_ref().err().map(ToString::to_string),
            model: name(response.choice.model),
            model_reason: response.choice.reason.clone(),
            runs: effects.map_or(0, |effects| effects.observations),
            missing: effects.map_or(0, |effects| effects.missing),
            mean: number(|effects| effects.mean),
            middle: number(|effects| effects.constant.value),
            r_squared: number(|effects| effects.r_squared),
            adjusted_r_squared: optional(|effects| effects.adjusted_r_squared),
            predicted_r_squared: optional(|effects| effects.predicted_r_squared),
            residual_standard_deviation: optional(|effects| effects.residual_standard_deviation),
            error_from: effects.map_or_else(String::new, |effects| effects.error.to_string()),
            residual: effects.map(|effects| SquaresReport::new(effects.residual.squares, None)),
            lack_of_fit: parts.map(|parts| SquaresReport::new(parts.lack_of_fit, parts.test)),
            pure_error: parts.map(|parts| SquaresReport::new(parts.pure_error, None)),
            misfit: response.misfit.map(|misfit| MisfitReport {
                f: Some(misfit.test.f).filter(|f| f.is_finite()),
                p: misfit.test.p,
                by_replicates: misfit.by_replicates,
                model_to_try: misfit.better.map(|better| name(better.model)),
                r_squared: misfit.better.map(|better| better.r_squared),
            }),
            curvature: response.curvature.map(|found| CurvatureReport {
                difference: found.difference,
                interval: found.interval,
                f: found.test.f,
                p: found.test.p,
            }),
            box_cox: response.box_cox.map(|found| BoxCoxReport { lambda: found.power, interval: found.interval }),
            terms_left_out: response.selected.as_ref().map(|selected| selected.left_out.clone()),
            aicc: response.selected.as_ref().map(|selected| selected.aicc),
            equations: effects.map_or_else(Vec::new, |effects| EquationReport::both(effects, &analysis.factors)),
            lenth: effects.and_then(|effects| effects.lenth).map(|lenth| LenthReport {
                pseudo_standard_error: lenth.pseudo_standard_error,
                margin_of_error: lenth.margin,
                simultaneous_margin_of_error: lenth.simultaneous_margin,
            }),
            terms: effects.map_or_else(Vec::new, |effects| effects.rows().map(TermReport::new).collect()),
        }
    }
}

impl SquaresReport {
    fn new(squares: Squares, test: Option<Test>) -> Self {
        Self {
            degrees_of_freedom: squares.freedom,
            sum_of_squares: squares.sum,
            f: test.map(|test| test.f),
            p: test.map(|test| test.p),
        }
    }
}

impl TermReport {
    fn new(term: &Term) -> Self {
        let uncertainty = term.estimate.and_then(|estimate| estimate.uncertainty);
        Self {
            label: term.label.clone(),
            degrees_of_freedom: term.freedom,
            sum_of_squares: term.sum_of_squares,
            share: term.share,
            variance_inflation: term.inflation,
            f: term.test.map(|test| test.f),
            p: term.test.map(|test| test.p),
            effect: term.estimate.map(|estimate| estimate.effect),
            standard_error: uncertainty.map(|uncertainty| uncertainty.standard_error),
            interval: uncertainty.map(|uncertainty| uncertainty.interval),
            aliased_with: term.aliased_with.clone(),
        }
    }
}

impl EquationReport {
    /// In coded units, and in those of the study; nothing where they are too long.
    fn both(effects: &Effects, factors: &[AnalysedFactor]) -> Vec<Self> {
        let report = |(units, equation): (&'static str, Equation)| {
            let term = |term: &EquationTerm| EquationTermReport {
                variables: product(&term.variables, factors),
                coefficient: term.coefficient,
            };
            Self { units, terms: equation.terms.iter().map(term).collect() }
        };
        let both = equations(effects, factors).into_iter().flatten();
        ["coded", "of the study"].into_iter().zip(both).map(report).collect()
    }
}
