use super::Clock;

#[test]
fn time_goes_on_from_a_change() {
    // By hand: 10 steps of 0.5 s, then steps of 2 s.
    let clock = Clock::new(0.5).changed(10, 2.0);
    assert_eq!([10, 11, 15].map(|step| clock.time_at(step)), [5.0, 7.0, 15.0]);
    assert_eq!([5.0, 5.1, 7.0, 7.1].map(|time| clock.steps_until(time)), [10, 11, 11, 12]);
    // Rounding of a time that is a multiple of the step must not cost a step.
    assert_eq!(Clock::new(0.1).steps_until(0.3), 3);
}
