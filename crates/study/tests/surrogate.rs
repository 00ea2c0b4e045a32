//! Gaussian processes and sensitivities beside those of other programs: `surrogate/expected.json`, which `make.py` there made,
//! and `surrogate/two_optima.json`, which `two_optima.py` made.

use plateau_study::design::Setting;
use plateau_study::effects::{Factor, FactorKind, Observation};
use plateau_study::sensitivity::{self, Values, elementary_effects};
use plateau_study::surrogate::Surrogate;
use plateau_study::surrogate::gaussian_process::{GaussianProcess, Hyperparameters, Options, Trend};
use serde::Deserialize;

/// What numbers have to agree to, relative to themselves: the equations of the worst case here have a condition of 1e7, which
/// leaves nine of the sixteen digits of a double.
const TOLERANCE: f64 = 1e-8;

#[derive(Deserialize)]
struct Expected {
    processes: Vec<Process>,
    replicates: Replicates,
    sobol: Sobol,
    morris: Morris,
}

#[derive(Deserialize)]
struct Process {
    name: String,
    points: Vec<Vec<f64>>,
    responses: Vec<f64>,
    linear: bool,
    lengths: Vec<f64>,
    noise: f64,
    log_likelihood: f64,
    coefficients: Vec<f64>,
    variance: f64,
    new: Vec<Vec<f64>>,
    means: Vec<f64>,
    variances: Vec<f64>,
    /// Forecast and variance of each point by the others.
    left_out: Vec<[f64; 2]>,
    /// The largest likelihood that was found.
    most_likely: f64,
}

/// Sets whose likelihood has two hills.
#[derive(Deserialize)]
struct TwoOptima {
    sets: Vec<TwoHills>,
}

#[derive(Deserialize)]
struct TwoHills {
    name: String,
    points: Vec<Vec<f64>>,
    responses: Vec<f64>,
    most_likely: f64,
}

#[derive(Deserialize)]
struct Replicates {
    points: Vec<Vec<f64>>,
    /// By point and seed.
    responses: Vec<Vec<f64>>,
    lengths: Vec<f64>,
    noise: f64,
    log_likelihood: f64,
    variance: f64,
    coefficient: f64,
}

#[derive(Deserialize)]
struct Sobol {
    a: Vec<f64>,
    b: Vec<f64>,
    mixed: Vec<Vec<f64>>,
    first: Vec<f64>,
    total: Vec<f64>,
}

#[derive(Deserialize)]
struct Morris {
    points: Vec<Vec<f64>>,
    responses: Vec<f64>,
    mean_sizes: Vec<f64>,
    means: Vec<f64>,
    deviations: Vec<f64>,
}

fn expected() -> Expected {
    serde_json::from_str(include_str!("surrogate/expected.json")).unwrap()
}

fn factors(count: usize) -> Vec<Factor> {
    let range = |at| Factor { name: format!("x{at}"), kind: FactorKind::Range { low: -1.0, high: 1.0 } };
    (0..count).map(range).collect()
}

fn coded(point: &[f64]) -> Vec<Setting> {
    point.iter().map(|coded| Setting::Coded(*coded)).collect()
}

/// One response for each point and seed.
fn observations(points: &[Vec<f64>], responses: &[Vec<f64>]) -> Vec<Observation> {
    let of_point = |(point, seeds): (&Vec<f64>, &Vec<f64>)| {
        let settings = coded(point);
        let observation = move |(replicate, response): (usize, &f64)| Observation {
            settings: settings.clone(),
            replicate,
            run: 0,
            response: *response,
        };
        seeds.iter().enumerate().map(observation).collect::<Vec<_>>()
    };
    let all = points.iter().zip(responses).flat_map(of_point);
    all.enumerate().map(|(run, observation)| Observation { run, ..observation }).collect()
}

/// Numbers are the same, relative to themselves or to a thousandth of the largest one.
fn same(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let largest = expected.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    for (found, expected) in found.iter().zip(expected) {
        let scale = expected.abs().max(1e-3 * largest);
        assert!((found - expected).abs() <= TOLERANCE * scale, "{what}: {found:e} is not {expected:e}");
    }
}

