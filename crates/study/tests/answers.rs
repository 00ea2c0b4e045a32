//! What the results of a study answer, beside statsmodels and scipy (`answers/answers.json`, made by `make.py` there), published
//! analyses and closed forms.

use std::fs;
use std::path::Path;

use plateau_study::design::Setting;
use plateau_study::effects::{
    Advice, Effects, Equation, Factor, FactorKind, Model, Observation, Options, Transform, Variable, analyse, select,
};
use plateau_study::surrogate::{PolynomialSurrogate, Scale, Surrogate};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::Deserialize;

#[derive(Deserialize)]
struct Answers {
    poisons: Poisons,
    surfaces: Vec<Surface>,
    blocks: Blocks,
}

#[derive(Deserialize)]
struct Poisons {
    settings: Vec<[usize; 2]>,
    y: Vec<f64>,
    box_cox: [f64; 3],
}

#[derive(Deserialize)]
struct Surface {
    x: Vec<Vec<f64>>,
    y: Vec<f64>,
    box_cox: [f64; 3],
    at: Vec<Vec<f64>>,
    forecasts: Vec<Forecasts>,
    leave_one_out: f64,
    standardised: Vec<f64>,
    aicc: f64,
    aicc_of_all: f64,
    kept: Vec<Vec<usize>>,
}

#[derive(Deserialize)]
struct Forecasts {
    confidence: f64,
    /// Value, interval of means, interval of runs.
    numbers: Vec<[f64; 5]>,
}

#[derive(Deserialize)]
struct Blocks {
    x: Vec<Vec<f64>>,
    y: Vec<Vec<f64>>,
    at: Vec<Vec<f64>>,
    numbers: Vec<[f64; 5]>,
}

fn answers() -> Answers {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/answers/answers.json");
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// Both are least squares by orthogonal transforms; of 30 runs and 10 coefficients they differ by far less than this.
const TOLERANCE: f64 = 1e-8;

fn same(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() <= TOLERANCE * expected.abs().max(1.0), "{what}: {found:e} is not {expected:e}");
}

fn ranges(count: usize) -> Vec<Factor> {
    let range = |at| Factor { name: format!("x{at}"), kind: FactorKind::Range { low: -1.0, high: 1.0 } };
    (0..count).map(range).collect()
}

fn coded(point: &[f64]) -> Vec<Setting> {
    point.iter().copied().map(Setting::Coded).collect()
}

fn observations(x: &[Vec<f64>], y: &[f64]) -> Vec<Observation> {
    let each = x.iter().zip(y).enumerate();
    each.map(|(run, (x, y))| Observation { settings: coded(x), replicate: 0, run, response: *y }).collect()
}

fn quadratic(x: &[Vec<f64>], y: &[f64]) -> Effects {
    let options = Options { model: Model::Quadratic, ..Options::default() };
    analyse(&ranges(x[0].len()), &observations(x, y), &options).unwrap()
}

fn logarithms(y: &[f64]) -> Vec<f64> {
    y.iter().map(|y| y.ln()).collect()
}

const LOGARITHM: Scale = Scale { unit: 1.0, transform: Some(Transform::Logarithm) };

#[test]
fn powers_of_poisons_are_those_of_box_and_cox() {
    let Poisons { settings, y, box_cox } = answers().poisons;
    let levels = |name: &str, count: usize| {
        let labels = (0..count).map(|level| level.to_string()).collect();
        Factor { name: name.into(), kind: FactorKind::Categorical(labels) }
    };
    let observation = |(run, (levels, y)): (usize, (&[usize; 2], &f64))| Observation {
        settings: levels.map(Setting::Level).to_vec(),
        replicate: 0,
        run,
        response: *y,
    };
    let observations: Vec<Observation> = settings.iter().zip(&y).enumerate().map(observation).collect();
    let options = Options { model: Model::MainEffects, ..Options::default() };
    let effects = analyse(&[levels("poison", 3), levels("treatment", 4)], &observations, &options).unwrap();
    let found = effects.box_cox(None).unwrap();
    // A likelihood is flat at its top: scipy finds the place to the root of its tolerance.
    assert!((found.power - box_cox[0]).abs() < 1e-5, "{found:?} {box_cox:?}");
    same(found.interval[0], box_cox[1], "lower end");
    same(found.interval[1], box_cox[2], "upper end");
    // As published, read from a figure there: −0.75, −1.13 to −0.37.
    for (found, published) in [found.power, found.interval[0], found.interval[1]].into_iter().zip([-0.75, -1.13, -0.37])
    {
        assert!((found - published).abs() < 0.015, "{found} {published}");
    }
    assert_eq!(found.advice(None), Some(Advice::OtherPower));
}

