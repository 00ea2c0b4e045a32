use super::*;

#[test]
fn what_repeats_with_a_steady_drift_is_foretold() {
    let mut forecast = Forecast::new(10);
    let displacement = |step: u32| f64::from(step % 10).sin() + 1e-3 * f64::from(step / 10);
    for step in 0..40 {
        forecast.record(displacement(step));
    }
    // The drift of a revolution comes as one jump at its first step, which the last revolution had as well.
    let (expected, _) = forecast.expect(0.0);
    assert!((expected - displacement(40)).abs() < 1e-12);
}

#[test]
fn without_a_past_the_last_step_is_all_there_is() {
    let mut forecast = Forecast::new(10);
    forecast.record(3.0);
    assert_eq!(forecast.expect(2.0), (3.0, 0.2));
}
