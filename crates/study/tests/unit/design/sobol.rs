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