#[test]
fn powers_do_not_depend_on_the_transform_that_was_fitted() {
    for Surface { x, y, box_cox, .. } in answers().surfaces {
        let plain = quadratic(&x, &y).box_cox(None).unwrap();
        let logarithm = quadratic(&x, &logarithms(&y)).box_cox(Some(Transform::Logarithm)).unwrap();
        assert!((plain.power - box_cox[0]).abs() < 1e-5, "{plain:?} {box_cox:?}");
        for (at, end) in plain.interval.into_iter().enumerate() {
            same(end, box_cox[1 + at], "end");
            same(logarithm.interval[at], end, "the same of the transform");
        }
        assert_eq!(logarithm.advice(Some(Transform::Logarithm)), None, "the responses are logarithms of normal ones");
        // Of both transforms within the interval the nearer one.
        let is_nearer = box_cox[2] < 0.5 || box_cox[0] < 0.25;
        let nearer = if is_nearer { Transform::Logarithm } else { Transform::SquareRoot };
        let expected = if box_cox[2] > 1.0 { None } else { Some(Advice::Try(nearer)) };
        assert_eq!(plain.advice(None), expected, "{box_cox:?}");
    }
}

#[test]
fn forecasts_on_a_transformed_scale_are_those_of_statsmodels() {
    for surface in answers().surfaces {
        let effects = quadratic(&surface.x, &logarithms(&surface.y));
        let surrogate = PolynomialSurrogate::new("y", &effects, LOGARITHM);
        assert_eq!(surrogate.name(), "quadratic in log(y)");
        for Forecasts { confidence, numbers } in &surface.forecasts {
            for (at, expected) in surface.at.iter().zip(numbers) {
                let found = surrogate.forecast(&coded(at), *confidence).unwrap();
                let ends = [found.mean_interval, found.run_interval].map(Option::unwrap);
                let found = [found.value, ends[0][0], ends[0][1], ends[1][0], ends[1][1]];
                found.iter().zip(expected).for_each(|(found, expected)| same(*found, *expected, "forecast"));
            }
        }
        same(surrogate.leave_one_out_error().unwrap(), surface.leave_one_out, "leave one out");
        let standardised = effects.standardised_residuals().unwrap();
        standardised
            .iter()
            .zip(&surface.standardised)
            .for_each(|(found, expected)| same(*found, *expected, "residual"));
    }
}

#[test]
fn blocks_that_differ_are_a_part_of_the_uncertainty() {
    let Blocks { x, y, at, numbers } = answers().blocks;
    let mut observations = Vec::new();
    for (replicate, responses) in y.iter().enumerate() {
        for (x, response) in x.iter().zip(responses) {
            observations.push(Observation {
                settings: coded(x),
                replicate,
                run: observations.len(),
                response: *response,
            });
        }
    }
    let options = Options { model: Model::MainEffects, ..Options::default() };
    let effects = analyse(&ranges(2), &observations, &options).unwrap();
    let surrogate = PolynomialSurrogate::new("y", &effects, Scale::PLAIN);
    for (at, expected) in at.iter().zip(&numbers) {
        let found = surrogate.forecast(&coded(at), 0.95).unwrap();
        let ends = [found.mean_interval, found.run_interval].map(Option::unwrap);
        let found = [found.value, ends[0][0], ends[0][1], ends[1][0], ends[1][1]];
        found.iter().zip(expected).for_each(|(found, expected)| same(*found, *expected, "forecast"));
        // Figures show the same interval of the mean; that with the seeds of the runs is shorter.
        let given: Vec<(usize, Setting)> = coded(at).into_iter().enumerate().collect();
        let [low, high] = effects.mean_at(&given).unwrap().interval.unwrap();
        same(low, expected[1], "interval of the mean");
        same(high, expected[2], "interval of the mean");
        let [with_these, to_these] = effects.predict_at(&given).unwrap().interval.unwrap();
        assert!(low < with_these && to_these < high, "{low} {with_these} {to_these} {high}");
    }
}

