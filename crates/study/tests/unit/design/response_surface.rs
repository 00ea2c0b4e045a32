use super::*;

fn of(alpha: Alpha, centre: [usize; 2], factors: usize) -> Design {
    central_composite(alpha, centre, &vec![Factor::Range; factors]).unwrap()
}

fn coded(design: &Design) -> Vec<Vec<f64>> {
    let value = |setting: &Setting| match setting {
        Setting::Coded(value) => *value,
        Setting::Level(_) => f64::NAN,
    };
    (0..design.points()).map(|point| design.point(point).iter().map(value).collect()).collect()
}

#[test]
fn rotatable_designs_have_the_moments_of_rotation() {
    // Box and Hunter (1957): odd moments vanish and Σx⁴ = 3 Σx²y², so that the variance of prediction is the
    // same at equal distance from the centre.
    for factors in 2..=10 {
        let rows = coded(&of(Alpha::Rotatable, [2, 3], factors));
        let moment = |powers: &[(usize, i32)]| -> f64 {
            rows.iter().map(|row| powers.iter().map(|(factor, power)| row[*factor].powi(*power)).product::<f64>()).sum()
        };
        for one in 0..factors {
            assert!(moment(&[(one, 1)]).abs() < 1e-9 && moment(&[(one, 3)]).abs() < 1e-9);
            for other in (0..factors).filter(|other| *other != one) {
                let (pure, mixed) = (moment(&[(one, 4)]), moment(&[(one, 2), (other, 2)]));
                assert!((pure - 3.0 * mixed).abs() < 1e-9 * pure, "{factors} factors: {pure}, {mixed}");
                assert!(moment(&[(one, 1), (other, 1)]).abs() < 1e-9);
                assert!(moment(&[(one, 3), (other, 1)]).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn orthogonal_blocks_have_squares_in_proportion_to_their_sizes() {
    // Box and Hunter (1957): the condition for blocks that do not change the quadratic effects.
    for (factors, centre) in [(2, [4, 4]), (3, [4, 2]), (4, [0, 3]), (5, [6, 1]), (7, [1, 0])] {
        let rows = coded(&of(Alpha::Orthogonal, centre, factors));
        let (core, axial) = rows.split_at(rows.len() - 2 * factors - centre[1]);
        for factor in 0..factors {
            let mean = |block: &[Vec<f64>]| {
                block.iter().map(|row| row[factor] * row[factor]).sum::<f64>() / block.len() as f64
            };
            assert!((mean(core) - mean(axial)).abs() < 1e-12, "{factors} factors");
        }
    }
}

#[test]
fn the_core_is_a_fraction_of_resolution_v_from_five_factors_on() {
    // NIST/SEMATECH e-Handbook, 5.3.3.4.7: 16, 32, 64 and 64 runs of resolution V or more for 5 to 8 factors.
    for (factors, core) in [(1, 2), (2, 4), (3, 8), (4, 16), (5, 16), (6, 32), (7, 64), (8, 64)] {
        assert_eq!(of(Alpha::Face, [0, 0], factors).points(), core + 2 * factors);
    }
}

#[test]
fn too_many_centre_points_are_refused() {
    let refused = central_composite(Alpha::Face, [usize::MAX, 1], &[Factor::Range; 2]).unwrap_err();
    assert!(refused.0.contains("10000000"), "{refused}");
}

const PUBLISHED: [usize; 5] = [3, 4, 5, 6, 7];

#[test]
fn designs_have_the_numbers_of_points_of_the_article() {
    // Box and Behnken (1960), table 4: points and centre points.
    let sizes = [(15, 3), (27, 3), (46, 6), (54, 6), (62, 6)];
    for (factors, (points, centre)) in PUBLISHED.into_iter().zip(sizes) {
        let design = box_behnken(centre, &vec![Factor::Range; factors]).unwrap();
        assert_eq!(design.points(), points, "{factors} factors");
    }
}

#[test]
fn every_factor_is_in_as_many_blocks_and_meets_every_other() {
    // The definition of (partially) balanced incomplete blocks with two classes of associates, for which numbers of
    // meetings differ by one at most here; without a meeting an interaction could not be estimated.
    for factors in PUBLISHED {
        let blocks = blocks(factors).unwrap();
        let meetings = |one: usize, other: usize| {
            blocks.iter().filter(|block| block.contains(&one) && block.contains(&other)).count()
        };
        let size = blocks[0].len();
        for one in 1..=factors {
            assert_eq!(meetings(one, one) * factors, blocks.len() * size, "{factors} factors");
            let others: Vec<usize> =
                (1..=factors).filter(|other| *other != one).map(|other| meetings(one, other)).collect();
            let (least, most) = (others.iter().min().unwrap(), others.iter().max().unwrap());
            assert!(*least >= 1 && most - least <= 1, "{factors} factors, factor {one}: {others:?}");
        }
    }
}

#[test]
fn other_numbers_of_factors_are_refused() {
    for factors in [1, 2, 8, 9, 16] {
        let error = box_behnken(3, &vec![Factor::Range; factors]).unwrap_err();
        assert!(error.0.contains("only of 3 to 7 factors"), "{error}");
    }
    assert!(box_behnken(usize::MAX, &[Factor::Range; 3]).is_err());
}
