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
fn levels_get_equal_shares_of_the_strata() {
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
fn levels_get_equal_shares_of_the_sequence() {
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
