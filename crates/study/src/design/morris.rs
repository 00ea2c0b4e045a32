//! Morris's trajectories: points of which each differs from the one before in one factor.
//!
//! M. D. Morris, Technometrics 33(2), 161–174 (1991), doi:10.1080/00401706.1991.10484804.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::definition::{Design, DesignError, Factor, Setting, room};

/// So many trajectories of one point more than there are factors, on a grid of so many levels along each range. Steps are half
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
mod tests {
    use super::*;

    #[test]
    fn one_factor_changes_from_point_to_point_by_half_the_levels() {
        let factors = [Factor::Range, Factor::Levels(3), Factor::Range, Factor::Levels(2)];
        let design = morris(25, 4, 7, &factors).unwrap();
        assert_eq!(design.points(), 125);
        let mut counts = [0; 4];
        for point in (0..125).filter(|point| point % 5 != 4) {
            let (before, after) = (design.point(point), design.point(point + 1));
            let changed: Vec<usize> = (0..4).filter(|at| before[*at] != after[*at]).collect();
            let [factor] = changed[..] else { panic!("{before:?} {after:?}") };
            counts[factor] += 1;
            if let (Setting::Coded(before), Setting::Coded(after)) = (before[factor], after[factor]) {
                // Morris's Δ = p/(2(p − 1)) = 2/3 of the range.
                assert!(((after - before).abs() - 4.0 / 3.0).abs() < 1e-12);
            }
        }
        assert_eq!(counts, [25; 4]);
        assert_eq!(design, morris(25, 4, 7, &factors).unwrap());
        assert_ne!(design, morris(25, 4, 8, &factors).unwrap());
    }

    #[test]
    fn what_is_no_design_is_refused() {
        assert!(morris(0, 4, 0, &[Factor::Range]).is_err());
        assert!(morris(10, 3, 0, &[Factor::Range]).unwrap_err().0.contains("even number"));
        assert!(morris(usize::MAX, 4, 0, &[Factor::Range]).unwrap_err().0.contains("far more"));
    }
}
