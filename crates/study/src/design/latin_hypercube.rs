//! Latin hypercubes: every range in as many strata as there are points, each stratum with one point.
//!
//! M. D. McKay, R. J. Beckman, W. J. Conover, A comparison of three methods for selecting values of input variables in
//! the analysis of output from a computer code, Technometrics 21, 239–245 (1979), doi:10.2307/1268522. Of several such
//! designs the one is taken whose nearest points are farthest apart: M. E. Johnson, L. M. Moore, D. Ylvisaker, Minimax
//! and maximin distance designs, J. Stat. Plan. Inference 26, 131–148 (1990), doi:10.1016/0378-3758(90)90122-B.

use rand_chacha::ChaCha12Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::definition::{Design, DesignError, Factor, room, spread};

/// Most designs to choose from.
const MOST_CANDIDATES: usize = 200;
/// Differences of coordinates that the choice may cost: some tenths of a second.
const MOST_DIFFERENCES: usize = 100_000_000;

/// The best of some random hypercubes; equal seeds give equal designs on every machine.
pub(super) fn latin_hypercube(points: usize, seed: u64, factors: &[Factor]) -> Result<Design, DesignError> {
    if points == 0 {
        return Err(DesignError("a Latin hypercube has at least one point".into()));
    }
    let count = factors.len();
    room(Some(points), count)?;
    let mut random = Random::new(seed);
    let mut best = hypercube(points, count, &mut random);
    let candidates = candidates(points, count);
    if candidates > 1 {
        let mut largest = nearest(&best, count, 0.0);
        for _ in 1..candidates {
            let candidate = hypercube(points, count, &mut random);
            let distance = nearest(&candidate, count, largest);
            if distance > largest {
                (best, largest) = (candidate, distance);
            }
        }
    }
    let settings =
        best.chunks(count).flat_map(|point| factors.iter().zip(point)).map(|(factor, at)| spread(factor, *at));
    Design::from_settings(count, settings.collect(), None)
}

/// Number of hypercubes to choose from: fewer where many points, one where even two would take long.
fn candidates(points: usize, factors: usize) -> usize {
    let differences = points.saturating_mul(points).saturating_mul(factors) / 2;
    (MOST_DIFFERENCES / differences.max(1)).clamp(1, MOST_CANDIDATES)
}

/// A random hypercube, point by point, in the unit cube.
fn hypercube(points: usize, factors: usize, random: &mut Random) -> Vec<f64> {
    let mut cube = vec![0.0; points * factors];
    let mut strata: Vec<usize> = (0..points).collect();
    for factor in 0..factors {
        // Fisher and Yates.
        for last in (1..points).rev() {
            strata.swap(last, random.below(last + 1));
        }
        for (point, stratum) in strata.iter().enumerate() {
            cube[point * factors + factor] = (*stratum as f64 + random.inside()) / points as f64;
        }
    }
    cube
}

/// Square of the least distance between two points; where that is less than `enough`, any number less than that.
fn nearest(cube: &[f64], factors: usize, enough: f64) -> f64 {
    let points: Vec<&[f64]> = cube.chunks(factors).collect();
    let mut least = f64::INFINITY;
    for (index, one) in points.iter().enumerate() {
        for other in &points[..index] {
            least = one.iter().zip(*other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().min(least);
        }
        if least < enough {
            break;
        }
    }
    least
}

/// Random numbers that are the same on every machine.
struct Random(ChaCha12Rng);

impl Random {
    fn new(seed: u64) -> Self {
        // The key is spelt out because `seed_from_u64` may change with the version of the crate.
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        Self(ChaCha12Rng::from_seed(key))
    }

    /// One of 0 … bound − 1; probabilities differ by bound / 2⁶⁴.
    fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.0.next_u64()) * bound as u128) >> u64::BITS) as usize
    }

    /// Strictly between 0 and 1, in the middle of one of 2²⁴ equal parts, so that no rounding leads out of a stratum.
    fn inside(&mut self) -> f64 {
        ((self.0.next_u64() >> 40) as f64 + 0.5) / f64::from(1_u32 << 24)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Setting;

    #[test]
    fn every_stratum_has_one_point() {
        // The definition.
        for (points, factors) in [(1, 1), (2, 3), (10, 4), (101, 7), (5000, 2)] {
            let design = latin_hypercube(points, 3, &vec![Factor::Range; factors]).unwrap();
            for factor in 0..factors {
                let mut strata: Vec<usize> = (0..points)
                    .map(|point| match design.point(point)[factor] {
                        Setting::Coded(at) => ((at + 1.0) / 2.0 * points as f64) as usize,
                        Setting::Level(_) => usize::MAX,
                    })
                    .collect();
                strata.sort();
                assert_eq!(strata, (0..points).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn levels_get_equal_shares() {
        // By hand: 12 strata in 3 and 4 levels.
        let design = latin_hypercube(12, 1, &[Factor::Levels(3), Factor::Levels(4)]).unwrap();
        for (factor, levels) in [(0, 3), (1, 4)] {
            for level in 0..levels {
                let share = (0..12).filter(|point| design.point(*point)[factor] == Setting::Level(level)).count();
                assert_eq!(share, 12 / levels);
            }
        }
    }

    #[test]
    fn equal_seeds_give_equal_designs_and_others_do_not() {
        let of = |seed| latin_hypercube(20, seed, &[Factor::Range; 3]).unwrap();
        assert_eq!(of(7), of(7));
        assert_ne!(of(7), of(8));
    }

    #[test]
    fn the_choice_keeps_points_apart() {
        let mut random = Random::new(5);
        let mut distances: Vec<f64> = (0..400).map(|_| nearest(&hypercube(20, 3, &mut random), 3, 0.0)).collect();
        distances.sort_by(f64::total_cmp);
        let mut random = Random::new(6);
        let cubes: Vec<Vec<f64>> = (0..MOST_CANDIDATES).map(|_| hypercube(20, 3, &mut random)).collect();
        let best = cubes.iter().map(|cube| nearest(cube, 3, 0.0)).fold(0.0, f64::max);
        let design = latin_hypercube(20, 6, &[Factor::Range; 3]).unwrap();
        let unit: Vec<f64> = (0..20)
            .flat_map(|point| design.point(point).to_vec())
            .map(|setting| if let Setting::Coded(at) = setting { (at + 1.0) / 2.0 } else { f64::NAN })
            .collect();
        // The best of 200 is below the median of others in one of 2²⁰⁰ cases only.
        assert!((nearest(&unit, 3, 0.0) - best).abs() < 1e-12 && best > distances[200]);
    }

    #[test]
    fn large_hypercubes_are_quick_and_empty_ones_refused() {
        assert_eq!(candidates(100_000, 5), 1);
        assert_eq!(candidates(usize::MAX, 5), 1);
        assert_eq!(candidates(30, 5), MOST_CANDIDATES);
        assert!(latin_hypercube(0, 1, &[Factor::Range]).is_err());
        assert!(latin_hypercube(10_000_001, 1, &[Factor::Range]).is_err());
    }
}
