//! Studies whose effects are known, made by lot.
//!
//! A response is a polynomial of the factors with known coefficients, more by what the seed of its replicate adds and by
//! what is left to chance. Chance is that of a program that computes: it depends on the point and the seed, and a point
//! that is there twice gives the same response twice.

use plateau_study::design::{self, Alpha, Fraction, Kind, Setting, design};
use plateau_study::effects::{Factor, FactorKind, Model, Observation, Options, analyse};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use statrs::distribution::{ContinuousCDF, Normal};

/// A kind of study.
pub struct Case {
    /// What it is called.
    pub name: &'static str,
    kind: Kind,
    factors: usize,
    seeds: usize,
    model: Model,
}

/// How often intervals of 95 % have the true effect in them.
#[derive(Debug, Clone, Copy)]
pub struct Coverage {
    /// Runs of a study.
    pub runs: usize,
    /// Those that differ from each other.
    pub different: usize,
    /// Share of the effects' intervals, and its standard error.
    pub share: [f64; 2],
    /// The share if runs that repeat another one were taken for replicates.
    pub if_repeated: f64,
}

/// The studies that are made.
pub fn cases() -> Vec<Case> {
    let case = |name, kind, factors, seeds, model| Case { name, kind, factors, seeds, model };
    let composite = Kind::CentralComposite { alpha: Alpha::Rotatable, centre: [3, 3] };
    vec![
        case("full factorial 2⁴, 3 seeds", Kind::FullFactorial, 4, 3, Model::Interactions),
        case("fraction 2⁵⁻¹, 2 seeds", Kind::FractionalFactorial(Fraction::Resolution(5)), 5, 2, Model::Interactions),
        case("Plackett-Burman, 8 factors", Kind::PlackettBurman, 8, 1, Model::MainEffects),
        case("central composite, 3 factors, 6 centre points", composite, 3, 1, Model::Quadratic),
        case(
            "Box-Behnken, 4 factors, 5 centre points, 2 seeds",
            Kind::BoxBehnken { centre: 5 },
            4,
            2,
            Model::Quadratic,
        ),
        case(
            "Latin hypercube, 4 factors, 30 points",
            Kind::LatinHypercube { points: 30, seed: 1 },
            4,
            1,
            Model::Quadratic,
        ),
    ]
}

impl Case {
    /// Makes so many studies and counts.
    ///
    /// # Errors
    /// What is wrong with the design or the analysis; nothing, as they stand here.
    pub fn coverage(&self, studies: usize) -> Result<Coverage, Box<dyn std::error::Error>> {
        let design = design(&self.kind, &vec![design::Factor::Range; self.factors])?;
        let points: Vec<Vec<f64>> = (0..design.points())
            .map(|point| design.point(point).iter().map(|setting| coded(*setting)).collect())
            .collect();
        // Points that were there before are the same run.
        let first = |point: &Vec<f64>| points.iter().position(|other| other == point).unwrap_or(0);
        let firsts: Vec<usize> = points.iter().map(first).collect();
        let factors: Vec<Factor> = (1..=self.factors)
            .map(|factor| Factor { name: format!("x{factor}"), kind: FactorKind::Range { low: -1.0, high: 1.0 } })
            .collect();
        let options = Options { model: self.model, ..Options::default() };
        let mut random = Normals(ChaCha8Rng::seed_from_u64(20_261_122));
        let (mut sum, mut of_squares, mut if_repeated) = (0.0, 0.0, 0.0);
        for _ in 0..studies {
            let terms: Vec<(Vec<usize>, f64)> =
                terms(self.model, self.factors).into_iter().map(|term| (term, random.next())).collect();
            let of_seed: Vec<f64> = (0..self.seeds).map(|_| random.next()).collect();
            let chance: Vec<f64> = (0..points.len() * self.seeds).map(|_| random.next()).collect();
            let value = |point: &[f64]| -> f64 {
                terms
                    .iter()
                    .map(|(term, coefficient)| coefficient * term.iter().map(|x| point[*x]).product::<f64>())
                    .sum()
            };
            let observation = |place: usize| {
                let (point, replicate) = (place / self.seeds, place % self.seeds);
                let run = firsts[point] * self.seeds + replicate;
                let settings = points[point].iter().map(|x| Setting::Coded(*x)).collect();
                let response = value(&points[point]) + of_seed[replicate] + chance[run];
                Observation { settings, replicate, run, response }
            };
            let mut observations: Vec<Observation> = (0..points.len() * self.seeds).map(observation).collect();
            let share = |observations: &[Observation]| -> Result<f64, Box<dyn std::error::Error>> {
                let effects = analyse(&factors, observations, &options)?;
                let intervals = effects.terms.iter().filter_map(|term| {
                    let [low, high] = term.estimate?.uncertainty?.interval;
                    let (_, coefficient) = terms.iter().find(|(factors, _)| *factors == term.factors)?;
                    Some((low..=high).contains(&(2.0 * coefficient)))
                });
                let covered: Vec<bool> = intervals.collect();
                Ok(covered.iter().filter(|covered| **covered).count() as f64 / terms.len() as f64)
            };
            let covered = share(&observations)?;
            sum += covered;
            of_squares += covered * covered;
            observations.iter_mut().enumerate().for_each(|(place, observation)| observation.run = place);
            if_repeated += share(&observations)?;
        }
        let count = studies as f64;
        let mean = sum / count;
        let error = ((of_squares / count - mean * mean) / count).sqrt();
        let mut different = firsts.clone();
        different.sort_unstable();
        different.dedup();
        Ok(Coverage {
            runs: points.len() * self.seeds,
            different: different.len() * self.seeds,
            share: [mean, error],
            if_repeated: if_repeated / count,
        })
    }
}

/// The terms of a model of numbers.
fn terms(model: Model, factors: usize) -> Vec<Vec<usize>> {
    let single = (0..factors).map(|factor| vec![factor]);
    let pairs = (0..factors).flat_map(|one| (one + 1..factors).map(move |other| vec![one, other]));
    let squares = (0..factors).map(|factor| vec![factor, factor]);
    match model {
        Model::MainEffects => single.collect(),
        Model::Quadratic => single.chain(pairs).chain(squares).collect(),
        Model::Interactions | Model::Full => single.chain(pairs).collect(),
    }
}

fn coded(setting: Setting) -> f64 {
    match setting {
        Setting::Level(level) => 2.0 * level as f64 - 1.0,
        Setting::Coded(coded) => coded,
    }
}

/// Normal deviates.
struct Normals(ChaCha8Rng);

impl Normals {
    fn next(&mut self) -> f64 {
        let uniform = ((self.0.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64;
        Normal::standard().inverse_cdf(uniform)
    }
}