/// A normal deviate, as the sum of twelve uniform ones less six would not be in the tails: by Box and Muller.
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    (-2.0 * (1.0 - uniform()).ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos()
}

#[test]
fn intervals_of_runs_with_new_seeds_hold_what_they_promise() {
    // Studies of a face-centred composite in four blocks by lot; one more run in a block of its own at a point between.
    let corners = [-1.0, 0.0, 1.0];
    let x: Vec<Vec<f64>> = corners.iter().flat_map(|a| corners.iter().map(move |b| vec![*a, *b])).collect();
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let truth = |x: &[f64]| 2.0 + x[0] - 0.5 * x[1] + 0.4 * x[0] * x[1] - 0.3 * x[1] * x[1];
    let at = [0.4, -0.6];
    let studies = 1000;
    for of_blocks in [0.0, 1.0] {
        let (mut runs, mut means) = (0, 0);
        for _ in 0..studies {
            let mut observations = Vec::new();
            for replicate in 0..4 {
                let shift = of_blocks * normal(&mut random);
                for x in &x {
                    let response = truth(x) + shift + 0.5 * normal(&mut random);
                    observations.push(Observation { settings: coded(x), replicate, run: observations.len(), response });
                }
            }
            let options = Options { model: Model::Quadratic, ..Options::default() };
            let effects = analyse(&ranges(2), &observations, &options).unwrap();
            let forecast = PolynomialSurrogate::new("y", &effects, Scale::PLAIN).forecast(&coded(&at), 0.95).unwrap();
            let new = truth(&at) + of_blocks * normal(&mut random) + 0.5 * normal(&mut random);
            let has = |interval: Option<[f64; 2]>, value: f64| {
                interval.is_some_and(|[low, high]| low <= value && value <= high)
            };
            let ([low, high], [run_low, run_high]) = (forecast.mean_interval.unwrap(), forecast.run_interval.unwrap());
            assert!(run_low <= low && high <= run_high, "one run is not known better than the mean of many");
            runs += usize::from(has(forecast.run_interval, new));
            means += usize::from(has(forecast.mean_interval, truth(&at)));
        }
        // Of 1000 studies a share of 95 % has a standard deviation of 0.7 %; Satterthwaite's degrees of freedom are right to
        // about one per cent of coverage with four blocks.
        for covered in [runs, means] {
            let share = covered as f64 / f64::from(studies);
            assert!((share - 0.95).abs() < 4.0 * 0.007 + 0.01, "{of_blocks}: {runs} and {means} of {studies}");
        }
    }
}

#[test]
fn the_terms_that_are_kept_are_the_best_of_all_choices() {
    for surface in answers().surfaces {
        let logarithms = logarithms(&surface.y);
        let options = Options { model: Model::Quadratic, ..Options::default() };
        let selection = select(&ranges(3), &observations(&surface.x, &logarithms), &options).unwrap();
        let kept: Vec<Vec<usize>> = selection.effects.terms.iter().map(|term| term.factors.clone()).collect();
        assert_eq!(kept, surface.kept);
        same(selection.aicc, surface.aicc, "AICc");
        same(selection.aicc_of_all.unwrap(), surface.aicc_of_all, "AICc of all terms");
        assert_eq!(selection.left_out.len() + kept.len(), 9);
        assert!(selection.effects.error.to_string().contains("what the model leaves out"));
    }
}

#[test]
fn a_model_with_more_terms_than_runs_can_be_chosen_from() {
    // Nine runs, ten coefficients: no model with all terms, but y = 1 + 2·x0 but for a little.
    let x: Vec<Vec<f64>> = (0..9)
        .map(|run| {
            vec![[-1.0, 0.0, 1.0][run % 3], [-1.0, 0.0, 1.0][run / 3], [1.0, -0.5, 0.3][(run * 2 + run / 3) % 3]]
        })
        .collect();
    let y: Vec<f64> =
        x.iter().enumerate().map(|(run, x)| 1.0 + 2.0 * x[0] + 0.01 * [1.0, -1.0, 0.5, 0.3][run % 4]).collect();
    let options = Options { model: Model::Quadratic, ..Options::default() };
    let selection = select(&ranges(3), &observations(&x, &y), &options).unwrap();
    assert_eq!(selection.aicc_of_all, None);
    assert!(selection.effects.terms.iter().any(|term| term.factors == [0]), "{:?}", selection.left_out);
    assert!(selection.effects.residual_standard_deviation.is_some());
}

