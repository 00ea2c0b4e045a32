//! Regions and intervals of fits have the true keys in them as often as they say: a part of the simulation in
//! `examples/fit_coverage`, which says what is simulated.

#[path = "../examples/fit_coverage/simulation.rs"]
mod simulation;

use plateau_study::design::{Factor, Kind, Setting, design};
use plateau_study::fit::{Fit, Key, MeasuredSeries, ObservedSeries};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Series a (1 − exp(−t/b)) with errors that are alike for a time. Told of that time, regions of 95 % hold what they promise; told
/// that errors are independent, they do not, and the correlation of successive deviations shows it.
#[test]
fn regions_of_series_hold_what_they_promise_where_the_correlation_time_is_true() {
    const ALIKE: f64 = 3.0;
    let trials = if std::env::var_os("PLATEAU_LONG").is_some() { 400 } else { 40 };
    let keys = [("a", 1.0, 3.0), ("b", 2.0, 10.0)];
    let keys = keys.map(|(name, low, high)| Key { name: name.into(), low, high, logarithmic: false });
    let times: Vec<f64> = (1..=24).map(f64::from).collect();
    let curve = |a: f64, b: f64| times.iter().map(|t| a * (1.0 - libm::exp(-t / b))).collect::<Vec<f64>>();
    let points = design(&Kind::Sobol { points: 25 }, &[Factor::Range, Factor::Range]).unwrap();
    let run = |run: usize| {
        let settings = points.point(run).to_vec();
        let at = |key: usize| if let Setting::Coded(coded) = settings[key] { keys[key].value(coded) } else { f64::NAN };
        let values = curve(at(0), at(1));
        ObservedSeries { settings, replicate: 0, run, values }
    };
    let runs: Vec<ObservedSeries> = (0..points.points()).map(run).collect();
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut even = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let (mut found, mut too_short) = (0, 0);
    for _ in 0..trials {
        let truth = [1.4 + 1.2 * even(), 3.0 + 5.0 * even()];
        let mut normal = || (-2.0 * libm::log(1.0 - even())).sqrt() * libm::cos(std::f64::consts::TAU * even());
        let rho = libm::exp(-1.0 / ALIKE);
        let mut error = normal();
        let mut measured = Vec::new();
        for value in curve(truth[0], truth[1]) {
            measured.push(value + 0.1 * error);
            error = rho * error + (1.0 - rho * rho).sqrt() * normal();
        }
        let rise = |alike: f64| {
            let series = MeasuredSeries::new(times.clone(), measured.clone(), vec![0.1; 24], alike).unwrap();
            Fit::with_series(&keys, &[], &[], &[(series, runs.clone())], 0.95).unwrap().rise(&truth)
        };
        // −2 ln 0.05: 95 % of χ² with two degrees of freedom are below it.
        found += usize::from(rise(ALIKE) < 5.991_464_547_107_98);
        too_short += usize::from(rise(0.0) < 5.991_464_547_107_98);
    }
    let [found, too_short] = [found, too_short].map(|count| count as f64 / f64::from(trials));
    println!("{found} with the correlation time, {too_short} without");
    // Of 40 trials at 95 %, three standard errors are 10 %.
    let tolerance = if trials == 400 { 0.035 } else { 0.10 };
    assert!((found - 0.95).abs() <= tolerance, "{found}");
    assert!(too_short < 0.80, "{too_short}");
}

#[test]
fn fits_find_the_truth_as_often_as_they_say() {
    let long = std::env::var_os("PLATEAU_LONG").is_some();
    let trials = if long { 400 } else { 40 };
    let found = simulation::coverage(trials).unwrap();
    let [regions, intervals] = [found.regions as f64 / trials as f64, found.intervals as f64 / (2 * trials) as f64];
    // Of 40 trials at 95 %, three standard errors of √(0.95 · 0.05/40) are 10 %; of 400 they are 3.3 %.
    let tolerance = if long { 0.05 } else { 0.10 };
    assert!((regions - 0.95).abs() <= tolerance && (intervals - 0.95).abs() <= tolerance, "{found:?}");
    // The fits end when they know enough, not when the budget does.
    assert!(found.settled * 2 > trials, "{found:?}");
}
