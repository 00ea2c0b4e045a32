use super::*;

#[test]
fn a_run_that_is_too_short_is_told_how_long_it_should_be() {
    let of = |last_tenth: f64, revolutions: f64| PulseReport { pulse_time: 27.0, last_tenth, revolutions }.text();
    assert_eq!(
        of(6.0, 8.5),
        "the shortest pulse takes 27 s; the last tenth of the run, 6 s, has at most 0.22, and a mean needs at least 5: the run must be longer than 1350 s; \
             its mean is over the last 7.06 s, 10 simulated revolutions"
    );
    assert!(of(6.0, 0.85).ends_with("the run must be longer than 1350 s"), "{}", of(6.0, 0.85));
    assert_eq!(of(270.0, 380.0), "the shortest pulse takes 27 s; the last tenth of the run, 270 s, has at most 10");
    assert!(of(270.0, 3.8).ends_with("these are 3.8: a smaller time_acceleration gives more"), "{}", of(270.0, 3.8));
}
