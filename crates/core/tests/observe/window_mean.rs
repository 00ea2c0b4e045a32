//! Means over the end of a run and their standard errors.

use plateau_core::observe::window_mean::{Cumulative, WindowMean, last_tenth, standard_error};

use crate::scenes::Stream;

/// A stationary process of first order with variance 1: x_i = φ x_{i−1} + √(1 − φ²) e_i.
fn process(random: &mut Stream, alike: f64, count: usize) -> Vec<f64> {
    let mut value = random.normal();
    let next = |_| {
        let this = value;
        value = alike * value + (1.0 - alike * alike).sqrt() * random.normal();
        this
    };
    (0..count).map(next).collect()
}

/// Variance of the mean of n values of that process, in closed form: (1/n²) Σ_i Σ_k φ^|i−k|.
fn variance_of_mean(alike: f64, count: usize) -> f64 {
    let n = count as f64;
    ((1.0 + alike) / (1.0 - alike) - 2.0 * alike * (1.0 - alike.powi(count as i32)) / (n * (1.0 - alike).powi(2))) / n
}

#[test]
fn the_error_is_that_of_a_process_of_first_order() {
    // The closed form for two values: (1 + φ)/2.
    assert!((variance_of_mean(0.6, 2) - 0.8).abs() < 1e-15);
    let mut random = Stream(1);
    for alike in [0.0, 0.6, 0.9] {
        let (runs, count) = (400, 1000);
        let (mut sum, mut hits) = (0.0, 0);
        for _ in 0..runs {
            let values = process(&mut random, alike, count);
            let error = standard_error(&values);
            sum += error * error;
            hits += usize::from((values.iter().sum::<f64>() / count as f64).abs() < 1.96 * error);
        }
        let ratio = sum / runs as f64 / variance_of_mean(alike, count);
        // Chance moves the mean of 400 estimates by some hundredths; the truncation makes it a little too large.
        assert!((0.9..1.25).contains(&ratio), "φ = {alike}: {ratio}");
        // 95 %, give or take three standard deviations of the count and a little for the estimate.
        assert!((0.90..0.99).contains(&(hits as f64 / runs as f64)), "φ = {alike}: {hits} of {runs}");
    }
}

