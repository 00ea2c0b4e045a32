//! Analyses beside those of statsmodels and R (the files in `effects`, made by `make.py` there), and those that other
//! programs do not make beside published ones.

mod expected;

use plateau_study::effects::{
    Better, Cell, Effects, ErrorSource, Lenth, Model, Nature, Prediction, Squares, Term, Test, half_normal_quantiles,
};

use expected::{ExpectedCell, ExpectedSurface, ExpectedTerm, Study};

/// What numbers have to agree to, relative to themselves.
const TOLERANCE: f64 = 1e-8;

/// Compares numbers of one analysis.
struct Comparison {
    name: &'static str,
    /// Differences below this are rounding of the responses.
    rounding: f64,
}

impl Comparison {
    fn same(&self, what: &str, found: f64, expected: f64) {
        let allowed = TOLERANCE * expected.abs() + self.rounding;
        assert!((found - expected).abs() <= allowed, "{}, {what}: {found:e} is not {expected:e}", self.name);
    }

    fn same_all<const N: usize>(&self, what: &str, found: [f64; N], expected: [f64; N]) {
        found.iter().zip(&expected).for_each(|(found, expected)| self.same(what, *found, *expected));
    }

    /// Numbers without a unit, to their own digits.
    fn exactly<const N: usize>(&self, what: &str, found: [f64; N], expected: [f64; N]) {
        Comparison { name: self.name, rounding: 0.0 }.same_all(what, found, expected);
    }

    fn squares(&self, what: &str, found: Squares, (freedom, sum): (usize, f64)) {
        assert_eq!(found.freedom, freedom, "{}: degrees of freedom of {what}", self.name);
        self.exactly(what, [found.sum], [sum]);
    }

    fn test(&self, what: &str, found: Option<Test>, expected: Option<[f64; 2]>) {
        assert_eq!(found.is_some(), expected.is_some(), "{}: test of {what}", self.name);
        if let (Some(found), Some(expected)) = (found, expected) {
            self.exactly(what, [found.f, found.p], expected);
        }
    }

    fn term(&self, found: &Term, expected: &ExpectedTerm) {
        let label = found.label.as_str();
        self.squares(label, Squares { freedom: found.freedom, sum: found.sum_of_squares }, expected.squares);
        self.test(label, found.test, expected.test);
        let coefficient = found.estimate.map(|estimate| estimate.coefficient);
        assert_eq!(coefficient.is_some(), expected.coefficient.is_some(), "{}: estimate of {label}", self.name);
        if let (Some(found), Some(expected)) = (found.estimate, expected.coefficient) {
            self.same(label, found.coefficient, expected);
            self.same(label, found.effect, 2.0 * expected);
        }
        let uncertainty = found.estimate.and_then(|estimate| estimate.uncertainty);
        assert_eq!(uncertainty.is_some(), expected.uncertainty.is_some(), "{}: error of {label}", self.name);
        if let (Some(found), Some([error, t, p, low, high])) = (uncertainty, expected.uncertainty) {
            self.exactly(label, [found.standard_error, found.t, found.p], [2.0 * error, t, p]);
            self.same_all(label, found.interval, [2.0 * low, 2.0 * high]);
        }
    }

    fn prediction(&self, what: &str, found: &Prediction, [value, error, low, high]: [f64; 4]) {
        self.same(what, found.value, value);
        self.exactly(what, [found.standard_error.unwrap()], [error]);
        self.same_all(what, found.interval.unwrap(), [low, high]);
    }

    fn cells(&self, study: &Study, factors: &[usize], found: &[Cell], expected: &[ExpectedCell]) {
        assert_eq!(found.len(), expected.len(), "{}: cells of {factors:?}", self.name);
        for (found, expected) in found.iter().zip(expected) {
            let kinds = factors.iter().zip(&expected.settings).map(|(factor, number)| {
                let mut numbers = vec![0.0; study.factors.len()];
                numbers[*factor] = *number;
                study.settings(&numbers)[*factor]
            });
            assert_eq!(found.settings, kinds.collect::<Vec<_>>());
            assert_eq!(found.count, expected.count);
            let [low, high] = found.interval.unwrap();
            self.same_all("mean", [found.mean, low, high], expected.numbers);
        }
    }

