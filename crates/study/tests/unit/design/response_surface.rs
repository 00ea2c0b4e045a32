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

#[test]
fn other_numbers_of_factors_are_refused() {
    for factors in [1, 2, 8, 9, 16] {
        let error = box_behnken(3, &vec![Factor::Range; factors]).unwrap_err();
        assert!(error.0.contains("only of 3 to 7 factors"), "{error}");
    }
    assert!(box_behnken(usize::MAX, &[Factor::Range; 3]).is_err());
}
