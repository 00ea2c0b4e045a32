//! Sobol's sequence: points that fill the ranges evenly, the more of them the finer.
//!
//! I. M. Sobol', On the distribution of points in a cube and the approximate evaluation of integrals, USSR Comput.
//! Math. Math. Phys. 7(4), 86–112 (1967), doi:10.1016/0041-5553(67)90144-9; in the order of the Gray code: I. A.
//! Antonov, V. M. Saleev, ibid. 19(1), 252–256 (1979), doi:10.1016/0041-5553(79)90085-5.

use super::definition::{Design, DesignError, Factor, room, spread};
use super::direction_numbers::DIRECTION_NUMBERS;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Setting;

    #[test]
    fn a_power_of_two_of_points_fills_every_stratum_of_every_dimension() {
        // Property of (t, m, 1)-nets with t = 0, as each coordinate of Sobol's sequence is (Sobol' 1967).
        let factors = DIRECTION_NUMBERS.len() + 1;
        let design = sobol(1024, &vec![Factor::Range; factors]).unwrap();
        for factor in 0..factors {
            let mut strata: Vec<usize> = (0..1024)
                .map(|point| match design.point(point)[factor] {
                    Setting::Coded(at) => ((at + 1.0) / 2.0 * 1024.0) as usize,
                    Setting::Level(_) => usize::MAX,
                })
                .collect();
            strata.sort();
            assert_eq!(strata, (0..1024).collect::<Vec<_>>(), "dimension {factor}");
        }
    }

    #[test]
    fn levels_get_equal_shares() {
        // By hand: of 16 points 4 in each quarter.
        let design = sobol(16, &[Factor::Range, Factor::Levels(4)]).unwrap();
        for level in 0..4 {
            assert_eq!((0..16).filter(|point| design.point(*point)[1] == Setting::Level(level)).count(), 4);
        }
    }

    #[test]
    fn too_many_factors_or_no_points_are_refused() {
        assert!(sobol(0, &[Factor::Range]).is_err());
        assert!(sobol(usize::MAX, &[Factor::Range]).is_err());
        assert!(sobol(4, &vec![Factor::Range; 102]).unwrap_err().0.contains("at most 101 factors"));
    }
}
