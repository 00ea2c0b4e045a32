//! When a run has run in.

use plateau_core::observe::running_in::{NotDefined, time_to, time_to_in_contact};
use plateau_core::observe::window_mean::Cumulative;

use crate::scenes::Stream;

/// The answer of a quantity with this integral, of which there are 600 samples in 600 s.
fn of(fraction: f64, integral: impl Fn(f64) -> f64) -> Result<f64, NotDefined> {
    let time: Vec<f64> = (1..=600).map(f64::from).collect();
    let integral: Vec<f64> = time.iter().map(|time| integral(*time)).collect();
    time_to(fraction, &Cumulative { time: &time, integral: &integral, revolutions: &[] }, None)
}

/// The integral of 1 + (a − 1) exp(−t/τ).
fn saturating(start: f64, tau: f64) -> impl Fn(f64) -> f64 {
    move |time| time + (start - 1.0) * tau * (1.0 - (-time / tau).exp())
}

#[test]
fn a_curve_that_saturates_is_run_in_where_its_closed_form_is() {
    // 1 − exp(−t/50 s) is 0.9 at 115.1 s: by hand, the first window of 10 s whose mean, 1 − 5 exp(−t/50)(1 − exp(−1/5)), is 0.9 or more is
    // that from 120 s on: 0.918; that from 110 s on has 0.8996.
    assert_eq!(of(0.9, saturating(0.0, 50.0)), Ok(125.0));
    // From above, to 1/0.9: 1 + exp(−t/50 s) is 1.111 at 109.9 s, and its mean from 100 s on is 1.1227, from 110 s on 1.1004.
    assert_eq!(of(0.9, saturating(2.0, 50.0)), Ok(115.0));
    // It does not depend on the sign or the size.
    assert_eq!(of(0.9, |time| -3e-7 * saturating(0.0, 50.0)(time)), Ok(125.0));
    // It begins nearer than that.
    assert_eq!(of(0.5, saturating(0.8, 50.0)), Ok(5.0));
}

#[test]
fn the_time_in_which_the_pin_is_lifted_counts_for_nothing() {
    // In contact for 10 s, lifted for 10 s, and so on for 1200 s: on the axis of contact it is the curve of 600 s above.
    let time: Vec<f64> = (1..=1200).map(f64::from).collect();
    let contact: Vec<f64> = time.iter().map(|time| 10.0 * (time / 20.0).floor() + (time % 20.0).min(10.0)).collect();
    let integral: Vec<f64> = contact.iter().map(|time| saturating(0.0, 50.0)(*time)).collect();
    let samples = Cumulative { time: &time, integral: &integral, revolutions: &[] };
    // 125 s in contact are 5 s of the 13th time in contact, which begins at 240 s.
    let found = time_to_in_contact(0.9, &samples, &contact).unwrap();
    assert!((found - 245.0).abs() < 1e-9, "{found}");
    // With the pauses as an area of 0 it is another curve.
    assert_ne!(time_to(0.9, &samples, None), Ok(found));
    assert_eq!(time_to_in_contact(0.9, &samples, &contact[1..]), Err(NotDefined::NoValue));
}

#[test]
fn pulses_about_a_curve_that_saturates_are_its_noise() {
    // 0.05 cos(2π t/37 s) more: of the means over 10 s.
    let rate = std::f64::consts::TAU / 37.0;
    let found = of(0.9, |time| saturating(0.0, 60.0)(time) + 0.05 * (rate * time).sin() / rate).unwrap();
    assert!((100.0..180.0).contains(&found), "{found}");
}

