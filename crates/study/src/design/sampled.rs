//! Designs that sample ranges: Latin hypercubes, Sobol's sequence, Morris's trajectories.
//!
//! A Latin hypercube divides every range into as many strata as there are points, each stratum with one point: M. D. McKay, R. J. Beckman,
//! W. J. Conover, A comparison of three methods for selecting values of input variables in the analysis of output from a computer code,
//! Technometrics 21, 239–245 (1979), doi:10.2307/1268522. Of several such designs the one is taken whose nearest points are farthest apart:
//! M. E. Johnson, L. M. Moore, D. Ylvisaker, Minimax and maximin distance designs, J. Stat. Plan. Inference 26, 131–148 (1990),
//! doi:10.1016/0378-3758(90)90122-B.
//!
//! Sobol's sequence fills the ranges evenly, the more points the finer: I. M. Sobol', On the distribution of points in a cube and the
//! approximate evaluation of integrals, USSR Comput. Math. Math. Phys. 7(4), 86–112 (1967), doi:10.1016/0041-5553(67)90144-9; in the order
//! of the Gray code: I. A. Antonov, V. M. Saleev, ibid. 19(1), 252–256 (1979), doi:10.1016/0041-5553(79)90085-5.
//!
//! Trajectories of Morris have points of which each differs from the one before in one factor: M. D. Morris, Technometrics 33(2), 161–174
//! (1991), doi:10.1080/00401706.1991.10484804.

use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_chacha::{ChaCha8Rng, ChaCha12Rng};

use super::definition::{Design, DesignError, Factor, Setting, room, spread};
use super::direction_numbers::DIRECTION_NUMBERS;

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

    /// Random number from 0 to bound − 1; probabilities differ by bound / 2⁶⁴.
    fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.0.next_u64()) * bound as u128) >> u64::BITS) as usize
    }

    /// Random number strictly between 0 and 1, in the middle of one of 2²⁴ equal parts, so that no rounding leads out of a stratum.
    fn inside(&mut self) -> f64 {
        ((self.0.next_u64() >> 40) as f64 + 0.5) / f64::from(1_u32 << 24)
    }
}

/// Binary digits of a coordinate.
const DIGITS: usize = 32;

/// The first points of the sequence, the very first at the lower ends of all ranges (as scipy's `qmc.Sobol` without
/// scrambling). Powers of two are best: only they give every half, quarter … of a range equally many points.
pub(super) fn sobol(points: usize, factors: &[Factor]) -> Result<Design, DesignError> {
    if points == 0 {
        return Err(DesignError("a Sobol design has at least one point".into()));
    }
    let (count, most) = (factors.len(), DIRECTION_NUMBERS.len() + 1);
    if count > most {
        return Err(DesignError(format!("a Sobol design has at most {most} factors, not {count}")));
    }
    room(Some(points), count)?;
    let directions: Vec<[u32; DIGITS]> = (0..count).map(directions).collect();
    let mut at = vec![0_u32; count];
    let mut settings = Vec::with_capacity(points * count);
    for point in 0..points {
        let unit = at.iter().map(|digits| f64::from(*digits) / (1_u64 << DIGITS) as f64);
        settings.extend(factors.iter().zip(unit).map(|(factor, unit)| spread(factor, unit)));
        // `room` admits fewer than 2³² points.
        let changed = point.trailing_ones() as usize;
        at.iter_mut().zip(&directions).for_each(|(at, directions)| *at ^= directions[changed]);
    }
    Design::from_settings(count, settings, None)
}

/// Contribution of the binary digits of a point's number to its coordinate of this dimension.
fn directions(dimension: usize) -> [u32; DIGITS] {
    let Some((inner, initial)) = dimension.checked_sub(1).and_then(|index| DIRECTION_NUMBERS.get(index)) else {
        // The first dimension has no polynomial: it is van der Corput's sequence.
        return std::array::from_fn(|digit| 1 << (DIGITS - 1 - digit));
    };
    let degree = initial.len();
    let mut directions = [0; DIGITS];
    for digit in 0..DIGITS {
        directions[digit] = match initial.get(digit) {
            Some(number) => number << (DIGITS - 1 - digit),
            None => {
                let before = directions[digit - degree];
                let terms = (1..degree).filter(|term| inner >> (degree - 1 - term) & 1 == 1);
                terms.fold(before ^ before >> degree, |sum, term| sum ^ directions[digit - term])
            }
        };
    }
    directions
}

/// Makes so many trajectories of one point more than there are factors, on a grid of so many levels along each range. Steps are half
/// the number of levels long, which gives all levels the same chance; places, directions and the order of factors are drawn by lot.
pub(super) fn morris(trajectories: usize, levels: usize, seed: u64, factors: &[Factor]) -> Result<Design, DesignError> {
    if trajectories == 0 {
        return Err(DesignError("a Morris design has at least one trajectory".into()));
    }
    if levels < 2 || !levels.is_multiple_of(2) || levels > 1000 {
        return Err(DesignError(format!("a Morris design has an even number of levels from 2 to 1000, not {levels}")));
    }
    let points = factors.len().checked_add(1).and_then(|points| points.checked_mul(trajectories));
    room(points, factors.len())?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    // The remainder favours small numbers by less than 2⁻⁵⁰.
    let mut below = |count: usize| (random.next_u64() % count as u64) as usize;
    let counts: Vec<usize> =
        factors.iter().map(|factor| if *factor == Factor::Range { levels } else { factor.levels() }).collect();
    let mut settings = Vec::new();
    for _ in 0..trajectories {
        let mut place: Vec<usize> = counts.iter().map(|count| below(*count)).collect();
        let mut order: Vec<usize> = (0..factors.len()).collect();
        for last in (1..order.len()).rev() {
            order.swap(last, below(last + 1));
        }
        let setting = |(at, count): (&usize, &usize), factor: &Factor| match factor {
            Factor::Range => Setting::Coded(2.0 * *at as f64 / (count - 1) as f64 - 1.0),
            Factor::Levels(_) => Setting::Level(*at),
        };
        let mut add = |place: &[usize]| {
            settings.extend(place.iter().zip(&counts).zip(factors).map(|(at, factor)| setting(at, factor)));
        };
        add(&place);
        for factor in order {
            // Half the levels up or down, whichever stays on the grid; from the middle of an odd number either will do.
            let (at, step) = (place[factor], counts[factor] / 2);
            place[factor] = if at + step < counts[factor] { at + step } else { at - step };
            add(&place);
        }
    }
    Design::from_settings(factors.len(), settings, None)
}

#[cfg(test)]
#[path = "../../tests/unit/design/sampled.rs"]
mod tests;
