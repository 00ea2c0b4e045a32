//! The acceleration that a run chooses.

use std::f64::consts::TAU;

use plateau_core::acceleration::{Adaptive, Choice, Chosen, RATIO};
use plateau_core::model::parameters::{Integrator, Parameters};

/// Smaller changes are not made.
const SMALLEST_CHANGE: f64 = 1.2;
/// Part of the time passed that a revolution may stand for, over the tolerance.
const GROWTH: f64 = 3.5;

/// The choice of a run with such windows and revolutions, s, in which no stiffness bounds it.
fn within(tolerance: f64, largest: f64, window: f64, revolution: f64) -> Choice {
    let parameters =
        Parameters { angular_velocity: TAU / revolution, integrator: Integrator::Exponential, ..Parameters::paper() };
    Choice::new(&Adaptive { tolerance, largest }, &parameters, 50.0 * window)
}

/// Looks 400 times, each after four simulated revolutions of 1 s at m = 1, of which those with m > 1 see `difference`; gives the
/// m of every look.
fn looks(choice: &mut Choice, difference: impl Fn(u32, f64) -> f64) -> Vec<f64> {
    let mut time = 0.0;
    let mut look = |number: u32| {
        let acceleration = choice.acceleration();
        let elapsed = f64::from(RATIO) * acceleration;
        time += elapsed;
        if acceleration > 1.0 {
            choice.note(difference(number, acceleration), elapsed, time);
        } else {
            choice.start(time);
        }
        acceleration
    };
    (0..400).map(&mut look).collect()
}

/// The last of them.
fn settled(mut choice: Choice, difference: impl Fn(u32, f64) -> f64) -> f64 {
    looks(&mut choice, difference).last().copied().unwrap()
}

#[test]
fn the_estimate_becomes_the_tolerance() {
    // By hand: where scout and run differ by 0.02 % per unit of m, AIM · 1 % is at m ln m/ln 4 = AIM · 50, m = 17.05.
    for sign in [1.0, -1.0] {
        let acceleration = settled(within(0.01, 1000.0, 1e6, 1.0), |_, m| sign * 2e-4 * m);
        assert!((17.05 / SMALLEST_CHANGE..=17.05 * SMALLEST_CHANGE).contains(&acceleration), "{acceleration}");
    }
}

#[test]
fn what_changes_its_sign_counts_too() {
    // ± 10 % from one look to the next is noise that means take away, but not all of it.
    let noise = |look: u32, _: f64| if look.is_multiple_of(2) { 0.1 } else { -0.1 };
    let noisy = settled(within(0.01, 1000.0, 3000.0, 1.0), noise);
    assert!(noisy < 20.0, "{noisy}");
}

#[test]
fn nothing_to_see_leads_to_the_largest() {
    let mut choice = within(0.01, 25.0, 100.0, 1.0);
    let largest = looks(&mut choice, |_, _| 0.0).last().copied().unwrap();
    assert!((largest / 25.0 - 1.0).abs() < 1e-6, "{largest}");
    let expected =
        Chosen { tolerance: 0.01, smallest: 1.0, largest: 25.0, last: 25.0, estimated_error: 0.0, met: true };
    assert_eq!(choice.chosen(1e4), expected);
    assert!(!within(0.01, 1.9, 100.0, 1.0).is_free());
}

#[test]
fn too_much_to_see_ends_the_acceleration_for_a_while_only() {
    let mut choice = within(0.01, 25.0, 100.0, 1.0);
    let accelerations = looks(&mut choice, |_, _| 0.5);
    let starts = accelerations.windows(2).filter(|two| two[0] == 1.0 && two[1] > 1.0).count();
    // Every start is seen to be too much at its first look, and the next is 1.1 times as late: from 57 s, 2/(3.5 · 1 %), until some
    // 1600 s there are 35.
    assert!((25..=40).contains(&starts), "{starts}");
    // Each has added what was seen: the tolerance is not met, and that is said.
    let chosen = choice.chosen(1600.0);
    assert!(!chosen.met && chosen.estimated_error > 0.5 && chosen.last == 1.0, "{chosen:?}");
}

#[test]
fn a_run_with_a_scout_is_never_slower_than_without_acceleration() {
    // Whatever is seen: revolutions of run and scout, over the time in revolutions of m = 1.
    let seen: [fn(u32, f64) -> f64; 4] =
        [|_, _| 0.0, |_, m| 2e-4 * m, |_, _| 0.5, |look, _| 0.02 * f64::from(look % 7)];
    for (difference, largest) in seen.into_iter().zip([25.0, 1000.0, 2.0, 7.3]) {
        let accelerations = looks(&mut within(0.01, largest, 100.0, 1.0), difference);
        let (mut taken, mut time) = (0.0, 0.0);
        for acceleration in accelerations {
            taken += if acceleration > 1.0 { f64::from(RATIO) + 1.0 } else { f64::from(RATIO) };
            time += f64::from(RATIO) * acceleration;
            assert!(taken <= time, "{taken} revolutions in {time}");
        }
    }
}

#[test]
fn no_revolution_stands_for_more_than_a_part_of_the_time_passed() {
    let mut choice = within(0.01, 1000.0, 1e6, 0.5);
    let mut time = 0.0;
    for look in 0..200 {
        let acceleration = choice.acceleration();
        let bound = (GROWTH * 0.01 * time / 0.5).max(1.0);
        assert!(acceleration <= bound, "look {look}: {acceleration}, at most {bound}");
        time += 4.0 * 0.5 * acceleration;
        if acceleration > 1.0 {
            choice.note(0.0, 4.0 * 0.5 * acceleration, time);
        } else {
            choice.start(time);
        }
    }
    // It has grown, and by no more than it must: by hand, by 4 · 3.5 % a look once it is above 1.
    assert!(choice.acceleration() > 900.0, "{}", choice.acceleration());
}