#[test]
fn processes_with_given_lengths_agree_with_scikit_learn_and_dicekriging() {
    for case in expected().processes {
        let name = &case.name;
        let trend = if case.linear { Trend::Linear } else { Trend::Constant };
        let fixed = Hyperparameters { lengths: case.lengths.clone(), noise: case.noise };
        let responses: Vec<Vec<f64>> = case.responses.iter().map(|response| vec![*response]).collect();
        let runs = observations(&case.points, &responses);
        let factors = factors(case.lengths.len());
        let options = Options { trend, fixed: Some(fixed), ..Options::default() };
        let process = GaussianProcess::fit(&factors, &runs, &options).unwrap();
        same(&[process.log_likelihood()], &[case.log_likelihood], &format!("likelihood of {name}"));
        same(&[process.process_variance()], &[case.variance], &format!("variance of {name}"));
        same(&process.trend_coefficients(), &case.coefficients, &format!("trend of {name}"));
        let local: Vec<_> = case.new.iter().map(|point| process.local(&coded(point)).unwrap()).collect();
        same(&local.iter().map(|local| local.mean).collect::<Vec<_>>(), &case.means, &format!("means of {name}"));
        let variances: Vec<f64> = local.iter().map(|local| local.variance).collect();
        same(&variances, &case.variances, &format!("variances of {name}"));
        let left_out = process.left_out();
        let forecasts: Vec<f64> = left_out.iter().map(|point| point.forecast).collect();
        same(
            &forecasts,
            &case.left_out.iter().map(|point| point[0]).collect::<Vec<_>>(),
            &format!("left out of {name}"),
        );
        let variances: Vec<f64> = left_out.iter().map(|point| point.variance).collect();
        same(
            &variances,
            &case.left_out.iter().map(|point| point[1]).collect::<Vec<_>>(),
            &format!("their variances, {name}"),
        );
        let squares = case.left_out.iter().zip(&case.responses).map(|([forecast, _], y)| (forecast - y).powi(2));
        let error = (squares.sum::<f64>() / case.responses.len() as f64).sqrt();
        same(&[process.leave_one_out_error().unwrap()], &[error], &format!("leave-one-out error of {name}"));
    }
}

#[test]
fn no_likelier_lengths_are_found_by_forty_searches_of_scipy() {
    for case in expected().processes {
        let trend = if case.linear { Trend::Linear } else { Trend::Constant };
        is_as_likely(&case.name, &case.points, &case.responses, trend, case.most_likely);
    }
}

#[test]
fn the_higher_of_two_hills_is_found() {
    let sets: TwoOptima = serde_json::from_str(include_str!("surrogate/two_optima.json")).unwrap();
    for case in sets.sets {
        is_as_likely(&case.name, &case.points, &case.responses, Trend::Constant, case.most_likely);
    }
}

/// The most likely lengths are as likely as these.
fn is_as_likely(name: &str, points: &[Vec<f64>], responses: &[f64], trend: Trend, most_likely: f64) {
    let responses: Vec<Vec<f64>> = responses.iter().map(|response| vec![*response]).collect();
    let runs = observations(points, &responses);
    let options = Options { trend, ..Options::default() };
    let process = GaussianProcess::fit(&factors(points[0].len()), &runs, &options).unwrap();
    // Both end where steps bring less than 1e-5 or so.
    let found = process.log_likelihood();
    assert!(found >= most_likely - 1e-4, "{name}: {found} is less than {most_likely}");
}

#[test]
fn replicates_are_as_likely_as_all_their_runs() {
    let case = expected().replicates;
    let fixed = Hyperparameters { lengths: case.lengths.clone(), noise: case.noise };
    let options = Options { fixed: Some(fixed), ..Options::default() };
    let runs = observations(&case.points, &case.responses);
    let process = GaussianProcess::fit(&factors(2), &runs, &options).unwrap();
    same(&[process.log_likelihood()], &[case.log_likelihood], "likelihood");
    same(&[process.process_variance()], &[case.variance], "variance");
    same(&process.trend_coefficients(), &[case.coefficient], "mean");
}

#[test]
fn indices_from_a_sample_agree_with_salib() {
    let case = expected().sobol;
    let values = Values { a: case.a, b: case.b, mixed: case.mixed };
    let options = sensitivity::Options { resamples: 0, ..sensitivity::Options::default() };
    let found = sensitivity::indices(&values, &options).unwrap();
    same(&found.first.iter().map(|index| index.value).collect::<Vec<_>>(), &case.first, "first order");
    same(&found.total.iter().map(|index| index.value).collect::<Vec<_>>(), &case.total, "total");
}

#[test]
fn elementary_effects_agree_with_salib() {
    let case = expected().morris;
    // SALib has the range from 0 to 1, here it is coded from −1 to 1; effects are per whole range in both.
    let points = case.points.iter().map(|point| coded(&point.iter().map(|x| 2.0 * x - 1.0).collect::<Vec<_>>()));
    let points: Vec<(Vec<Setting>, f64)> = points.zip(case.responses).collect();
    let found = elementary_effects(&factors(3), &points);
    assert!(found.iter().all(|effect| effect.count == 6));
    same(&found.iter().map(|effect| effect.mean_size).collect::<Vec<_>>(), &case.mean_sizes, "mean sizes");
    same(&found.iter().map(|effect| effect.mean).collect::<Vec<_>>(), &case.means, "means");
    same(&found.iter().map(|effect| effect.deviation).collect::<Vec<_>>(), &case.deviations, "deviations");
}
