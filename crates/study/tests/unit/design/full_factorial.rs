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
