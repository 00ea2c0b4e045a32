use super::*;

#[test]
fn it_is_straight_between_points_and_constant_beyond() {
    let factor = Factor::new(vec![(300.0, 1.0), (400.0, 3.0), (500.0, 0.0)]).unwrap();
    let temperatures = [0.0, 300.0, 350.0, 400.0, 475.0, 500.0, 1e9];
    assert_eq!(temperatures.map(|temperature| factor.at(temperature)), [1.0, 1.0, 2.0, 3.0, 0.75, 0.0, 0.0]);
    assert!(!factor.is_one());
    assert_eq!(factor.largest(), Some(3.0));
}

#[test]
fn none_is_one() {
    let factor = Factor::default();
    assert!(factor.is_one() && factor.at(77.0) == 1.0 && factor.largest().is_none());
    assert!(Factor::new(vec![(300.0, 1.0)]).unwrap().is_one());
}

#[test]
fn what_does_not_rise_is_refused() {
    let wrong = |points| Factor::new(points).unwrap_err();
    assert!(matches!(wrong(vec![(300.0, 1.0), (300.0, 2.0)]), FactorError::Order { point: 1, .. }));
    assert!(matches!(wrong(vec![(f64::NAN, 1.0)]), FactorError::Order { point: 0, .. }));
    assert!(matches!(wrong(vec![(300.0, -1.0)]), FactorError::Value { point: 0, .. }));
}