    fn surface(&self, study: &Study, effects: &Effects, expected: &ExpectedSurface) {
        let surface = effects.surface(&study.settings(&expected.settings)).unwrap();
        self.same("constant", surface.coded.constant, expected.constant);
        let pairs = |found: &[f64], expected: &[f64]| {
            assert_eq!(found.len(), expected.len());
            found.iter().zip(expected).for_each(|(found, expected)| self.same("surface", *found, *expected));
        };
        pairs(&surface.coded.linear, &expected.linear);
        surface.coded.quadratic.iter().zip(&expected.quadratic).for_each(|(found, row)| pairs(found, row));
        pairs(&surface.eigenvalues, &expected.eigenvalues);
        let stationary = surface.stationary.unwrap();
        pairs(&stationary.coded, &expected.stationary);
        pairs(&stationary.natural, &expected.natural);
        self.same("stationary", stationary.response.value, expected.response);
        self.same("stationary", surface.coded.value(&stationary.coded), expected.response);
        self.same("stationary", surface.natural.value(&stationary.natural), expected.response);
        let nature = match (expected.eigenvalues[0] < 0.0, expected.eigenvalues[expected.eigenvalues.len() - 1] > 0.0) {
            (true, false) => Nature::Maximum,
            (false, true) => Nature::Minimum,
            _ => Nature::Saddle,
        };
        assert_eq!(surface.nature, nature);
    }
}

/// Compares everything that an analysis tells.
fn compare(name: &'static str) -> Effects {
    let study = Study::read(name);
    let effects = study.effects();
    let expected = &study.expected;
    let largest =
        study.responses.iter().flatten().fold(0.0_f64, |largest, response| largest.max((response + study.shift).abs()));
    let comparison = Comparison { name, rounding: 1e-14 * largest };
    assert_eq!(effects.observations, expected.fitted.len());
    assert_eq!(effects.missing, study.responses.iter().filter(|response| response.is_none()).count());
    comparison.same("constant", effects.constant.value, expected.constant);
    let responses: Vec<f64> = study.responses.iter().flatten().map(|response| response + study.shift).collect();
    comparison.same("mean", effects.mean, responses.iter().sum::<f64>() / responses.len() as f64);
    comparison.squares("total", effects.total, expected.total);
    let rows: Vec<&Term> = effects.rows().filter(|term| term.freedom > 0).collect();
    assert_eq!(rows.len(), expected.terms.len());
    rows.iter().for_each(|term| comparison.term(term, &expected.terms[&term.label]));
    for (found, (fitted, residual)) in effects.fitted.iter().zip(expected.fitted.iter().zip(&expected.residuals)) {
        assert!(study.responses[found.observation].is_some());
        comparison.same("fitted", found.fitted, *fitted);
        comparison.same("residual", found.residual, *residual);
    }
    let Some(residual) = expected.residual else {
        assert_eq!(effects.error, ErrorSource::Saturated);
        assert!(effects.residual_standard_deviation.is_none());
        return effects;
    };
    comparison.squares("residual", effects.residual.squares, residual);
    let found = [effects.r_squared, effects.adjusted_r_squared.unwrap(), effects.predicted_r_squared.unwrap()];
    comparison.exactly("r squared", found, expected.r_squared.unwrap());
    comparison.exactly("deviation", [effects.residual_standard_deviation.unwrap()], [expected.deviation.unwrap()]);
    let parts = effects.residual.parts;
    assert_eq!(parts.is_some(), expected.pure_error.is_some());
    if let Some(parts) = parts {
        comparison.squares("pure error", parts.pure_error, expected.pure_error.unwrap());
        let (freedom, missed) = expected.lack_of_fit.unwrap();
        comparison.squares("lack of fit", parts.lack_of_fit, (freedom, if freedom == 0 { 0.0 } else { missed }));
        comparison.test("lack of fit", parts.test, expected.lack_of_fit_test);
    }
    for each in &expected.predictions {
        let found = effects.predict(&study.settings(&each.settings)).unwrap();
        comparison.prediction("prediction", &found, each.numbers);
    }
    for (factor, cells) in expected.level_means.iter().enumerate() {
        comparison.cells(&study, &[factor], &effects.level_means(factor), cells);
    }
    let last = study.factors.len() - 1;
    comparison.cells(&study, &[0, last], &effects.cell_means(0, last), &expected.cell_means);
    if let Some(expected) = &expected.surface {
        comparison.surface(&study, &effects, expected);
    }
    effects
}

