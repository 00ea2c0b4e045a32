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
