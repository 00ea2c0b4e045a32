//! Smooth responses that are known, made by lot, and how often the intervals of a Gaussian process have them in them.
//!
//! A response is smooth as Gaussian processes are (a sum of cosines with random frequencies, the spectrum of the squared
//! exponential or of Matérn's correlation of ν = 5/2; A. Rahimi, B. Recht, NIPS 20, 2007), or it is what responses of runs often
//! are: a product of powers, or one that comes to an end. Each run has chance besides, some of which its seed adds everywhere.

use plateau_study::design::{self, Kind, Setting, design};
use plateau_study::effects::{Factor, FactorKind, Observation};
use plateau_study::surrogate::Surrogate;
use plateau_study::surrogate::gaussian_process::{GaussianProcess, Options};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use statrs::distribution::{ContinuousCDF, Normal};

/// Cosines of a sum.
const COSINES: usize = 300;
/// Places at which a process is asked.
const PLACES: usize = 25;
/// Standard deviation of chance from run to run, as a part of that of the response.
const CHANCE: f64 = 0.04;
/// The same of what a seed adds everywhere.
const OF_SEED: f64 = 0.02;

/// A response at coded settings.
type Response = Box<dyn Fn(&[f64]) -> f64>;

/// How smooth responses are.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Smoothness {
    /// Any number of derivatives.
    SquaredExponential,
    /// Two derivatives.
    Matern,
    /// A product of powers.
    Powers,
    /// A sigmoid of a sum.
    Saturating,
}

/// A kind of study.
pub struct Case {
    /// What its responses are.
    pub name: &'static str,
    smoothness: Smoothness,
    /// Number of factors.
    pub factors: usize,
    /// Number of points.
    pub points: usize,
    /// Number of sets of seeds.
    pub seeds: usize,
}

/// The studies that are made.
pub fn cases() -> Vec<Case> {
    let case = |name, smoothness, factors, points, seeds| Case { name, smoothness, factors, points, seeds };
    vec![
        case("very smooth", Smoothness::SquaredExponential, 2, 10, 2),
        case("very smooth", Smoothness::SquaredExponential, 4, 20, 2),
        case("very smooth", Smoothness::SquaredExponential, 4, 40, 2),
        case("smooth", Smoothness::Matern, 3, 15, 1),
        case("smooth", Smoothness::Matern, 4, 20, 2),
        case("product of powers", Smoothness::Powers, 4, 20, 2),
        case("comes to an end", Smoothness::Saturating, 4, 20, 2),
    ]
}

impl Case {
    /// Makes so many functions and counts: shares of intervals of means and of runs that have the truth in them, and of means
    /// where the most likely lengths are taken for certain.
    ///
    /// # Errors
    /// What is wrong with the design or the process; nothing, as they stand here.
    pub fn coverage(&self, functions: usize) -> Result<[f64; 3], Box<dyn std::error::Error>> {
        let range = |at| Factor { name: format!("x{at}"), kind: FactorKind::Range { low: -1.0, high: 1.0 } };
        let factors: Vec<Factor> = (1..=self.factors).map(range).collect();
        let mut random = Random(ChaCha8Rng::seed_from_u64(20_261_124));
        let mut covered = [0_usize; 3];
        for function in 0..functions {
            let kind = Kind::LatinHypercube { points: self.points, seed: function as u64 };
            let design = design(&kind, &vec![design::Factor::Range; self.factors])?;
            let response = self.response(&mut random);
            let of_seed: Vec<f64> = (0..self.seeds).map(|_| OF_SEED * random.normal()).collect();
            let mut observations = Vec::new();
            for point in 0..design.points() {
                let settings = design.point(point).to_vec();
                let place: Vec<f64> = settings.iter().map(|setting| coded(*setting)).collect();
                for (replicate, share) in of_seed.iter().enumerate() {
                    let run = point * self.seeds + replicate;
                    let response = response(&place) + share + CHANCE * random.normal();
                    observations.push(Observation { settings: settings.clone(), replicate, run, response });
                }
            }
            let certain = GaussianProcess::fit(&factors, &observations, &Options::default())?;
            let process = certain.clone().with_likely_lengths();
            for _ in 0..PLACES {
                let place: Vec<f64> = (0..self.factors).map(|_| 2.0 * random.uniform() - 1.0).collect();
                let settings: Vec<Setting> = place.iter().map(|coded| Setting::Coded(*coded)).collect();
                let truth = response(&place);
                let run = truth + OF_SEED * random.normal() + CHANCE * random.normal();
                let (forecast, of_certain) = (process.forecast(&settings, 0.95)?, certain.forecast(&settings, 0.95)?);
                let pairs =
                    [(forecast.mean_interval, truth), (forecast.run_interval, run), (of_certain.mean_interval, truth)];
                for (count, (interval, value)) in covered.iter_mut().zip(pairs) {
                    *count += usize::from(interval.is_some_and(|[low, high]| (low..=high).contains(&value)));
                }
            }
        }
        Ok(covered.map(|count| count as f64 / (functions * PLACES) as f64))
    }

    /// A function by lot, with a standard deviation of about one over the ranges.
    fn response(&self, random: &mut Random) -> Response {
        // Half a range to some ranges.
        let lengths: Vec<f64> = (0..self.factors).map(|_| 1.0 + 4.0 * random.uniform()).collect();
        let slopes: Vec<f64> = (0..self.factors).map(|_| random.normal()).collect();
        let size = slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt();
        match self.smoothness {
            Smoothness::Powers => {
                Box::new(move |x| (x.iter().zip(&slopes).map(|(x, slope)| x * slope).sum::<f64>() * 0.6).exp() / size)
            }
            Smoothness::Saturating => Box::new(move |x| {
                2.0 * (2.0 * x.iter().zip(&slopes).map(|(x, slope)| x * slope).sum::<f64>() / size + 0.5).tanh()
            }),
            Smoothness::SquaredExponential | Smoothness::Matern => {
                let is_rough = self.smoothness == Smoothness::Matern;
                let mut cosines = Vec::new();
                for _ in 0..COSINES {
                    // The spectrum of Matérn's correlation is Student's t of 2ν = 5 degrees of freedom along each axis.
                    let frequency = lengths.iter().map(|length| {
                        let divisor: f64 = (0..5).map(|_| random.normal().powi(2)).sum::<f64>() / 5.0;
                        random.normal() / (if is_rough { divisor.sqrt() } else { 1.0 }) / length
                    });
                    let frequency: Vec<f64> = frequency.collect();
                    cosines.push((frequency, std::f64::consts::TAU * random.uniform()));
                }
                let scale = (2.0 / COSINES as f64).sqrt();
                Box::new(move |x| {
                    let cosine = |(frequency, phase): &(Vec<f64>, f64)| {
                        (x.iter().zip(frequency).map(|(x, by)| x * by).sum::<f64>() + phase).cos()
                    };
                    scale * cosines.iter().map(cosine).sum::<f64>()
                })
            }
        }
    }
}

fn coded(setting: Setting) -> f64 {
    match setting {
        Setting::Level(level) => 2.0 * level as f64 - 1.0,
        Setting::Coded(coded) => coded,
    }
}

/// Deviates.
struct Random(ChaCha8Rng);

impl Random {
    fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        Normal::standard().inverse_cdf(self.uniform())
    }
}