#[test]
fn replicated_factorial_in_blocks() {
    let effects = compare("blocks");
    assert_eq!(effects.error.to_string(), "replicates, pooled with interactions of third and higher order");
    assert_eq!(compare("blocks_full").error.to_string(), "replicates");
    assert!(compare("no_blocks").blocks.is_none());
}

#[test]
fn factorial_without_replicates() {
    let effects = compare("filtration");
    // Montgomery, D. C.: Design and Analysis of Experiments, table 6.12: effect estimates of the filtration rate.
    let published = [21.625, 3.125, 9.875, 14.625, 0.125, -18.125, 16.625, 2.375, -0.375, -1.125, 1.875, 4.125, -1.625];
    for (term, published) in effects.terms.iter().zip(published) {
        assert!((term.estimate.unwrap().effect - published).abs() < 1e-12, "{}", term.label);
        assert!(term.test.is_none() && term.estimate.unwrap().uncertainty.is_none());
    }
    assert_eq!(effects.error.to_string(), "none: the model is saturated");
    let pooled = compare("filtration_pooled");
    assert_eq!(pooled.error.to_string(), "pooled: interactions of third and higher order");
    assert!(pooled.lenth.is_none());
}

#[test]
fn categories_with_missing_responses() {
    assert_eq!(compare("missing").missing, 6);
    assert_eq!(compare("missing_three").missing, 8);
}

#[test]
fn fractions() {
    let half = compare("half");
    assert!(half.terms.iter().all(|term| term.aliased_with.is_empty()));
    let quarter = compare("quarter");
    let aliases: Vec<String> =
        quarter.terms.iter().map(|term| format!("{} = {}", term.label, term.aliased_with.join(" = "))).collect();
    // Worked out by hand: D = AB and E = AC, so I = ABD = ACE = BCDE.
    assert_eq!(
        aliases[..8],
        [
            "pad = load × disc = speed × grain",
            "load = pad × disc",
            "speed = pad × grain",
            "disc = pad × load",
            "grain = pad × speed",
            "pad × load = disc",
            "pad × speed = grain",
            "pad × disc = load"
        ]
    );
    assert_eq!(aliases[9], "load × speed = disc × grain");
    let lost: Vec<usize> = quarter.terms.iter().map(|term| term.freedom).collect();
    assert_eq!(lost, [1, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0]);
}

#[test]
fn response_surfaces() {
    compare("composite");
    compare("saddle");
}

#[test]
fn latin_hypercube() {
    let effects = compare("hypercube");
    assert_eq!(effects.error.to_string(), "pooled: what the model leaves out");
    assert!(effects.level_means(0).is_empty());
    // Straight but for a sine, which squares do not show either.
    assert_eq!(effects.misfit(), None);
}

