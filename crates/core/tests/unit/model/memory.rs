use super::*;

#[test]
fn the_integral_has_the_time_on_the_disc_moving_or_not() {
    let mut history = History::new(4);
    for area in [1.0, 3.0, 5.0, 7.0, 9.0, 11.0] {
        let standing_before = if area == 9.0 { 2.0 } else { 0.0 };
        history.record(area, &StepOperation { end: 0.0, load: 1.0, standing_before, loaded: 0.5, active: 0.5 });
    }
    // Half of the sum, and 2 s of the contact of the step before the fifth.
    assert_eq!(history.integral(), 18.0 + 14.0);
    assert_eq!(history.revolution_mean(), 8.0);
}