/// The value of an equation where numbers and levels are these.
fn value(equation: &Equation, numbers: &[f64], levels: &[Option<usize>]) -> f64 {
    let factor = |variable: &Variable| match *variable {
        Variable::Number { factor } => numbers[factor],
        Variable::Level { factor, level } => f64::from(u8::from(levels[factor] == Some(level))),
    };
    equation.terms.iter().map(|term| term.coefficient * term.variables.iter().map(factor).product::<f64>()).sum()
}

#[test]
fn equations_give_what_is_predicted() {
    let factors = [
        Factor { name: "a".into(), kind: FactorKind::Range { low: 10.0, high: 30.0 } },
        Factor { name: "b".into(), kind: FactorKind::Categorical(["p", "q", "r"].map(String::from).to_vec()) },
        Factor { name: "c".into(), kind: FactorKind::Levels(vec![8.0, 2.0]) },
        Factor { name: "d".into(), kind: FactorKind::Categorical(["s", "t"].map(String::from).to_vec()) },
    ];
    let ends = [[10.0, 30.0], [0.0, 1.0], [2.0, 8.0], [0.0, 1.0]];
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut observations = Vec::new();
    for (a, b, c, d) in (0..36).map(|at| ([-1.0, 0.2, 1.0][at % 3], at / 3 % 3, at / 9 % 2, at / 18)) {
        let settings = vec![Setting::Coded(a), Setting::Level(b), Setting::Level(c), Setting::Level(d)];
        let response = 5.0 + a * (b as f64 - 1.0) + 3.0 * c as f64 * a + d as f64 + normal(&mut random);
        observations.push(Observation { settings, replicate: 0, run: observations.len(), response });
    }
    for model in [Model::MainEffects, Model::Interactions, Model::Full, Model::Quadratic] {
        let effects = analyse(&factors, &observations, &Options { model, ..Options::default() }).unwrap();
        let (coded, natural) = (effects.equation(None).unwrap(), effects.equation(Some(&ends)).unwrap());
        for observation in &observations {
            let predicted = effects.predict(&observation.settings).unwrap().value;
            let place = |factor: usize| factors[factor].coded(observation.settings[factor]).unwrap_or(0.0);
            let own = |factor: usize| factors[factor].value(observation.settings[factor]).unwrap_or(0.0);
            let levels: Vec<Option<usize>> = observation
                .settings
                .iter()
                .map(|setting| if let Setting::Level(level) = setting { Some(*level) } else { None })
                .collect();
            same(value(&coded, &(0..4).map(place).collect::<Vec<_>>(), &levels), predicted, "coded units");
            same(value(&natural, &(0..4).map(own).collect::<Vec<_>>(), &levels), predicted, "units of the factors");
        }
        // Of each product with levels the coefficients of all levels add up to zero.
        let sum: f64 = coded
            .terms
            .iter()
            .filter(|term| matches!(term.variables[..], [Variable::Level { factor: 1, .. }]))
            .map(|term| term.coefficient)
            .sum();
        assert!(sum.abs() < 1e-12, "{model:?}: {sum}");
    }
}

#[test]
fn between_two_levels_that_are_numbers_the_model_is_straight() {
    // y = 3 + 2·c, c from 1 to 5, the larger level first.
    let factors = [Factor { name: "c".into(), kind: FactorKind::Levels(vec![5.0, 1.0]) }];
    let points = [(0, 13.0), (1, 5.0), (0, 13.2), (1, 4.8)];
    let observation = |(run, (level, response)): (usize, (usize, f64))| Observation {
        settings: vec![Setting::Level(level)],
        replicate: 0,
        run,
        response,
    };
    let observations: Vec<Observation> = points.into_iter().enumerate().map(observation).collect();
    let effects = analyse(&factors, &observations, &Options::default()).unwrap();
    let surrogate = PolynomialSurrogate::new("y", &effects, Scale::PLAIN);
    let at = |coded: f64| surrogate.forecast(&[Setting::Coded(coded)], 0.95).unwrap().value;
    for (coded, expected) in [(-1.0, 4.9), (-0.5, 6.95), (0.0, 9.0), (1.0, 13.1)] {
        same(at(coded), expected, "between");
    }
    same(surrogate.forecast(&[Setting::Level(0)], 0.95).unwrap().value, 13.1, "the first level");
}