#[test]
fn curves_are_missed_by_interactions_and_told_by_squares() {
    let quadratic = compare("hypercube_quadratic");
    assert_eq!(quadratic.misfit(), None);
    // In the middle of the ranges the squares are nothing: that is not the mean.
    assert!((quadratic.mean - quadratic.constant.value).abs() > 0.2);
    let straight = compare("hypercube_curved");
    let [f, p, r_squared] = Study::read("hypercube_curved").expected.misfit.unwrap();
    let misfit = straight.misfit().unwrap();
    let Better { model, r_squared: found } = misfit.better.unwrap();
    assert!(!misfit.by_replicates && model == Model::Quadratic);
    let comparison = Comparison { name: "hypercube_curved", rounding: 0.0 };
    comparison.exactly("larger model", [misfit.test.f, misfit.test.p, found], [f, p, r_squared]);
    comparison.exactly("larger model", [found], [quadratic.r_squared]);
}

#[test]
fn replicates_tell_a_lack_of_fit() {
    // The product of three factors is left out, which the full model has.
    let blocks = compare("blocks");
    let misfit = blocks.misfit().unwrap();
    assert_eq!((misfit.by_replicates, Some(misfit.test)), (true, blocks.residual.parts.unwrap().test));
    let full = compare("blocks_full");
    let better = misfit.better.unwrap();
    assert_eq!(better.model, Model::Full);
    assert!((better.r_squared - full.r_squared).abs() < 1e-12);
    assert_eq!(full.misfit(), None);
    assert_eq!(compare("composite").misfit(), None);
    assert_eq!(compare("filtration").misfit(), None);
}

#[test]
fn tiny_probabilities_and_large_offsets() {
    let effects = compare("certain");
    assert!(effects.terms[0].test.unwrap().p < 1e-80);
    assert!(effects.terms[1].test.unwrap().p < 1e-30);
    compare("offset");
}

#[test]
fn margins_of_effects_without_error() {
    // Montgomery, D. C.: Design and Analysis of Experiments, 8th edition, section 6.5, Lenth's method for the
    // filtration rate of example 6.2: PSE = 2.625, ME = 6.748, SME = 13.699.
    let lenth = Study::read("filtration").effects().lenth.unwrap();
    assert!((lenth.pseudo_standard_error - 2.625).abs() < 1e-12);
    assert!((lenth.margin - 6.748).abs() < 5e-4, "{}", lenth.margin);
    assert!((lenth.simultaneous_margin - 13.699).abs() < 5e-4, "{}", lenth.simultaneous_margin);
    // qt(0.975, 5) and qt((1 + 0.95^(1/15))/2, 5) of R 4.2.2.
    assert!((lenth.margin / 2.625 - 2.5705818356363137).abs() < 1e-12);
    assert!((lenth.simultaneous_margin / 2.625 - 5.218651262019962).abs() < 1e-12);
    // The same of seven effects, with 7/3 degrees of freedom; all of them are small, and their median is 4.
    let seven = Lenth::new(&[1.0, -2.0, 3.0, -4.0, 5.0, -6.0, 7.0], 0.95).unwrap();
    assert_eq!(seven.pseudo_standard_error, 6.0);
    assert!((seven.margin / 6.0 - 3.76412307208258).abs() < 1e-12);
    assert!((seven.simultaneous_margin / 6.0 - 9.00830711394499).abs() < 1e-12, "{}", seven.simultaneous_margin / 6.0);
    // Of three effects, those of two factors, it would have one degree of freedom, and 12.7 times the error for a margin.
    assert_eq!(Lenth::new(&[1.0, -2.0, 3.0, -4.0, 5.0], 0.95), None);
    assert_eq!(Lenth::new(&[0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 0.95), None);
}

#[test]
fn quantiles_of_half_normal_plots() {
    // qnorm(0.5 + 0.5·(1:5 − 0.5)/5) of R 4.2.2.
    let expected =
        [0.12566134685507413, 0.3853204664075676, 0.6744897501960817, 1.0364333894937894, 1.6448536269514715];
    for (found, expected) in half_normal_quantiles(5).iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
    }
}
