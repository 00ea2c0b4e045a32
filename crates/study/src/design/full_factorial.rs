//! Full factorial designs: every combination of the levels.

use super::definition::{Design, DesignError, Factor, Setting, room};

/// Every combination of the levels, the first factor changing fastest (as in R's `expand.grid` and pyDOE's `fullfact`).
/// The ends of a range are its levels.
pub(super) fn full_factorial(factors: &[Factor]) -> Result<Design, DesignError> {
    let counts: Vec<usize> = factors.iter().map(Factor::levels).collect();
    let points = counts.iter().try_fold(1_usize, |points, count| points.checked_mul(*count));
    let points = room(points, factors.len())?;
    let mut settings = Vec::with_capacity(points * factors.len());
    let mut levels = vec![0; factors.len()];
    for _ in 0..points {
        settings.extend(factors.iter().zip(&levels).map(|(factor, level)| at(factor, *level)));
        for (level, count) in levels.iter_mut().zip(&counts) {
            *level += 1;
            if *level < *count {
                break;
            }
            *level = 0;
        }
    }
    Design::from_settings(factors.len(), settings, None)
}

fn at(factor: &Factor, level: usize) -> Setting {
    match factor {
        Factor::Levels(_) => Setting::Level(level),
        Factor::Range => Setting::Coded(if level == 0 { -1.0 } else { 1.0 }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_factor_changes_fastest_and_a_range_has_its_ends() {
        // By hand, from the definition.
        let design = full_factorial(&[Factor::Range, Factor::Levels(3)]).unwrap();
        let points: Vec<_> = (0..design.points()).map(|point| design.point(point).to_vec()).collect();
        let expected: Vec<_> =
            (0..3).flat_map(|level| [-1.0, 1.0].map(|end| vec![Setting::Coded(end), Setting::Level(level)])).collect();
        assert_eq!(points, expected);
    }

    #[test]
    fn every_combination_occurs_once() {
        let counts = [3, 2, 5, 4];
        let design = full_factorial(&counts.map(Factor::Levels)).unwrap();
        let mut seen: Vec<String> = (0..design.points()).map(|point| format!("{:?}", design.point(point))).collect();
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), counts.iter().product::<usize>());
    }
}
