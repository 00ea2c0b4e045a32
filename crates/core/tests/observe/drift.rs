//! Whether a mean has stopped changing.

use plateau_core::model::material::Materials;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::Base;
use plateau_core::observe::running_in::{Drift, Trend, pulse_time};
use plateau_core::observe::window_mean::Cumulative;

use crate::scenes::Stream;

/// The drift of a quantity that is the derivative of this integral, over 400 s.
fn drift(integral: impl Fn(f64) -> f64) -> Option<Drift> {
    let time: Vec<f64> = (1..=400).map(f64::from).collect();
    let integral: Vec<f64> = time.iter().map(|time| integral(*time)).collect();
    Drift::of(&Cumulative { time: &time, integral: &integral, revolutions: &[] }, None)
}

#[test]
fn a_line_drifts_by_its_slope() {
    // The quantity is 2 t: 500 in the third quarter, 700 in the last.
    let found = drift(|time| time * time).unwrap();
    assert!((found.change - 0.4).abs() < 1e-12, "{found:?}");
    assert_eq!((found.third_quarter.mean, found.last_quarter.mean), (500.0, 700.0));
    assert_eq!((found.third_quarter.from, found.last_quarter.from, found.last_quarter.to), (200.0, 300.0, 400.0));
    assert_eq!(found.trend(), Trend::Rises);
    // A line has nothing that could be chance.
    assert!(found.standard_error < 1e-12, "{found:?}");
}

#[test]
fn the_error_is_that_of_what_varies_about_the_line() {
    // The quantity is 2 t and 1 more or less by lot: the change of means of 100 values errs by √(2/100).
    let mut random = Stream(3);
    let (mut sums, mut hits, runs) = (0.0, 0, 400);
    for _ in 0..runs {
        let mut noise = vec![0.0];
        (0..400).for_each(|place| noise.push(noise[place] + if random.uniform() < 0.5 { -1.0 } else { 1.0 }));
        let found = drift(|time| time * time + noise[time as usize]).unwrap();
        let of_third = found.third_quarter.mean;
        sums += (found.standard_error * of_third).powi(2);
        hits += usize::from((found.change * of_third - 200.0).abs() < 2.0 * found.standard_error * of_third);
    }
    let ratio = sums / runs as f64 / 0.02;
    // Chance moves the mean of 400 estimates by some hundredths; the truncation makes it a little too large.
    assert!((0.9..1.25).contains(&ratio), "{ratio}");
    // 95 %, give or take three standard deviations of the count and a little for the estimate.
    assert!((0.90..0.99).contains(&(hits as f64 / runs as f64)), "{hits} of {runs}");
}

#[test]
fn a_quarter_of_few_pulses_tells_nothing() {
    let time: Vec<f64> = (1..=400).map(f64::from).collect();
    let integral: Vec<f64> = time.iter().map(|time| time * time).collect();
    let samples = Cumulative { time: &time, integral: &integral, revolutions: &[] };
    let trend = |pulse| Drift::of(&samples, Some(pulse)).unwrap().trend();
    assert_eq!([trend(33.0), trend(34.0)], [Trend::Rises, Trend::TooShort]);
}

#[test]
fn what_swings_about_a_mean_does_not_drift() {
    // 1 + sin(t), whole and broken periods.
    let found = drift(|time| time + 1.0 - time.cos()).unwrap();
    assert!(matches!(found.trend(), Trend::Steady | Trend::Unknown) && found.change.abs() < 0.05, "{found:?}");
}

#[test]
fn what_may_hide_a_change_of_interest_is_no_steady_mean() {
    let of = |change: f64, standard_error: f64| Drift { change, standard_error, ..drift(|time| time).unwrap() }.trend();
    assert_eq!([of(0.01, 0.02), of(0.01, 0.021), of(-0.155, 0.084)], [Trend::Steady, Trend::Unknown, Trend::Unknown]);
    assert_eq!([of(0.05, 0.02), of(-0.05, 0.02)], [Trend::Rises, Trend::Falls]);
    // A hundredth is next to nothing, however well it is known.
    assert_eq!([of(0.01, 0.001), of(-0.01, 0.001), of(0.011, 0.001)], [Trend::Steady, Trend::Steady, Trend::Rises]);
}

#[test]
fn what_is_nothing_or_too_short_tells_nothing() {
    assert_eq!(drift(|_| 0.0), None);
    let time = [1.0, 2.0, 3.0, 4.0];
    assert_eq!(Drift::of(&Cumulative { time: &time, integral: &time, revolutions: &[] }, None), None);
    assert_eq!(Drift::of(&Cumulative { time: &[], integral: &[], revolutions: &[] }, None), None);
}

#[test]
fn a_pulse_of_the_papers_pin_is_what_its_fibres_need_to_wear_as_far() {
    let parameters = Parameters::paper();
    let mesh = &parameters.mesh;
    // Whole columns of fibre: their area is that part of the pin's. By hand: 46 of 161 columns of 32.2 mm², 5 µm deep, are
    // worn at 5e-14 1/Pa · 47 N · 22 mm · 89.0 rad/s.
    let base: Vec<Base> =
        (0..mesh.pin_cells()).map(|cell| if cell / mesh.rows() < 46 { Base::Primary } else { Base::Resin }).collect();
    let expected =
        5e-6 * (46.0 / 161.0 * mesh.pin_area()) / (5e-14 * 47.0 * 0.022 * 850.0 / 60.0 * std::f64::consts::TAU);
    let found = pulse_time(&parameters, &base).unwrap();
    assert!((found / expected - 1.0).abs() < 1e-12 && (9.0..11.0).contains(&found), "{found}, expected {expected}");
    assert_eq!(pulse_time(&parameters, &vec![Base::Primary; mesh.pin_cells()]), None);
    let everlasting = Materials { pin_primary: parameters.materials.disc_primary, ..parameters.materials };
    assert_eq!(pulse_time(&Parameters { materials: everlasting, ..parameters }, &base), None);
}
