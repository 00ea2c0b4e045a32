//! Experiments that never took place: keys are drawn by lot, an analytic function with noise between seeds stands for the runs,
//! and what is "measured" is its value at these keys with an error. Each is fitted as `plateau fit` does it, and the true keys
//! are in region and intervals, or not.

use plateau_study::design::{Factor, Kind, Setting, design};
use plateau_study::effects::Observation;
use plateau_study::fit::{Fit, FitError, Key, Measurement};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Sets of seeds.
const SEEDS: usize = 2;
/// Points of the first runs, and of each round after.
const FIRST: usize = 12;
const AT_A_TIME: usize = 4;
/// Most runs.
const MOST_RUNS: usize = 60;
/// 95 % of χ² with two degrees of freedom are below this: −2 ln 0.05.
const REGION: f64 = 5.991_464_547_107_98;

/// How often the truth was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coverage {
    /// Experiments.
    pub trials: usize,
    /// Those whose region of 95 % has the true keys in it.
    pub regions: usize,
    /// Intervals of 95 % that have the true key in them, of both keys.
    pub intervals: usize,
    /// Mean number of runs that a fit took.
    pub mean_runs: f64,
    /// Fits that ended before the budget.
    pub settled: usize,
}

/// Numbers that look like chance, the same each time.
struct Lot(ChaCha8Rng);

impl Lot {
    /// Even between 0 and 1.
    fn even(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Standard normal, by Box and Muller.
    fn normal(&mut self) -> f64 {
        let (one, other) = (1.0 - self.even(), self.even());
        (-2.0 * libm::log(one)).sqrt() * libm::cos(std::f64::consts::TAU * other)
    }
}

/// The keys.
pub fn keys() -> [Key; 2] {
    [
        Key { name: "fraction".into(), low: 0.01, high: 1.0, logarithmic: true },
        Key { name: "load".into(), low: 2.0, high: 10.0, logarithmic: false },
    ]
}

/// What a run without noise gives: one response that saturates, one that is a power with an interaction, and one that curves.
fn responses([fraction, load]: [f64; 2]) -> [f64; 3] {
    let filled = 1.0 - libm::exp(-1.5 * libm::pow(fraction, 0.6) * libm::pow(load, 0.4));
    let worn = 0.2 * load * (1.0 + 0.5 * fraction);
    let area = 1.0 + libm::log(load) * libm::sqrt(fraction);
    [filled, worn, area]
}

/// Uncertainties of the measurements, and noise of a run for its point and for its seed.
const UNCERTAINTIES: [f64; 3] = [0.02, 0.06, 0.06];
const NOISE: [[f64; 2]; 3] = [[0.004, 0.004], [0.01, 0.01], [0.015, 0.01]];

/// Runs: the same key and seed give the same response.
struct Runs {
    of_seeds: Vec<[f64; 3]>,
    lot: Lot,
    points: Vec<Vec<f64>>,
    observations: Vec<Vec<Observation>>,
}

impl Runs {
    fn new(mut lot: Lot) -> Self {
        let share = |lot: &mut Lot| std::array::from_fn(|response| NOISE[response][1] * lot.normal());
        let of_seeds = (0..SEEDS).map(|_| share(&mut lot)).collect();
        Self { of_seeds, lot, points: Vec::new(), observations: vec![Vec::new(); 3] }
    }

    fn make(&mut self, place: Vec<f64>) {
        let keys = keys();
        let exact = responses([0, 1].map(|at| keys[at].value(place[at])));
        for seed in 0..SEEDS {
            for response in 0..3 {
                let noise = self.of_seeds[seed][response] + NOISE[response][0] * self.lot.normal();
                self.observations[response].push(Observation {
                    settings: place.iter().map(|coded| Setting::Coded(*coded)).collect(),
                    replicate: seed,
                    run: self.points.len() * SEEDS + seed,
                    response: exact[response] + noise,
                });
            }
        }
        self.points.push(place);
    }
}

/// The coverage in so many experiments.
///
/// # Errors
/// Those of [`Fit::new`].
pub fn coverage(trials: usize) -> Result<Coverage, FitError> {
    let mut coverage = Coverage { trials, regions: 0, intervals: 0, mean_runs: 0.0, settled: 0 };
    for trial in 0..trials {
        let mut lot = Lot(ChaCha8Rng::seed_from_u64(trial as u64));
        let keys = keys();
        // In the inner four fifths of the ranges, so that what is beyond an end is not all there is of a region.
        let place: Vec<f64> = (0..2).map(|_| 1.6 * lot.even() - 0.8).collect();
        let truth = [0, 1].map(|at| keys[at].value(place[at]));
        let exact = responses(truth);
        let measurements: Vec<Measurement> = (0..3)
            .map(|at| Measurement {
                value: exact[at] + UNCERTAINTIES[at] * lot.normal(),
                uncertainty: UNCERTAINTIES[at],
            })
            .collect();
        let mut runs = Runs::new(lot);
        let first = design(&Kind::Sobol { points: FIRST }, &[Factor::Range; 2]).expect("a Sobol design of two factors");
        for point in 0..FIRST {
            let coded = |setting: &Setting| if let Setting::Coded(coded) = setting { *coded } else { 0.0 };
            runs.make(first.point(point).iter().map(coded).collect());
        }
        let mut shares = Vec::new();
        let fit = loop {
            let fit = Fit::new(&keys, &measurements, &runs.observations, 0.95)?;
            let affordable = MOST_RUNS / SEEDS - runs.points.len();
            let next = fit.next_points(AT_A_TIME.min(affordable), SEEDS);
            if fit.is_settled() || next.is_empty() || !fit.is_worth_more(&shares, affordable, SEEDS) {
                break fit;
            }
            shares.push(fit.surrogate_share());
            next.into_iter().for_each(|place| runs.make(place));
        };
        let result = fit.result();
        coverage.regions += usize::from(fit.rise(&truth) <= REGION);
        for (profile, truth) in result.profiles.iter().zip(truth) {
            let is_in = profile.pieces.iter().any(|piece| piece.ends[0] <= truth && truth <= piece.ends[1]);
            coverage.intervals += usize::from(is_in);
        }
        coverage.settled += usize::from(result.settled);
        coverage.mean_runs += (runs.points.len() * SEEDS) as f64 / trials as f64;
    }
    Ok(coverage)
}
