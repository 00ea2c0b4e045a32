use super::*;

fn of(kind: Fraction, factors: usize) -> Result<Design, DesignError> {
    fractional_factorial(&kind, &vec![Factor::Range; factors])
}

/// Points of the smallest fraction, and its resolution.
fn smallest(factors: usize, resolution: u32) -> (usize, u32) {
    let design = of(Fraction::Resolution(resolution), factors).unwrap();
    (design.points(), design.aliases().unwrap().resolution)
}

#[test]
fn the_smallest_fractions_are_those_of_the_handbook() {
    // NIST/SEMATECH e-Handbook, 5.3.3.4.7: number of factors, resolution, number of runs.
    for (factors, resolution, points) in [
        (3, 3, 4),
        (4, 4, 8),
        (5, 5, 16),
        (5, 3, 8),
        (6, 6, 32),
        (6, 4, 16),
        (6, 3, 8),
        (7, 7, 64),
        (7, 4, 16),
        (7, 3, 8),
        (8, 5, 64),
        (8, 4, 16),
        (9, 6, 128),
        (9, 4, 32),
        (9, 3, 16),
        (10, 5, 128),
        (10, 4, 32),
        (10, 3, 16),
        (11, 5, 128),
        (11, 4, 32),
        (11, 3, 16),
        (15, 3, 16),
    ] {
        assert_eq!(smallest(factors, resolution), (points, resolution), "{factors} factors");
    }
}

#[test]
fn the_generators_decide_the_sign() {
    // By hand: −ABCD is −1 where all four are −1, for their product is 1.
    let design = of(Fraction::Generators(vec!["E = -ABCD".into()]), 5).unwrap();
    assert_eq!(design.point(0), [Setting::Coded(-1.0); 5]);
    assert_eq!(design.point(1)[4], Setting::Coded(1.0));
}

#[test]
fn all_combinations_stand_in_for_a_fraction_that_does_not_exist() {
    for (factors, resolution, points) in [(1, 3, 2), (2, 3, 4), (4, 5, 16), (16, 17, 65_536)] {
        let design = of(Fraction::Resolution(resolution), factors).unwrap();
        assert_eq!(design.points(), points);
        assert_eq!(design.aliases(), None);
    }
    assert_eq!(of(Fraction::Generators(Vec::new()), 3).unwrap().points(), 8);
}

#[test]
fn what_cannot_be_had_is_refused() {
    assert!(of(Fraction::Resolution(2), 5).unwrap_err().0.contains("the least is 3"));
    assert!(of(Fraction::Resolution(12), 20).unwrap_err().0.contains("more than 4096 points"));
    assert!(of(Fraction::Resolution(3), 26).unwrap_err().0.contains("at most 25 factors"));
    let error = fractional_factorial(&Fraction::Resolution(3), &[Factor::Range, Factor::Levels(3)]).unwrap_err();
    assert!(error.0.contains("factor 2 has 3 levels"), "{error}");
}