#[test]
fn independent_and_alternating_values_have_the_familiar_error() {
    // s² = 4/3, n = 4; its pairs are negative.
    assert!((standard_error(&[1.0, -1.0, 1.0, -1.0]) - (4.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-15);
    assert_eq!(standard_error(&[3.0; 8]), 0.0);
}

#[test]
fn a_mean_is_the_difference_of_the_integral() {
    let time: Vec<f64> = (1..=100).map(f64::from).collect();
    // The quantity is 2 t: its integral t².
    let integral: Vec<f64> = time.iter().map(|time| time * time).collect();
    let run = |revolutions: &[f64]| {
        let (from, to) = last_tenth(&time, revolutions).unwrap();
        Cumulative { time: &time, integral: &integral, revolutions }.mean(from, to).unwrap()
    };
    let last = run(&[]);
    assert_eq!((last.from, last.to, last.mean, last.revolutions), (90.0, 100.0, 190.0, None));
    // A revolution in 5 s: ten of them take half of the run. The window begins at a sample.
    let slow: Vec<f64> = time.iter().map(|time| time / 5.0).collect();
    let last = run(&slow);
    assert_eq!((last.from, last.mean, last.is_long()), (50.0, 150.0, true));
    assert!((last.revolutions.unwrap() - 10.0).abs() < 1e-12);
    // A revolution in 20 s: there are only five.
    let slower: Vec<f64> = time.iter().map(|time| time / 20.0).collect();
    let last = run(&slower);
    assert_eq!((last.from, last.mean, last.is_long()), (0.0, 100.0, false));
    // Five parts of one revolution each: 20, 60, 100, 140, 180, a line, that is no chance but counts as such.
    assert_eq!(last.standard_error, Some(standard_error(&[20.0, 60.0, 100.0, 140.0, 180.0])));
    // Between samples the integral is a line: from 8100 at 90 s to 8281.
    let between = Cumulative { time: &time, integral: &integral, revolutions: &[] }.mean(90.5, 91.0).unwrap();
    assert_eq!((between.mean, between.standard_error), (181.0, None));
}

#[test]
fn a_mean_in_contact_leaves_out_the_time_in_which_the_pin_is_lifted() {
    // 3 mm² for 10 s, lifted for 20 s, 5 mm² for 10 s, lifted for 10 s; a sample every 2 s.
    let time: Vec<f64> = (1..=25).map(|sample| 2.0 * f64::from(sample)).collect();
    let contact = |time: f64| time.min(10.0) + (time - 30.0).clamp(0.0, 10.0);
    let integral = |time: f64| 3.0 * time.min(10.0) + 5.0 * (time - 30.0).clamp(0.0, 10.0);
    let series = |of: &dyn Fn(f64) -> f64| -> Vec<f64> { time.iter().map(|time| of(*time)).collect() };
    let (contact, integral) = (series(&contact), series(&integral));
    let run = Cumulative { time: &time, integral: &integral, revolutions: &[] };
    let mean = |from: f64, to: f64| run.mean_in_contact(&contact, from, to);
    let whole = mean(0.0, 50.0).unwrap();
    // By hand: 80 mm² s in 20 s of contact; over all 50 s it would be 1.6.
    assert_eq!((whole.mean, whole.contact_time, whole.from, whole.to), (4.0, Some(20.0), 0.0, 50.0));
    // Means of ten parts: five of 3, five of 5.
    assert_eq!(whole.standard_error, Some(standard_error(&[3.0, 3.0, 3.0, 3.0, 3.0, 5.0, 5.0, 5.0, 5.0, 5.0])));
    assert_eq!(mean(20.0, 36.0).map(|mean| (mean.mean, mean.contact_time)), Some((5.0, Some(6.0))));
    assert_eq!(mean(2.0, 8.0).map(|mean| (mean.mean, mean.contact_time)), Some((3.0, None)));
    assert_eq!(mean(12.0, 28.0), None);
    assert_eq!(run.mean_in_contact(&[], 0.0, 50.0), None);
}

#[test]
fn a_mean_over_less_than_three_pulses_has_no_error() {
    let time: Vec<f64> = (1..=30).map(f64::from).collect();
    let integral: Vec<f64> = time.iter().map(|time| time + time.sin()).collect();
    let mean = Cumulative { time: &time, integral: &integral, revolutions: &[] }.mean(0.0, 30.0).unwrap();
    assert!(mean.standard_error.is_some());
    assert_eq!([None, Some(10.0)].map(|pulse_time| mean.of_pulses(pulse_time)), [mean; 2]);
    assert_eq!(mean.of_pulses(Some(10.1)), WindowMean { standard_error: None, ..mean });
}

#[test]
fn what_there_is_not_has_no_mean() {
    let of = |time: &[f64], integral: &[f64], from, to| Cumulative { time, integral, revolutions: &[] }.mean(from, to);
    assert_eq!(of(&[], &[], 0.0, 1.0), None);
    assert_eq!(of(&[1.0, 2.0], &[1.0, 2.0], 1.0, 2.1), None);
    assert_eq!(of(&[1.0, 2.0], &[1.0, 2.0], 2.0, 2.0), None);
    assert_eq!(of(&[1.0, 2.0], &[1.0, f64::NAN], 0.0, 2.0), None);
    assert_eq!(of(&[1.0, 2.0], &[1.0], 0.0, 2.0), None);
    assert_eq!(of(&[2.0], &[8.0], 0.0, 2.0).map(|window| window.mean), Some(4.0));
    assert_eq!(last_tenth(&[], &[]), None);
}

#[test]
fn what_comes_and_goes_in_every_revolution_is_no_error() {
    // Ten samples a revolution: 1 in its first half, 3 in its second.
    let time: Vec<f64> = (1..=400).map(|sample| f64::from(sample) / 10.0).collect();
    let turn = |time: f64| if time.fract() < 0.5 { time.fract() } else { 3.0 * time.fract() - 1.0 };
    let integral: Vec<f64> = time.iter().map(|time| 2.0 * time.floor() + turn(*time)).collect();
    let window = Cumulative { time: &time, integral: &integral, revolutions: &time }.mean(20.0, 40.0).unwrap();
    assert!((window.mean - 2.0).abs() < 1e-12 && window.standard_error.unwrap() < 1e-12, "{window:?}");
}
