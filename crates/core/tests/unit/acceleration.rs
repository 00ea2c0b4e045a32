use super::*;

#[test]
fn the_estimate_bounds_the_error_of_every_power_between_0_and_1() {
    // Closed form: the error is m^p − 1, or ln m, the difference that of 4 m and m.
    for acceleration in [4.0, 10.0, 100.0_f64, 1000.0] {
        for power in [0.01, 0.25, 0.5, 1.0] {
            let error = |m: f64| m.powf(power) - 1.0;
            let estimate = from_difference(error(4.0 * acceleration) - error(acceleration), acceleration);
            assert!(estimate >= error(acceleration), "m = {acceleration}, power {power}");
        }
        let difference = (4.0 * acceleration).ln() - acceleration.ln();
        assert!((from_difference(difference, acceleration) / acceleration.ln() - 1.0).abs() < 1e-12);
    }
    assert_eq!(from_difference(0.01, 1.0), 0.01);
}

#[test]
fn what_the_run_had_before_counts_with_what_came_since() {
    // By hand: 3 % carried and 4 % seen since at m = 2 are 5 %.
    let mut choice = Choice { carried: 0.03, ..Choice::within(1.0, 2.0, 100.0, 1.0) };
    choice.acceleration = 2.0;
    choice.note(0.04, 8.0, 8.0);
    assert!((choice.error() - 0.05).abs() < 1e-15, "{choice:?}");
    // Over 8 s, and the same over 8 s more.
    assert!((choice.chosen(16.0).estimated_error - 0.05).abs() < 1e-15);
}

#[test]
fn windows_end_with_a_revolution() {
    // By hand: a window of 60 s has 6 revolutions of 10 s, where up to 11 are wanted; of what is left after 40 s, 2.
    assert_eq!(whole_revolutions(11.0, 1.0, 60.0, 60.0), 10.0);
    assert_eq!(whole_revolutions(11.0, 1.0, 20.0, 60.0), 10.0);
    // m is rounded in such a way that a rest is none, and is never below 1.
    assert_eq!(whole_revolutions(10.0 * (1.0 - 1e-9), 1.0, 60.0 * (1.0 + 1e-9), 60.0), 10.0 * (1.0 - 1e-9));
    assert_eq!(whole_revolutions(11.0, 1.0, 1e-9, 60.0), 10.0);
    assert_eq!(whole_revolutions(11.0, 1.0, 0.5, 60.0), 1.0);
}

#[test]
fn a_fading_mean_is_the_exponential_mean() {
    // Closed form: weights 1 − 1/e for the last and (1 − 1/e)/e for the one before, over their sum.
    let mut mean = FadingMean::default();
    mean.add(3.0, 1.0);
    assert_eq!(mean.value(), 3.0);
    mean.add(1.0, 1.0);
    let e = std::f64::consts::E;
    assert!((mean.value() - (1.0 + 3.0 / e) / (1.0 + 1.0 / e)).abs() < 1e-15);
}