#[test]
fn what_still_rises_or_falls_is_not_run_in() {
    assert!(matches!(of(0.9, |time| time * time), Err(NotDefined::NotSteady(change)) if change > 0.0));
    assert!(matches!(of(0.9, |time| 2000.0 * time - time * time), Err(NotDefined::NotSteady(change)) if change < 0.0));
    // 1 − exp(−t/75 s) changes by 0.7 % from quarter to quarter, 1 − exp(−t/120 s) by 3.5 %: by hand, (1 − e⁻²)² e⁻⁴ 75/150 and so on.
    assert!(of(0.9, saturating(0.0, 75.0)).is_ok());
    assert!(matches!(of(0.99, saturating(0.0, 75.0)), Err(NotDefined::NotSteady(_))));
    assert!(matches!(of(0.9, saturating(0.0, 120.0)), Err(NotDefined::NotSteady(_))));
}

#[test]
fn what_pulses_too_seldom_or_swings_about_the_fraction_is_not_run_in() {
    let time: Vec<f64> = (1..=600).map(f64::from).collect();
    let integral: Vec<f64> = time.iter().map(|time| saturating(0.0, 40.0)(*time)).collect();
    let samples = Cumulative { time: &time, integral: &integral, revolutions: &[] };
    assert_eq!(time_to(0.9, &samples, Some(50.0)), time_to(0.9, &samples, None));
    // A quarter is 150 s.
    assert_eq!(time_to(0.9, &samples, Some(75.0)), Err(NotDefined::FewPulses(2.0)));
    // Windows of 10 s of 0.97 and 1.03 in turn, the last two of 1.1: those of 0.97 are short of 0.99. By hand, of 59 windows from the second
    // on 28.
    let height = |window: usize| match window {
        58.. => 1.1,
        _ if window.is_multiple_of(2) => 0.97,
        _ => 1.03,
    };
    let sums = |time: f64| (1..=time as usize).map(|second| height((second - 1) / 10)).sum::<f64>();
    let found = of(0.9, sums);
    assert!(matches!(found, Err(NotDefined::ShortAgain(part)) if (part - 28.0 / 59.0).abs() < 1e-12), "{found:?}");
    // 0.4 sin(t/50 s) more: two quarters are not alike.
    let slow = |time: f64| time + 0.4 * 50.0 * (1.0 - (time / 50.0).cos());
    assert!(matches!(of(0.9, slow), Err(NotDefined::Unknown(..) | NotDefined::NotSteady(_))), "{:?}", of(0.9, slow));
}

#[test]
fn what_falls_and_rises_is_not_run_in() {
    // 1 but for a dip to 0.4 about 150 s, and the other way round.
    let dip = |time: f64| 20.0 * 1.772_453_85 / 2.0 * (1.0 + libm::erf((time - 150.0) / 20.0));
    assert!(matches!(of(0.9, |time| time - 0.6 * dip(time)), Err(NotDefined::NotMonotone(back)) if back > 0.4));
    assert!(matches!(of(0.9, |time| time + 0.6 * dip(time)), Err(NotDefined::NotMonotone(_))));
}

#[test]
fn noise_is_not_taken_for_a_way_back() {
    let mut random = Stream(5);
    let defined = (0..200)
        .filter(|_| {
            let mut noise = vec![0.0];
            (0..600).for_each(|place| noise.push(noise[place] + 0.1 * random.normal()));
            of(0.9, |time| saturating(0.0, 40.0)(time) + noise[time as usize]).is_ok()
        })
        .count();
    // Chance alone is taken for a drift in one run of twenty, and for a way back in some.
    assert!(defined > 160, "{defined} of 200");
}

#[test]
fn what_there_is_not_is_not_run_in() {
    assert_eq!(of(0.9, |_| 0.0), Err(NotDefined::NoValue));
    assert_eq!(of(0.9, |_| f64::NAN), Err(NotDefined::NoValue));
    let time = [1.0, 2.0, 3.0];
    let few = Cumulative { time: &time, integral: &time, revolutions: &[] };
    assert_eq!(time_to(0.9, &few, None), Err(NotDefined::TooShort));
    assert_eq!(
        time_to(0.9, &Cumulative { time: &[], integral: &[], revolutions: &[] }, None),
        Err(NotDefined::TooShort)
    );
}
