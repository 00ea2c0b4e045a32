//! The chain against closed forms: slabs, lumps and thermal circuits (model 11 and 12).

use std::f64::consts::PI;

use super::{IRON, PAD, insulating_pin, off, thermal};
use plateau_core::model::heat::chain::{Chain, ChainReport, ChainState, Link, sub_steps};
use plateau_core::model::thermal::{Disc, Pin, Substance, Thermal};

/// Part of a body that is the layer next to the contact, and the one farthest from it: 1.4^k of Σ 1.4^k.
fn first_and_last() -> (f64, f64) {
    let whole = (1.4_f64.powi(8) - 1.0) / 0.4;
    (1.0 / whole, 1.4_f64.powi(7) / whole)
}

#[test]
fn a_slab_warms_as_a_half_space_until_its_back_is_felt() {
    // All of a flux q goes into a disc that nothing cools, without R: its face rises by 2 q √(t/π)/b.
    let disc = Disc { cooling: 0.0, ..thermal().disc };
    let chain = Chain::new(&Thermal { disc, pin: insulating_pin(), ..thermal() });
    let (power, effusivity, diffusivity) = (100.0, IRON.effusivity(), IRON.diffusivity());
    for reach in [0.1, 0.15, 0.2, 0.25] {
        // Heat gets √(a t) far; the back is felt as 2 √π ierfc(L/√(a t)) < 1e-6 of the rise.
        let time = (reach * disc.thickness).powi(2) / diffusivity;
        let mut state = ChainState::at_rest();
        let count = 4000;
        chain.advance(&mut state, count, time / count as f64, power, 0.0, Link::Closed(0.0));
        let expected = 2.0 * power / disc.area * (time / PI).sqrt() / effusivity;
        // Where a layer of thickness d at the depth x bends the profile, whose scale is ℓ = √(2 a t), a difference over
        // it is off by d²/(24 ℓ²). At the depth x a layer has d = d₀ + 0.4 x, so at x = ℓ this is (0.4 + d₀/ℓ)²/24. At
        // the face the mean of the first layer is d₀² Ṫ/(6 a) above the straight line: d₀²/(12 a t) of the rise. Time
        // adds 1/(2 count). What follows in the expansion is less by (d/ℓ)², a quarter: half as much again is allowed.
        let first = first_and_last().0 / reach;
        let allowed = 1.5 * ((0.4 + first / 2.0_f64.sqrt()).powi(2) / 24.0 + first * first / 12.0 + 0.5 / count as f64);
        let found = state.contact.unwrap();
        assert!(off(found, expected) < allowed, "{reach}: {found}, {expected}, {allowed}");
        assert!(off(state.into_disc, power) < 1e-12);
    }
}

#[test]
fn a_thin_slab_is_a_lump() {
    // It conducts so well that its layers have one temperature, to (L/λA)/(1/H) = 1e-12 of it.
    let substance = Substance { conductivity: 1e12, ..IRON };
    let disc = Disc { substance, cooling: 0.3, cooling_per_speed: 0.02, ..thermal().disc };
    let chain = Chain::new(&Thermal { disc, pin: insulating_pin(), ..thermal() });
    let capacity = 7200.0 * 500.0 * disc.area * disc.thickness;
    let (power, speed) = (80.0, 5.0);
    let cooling = 0.3 + 0.02 * speed;
    let lasting = capacity / cooling;
    for (count, time) in [(1, 0.1), (10, 0.1), (3000, 0.1), (3000, 0.01), (100, 20.0)] {
        let part = time / lasting;
        let mut state = ChainState::at_rest();
        chain.advance(&mut state, count, time, power, speed, Link::Closed(0.0));
        let warmed = chain.report(&state).disc;
        // Implicit Euler has a closed form of its own.
        let left = (1.0 + part).powi(-(count as i32));
        assert!(off(warmed, power / cooling * (1.0 - left)) < 1e-11, "{count} {time}");
        // With x = t/τ, (1 + dt/τ)^−n − e^−x is at most e^−x x dt/2τ, so at most dt/(2 e τ).
        let exponential = (-part * count as f64).exp();
        assert!((0.0..=part / (2.0 * 1.0_f64.exp())).contains(&(left - exponential)));
        assert!((warmed / (power / cooling) - (1.0 - exponential)).abs() <= part / (2.0 * 1.0_f64.exp()));
        // And it cools in the same way, whether the pin is on it or not.
        for link in [Link::Open, Link::Closed(2.0)] {
            let mut state = state.clone();
            chain.advance(&mut state, count, time, 0.0, speed, link);
            assert!(off(chain.report(&state).disc, warmed * left) < 1e-11, "{count} {time} {link:?}");
        }
    }
}

#[test]
fn in_the_end_it_is_a_circuit_of_resistances() {
    let (chain, (first, last)) = (Chain::new(&thermal()), first_and_last());
    let Thermal { disc, pin, .. } = thermal();
    let (power, resistance) = (60.0, 0.13);
    let mut state = ChainState::at_rest();
    // Much longer than any body takes.
    chain.advance(&mut state, 300_000, 0.1, power, 0.0, Link::Closed(resistance));
    // From the contact through all of the pin but half of its last layer to the holder; through R and half a layer to
    // the air.
    let through_pin = pin.length * (1.0 - last / 2.0) / (1.5 * pin.area) + 1.0 / 0.02;
    let through_disc = resistance + disc.thickness * first / 2.0 / (50.0 * disc.area) + 1.0 / 0.4;
    let contact = power / (1.0 / through_pin + 1.0 / through_disc);
    assert!(off(state.contact.unwrap(), contact) < 1e-11);
    assert!(off(state.into_disc, contact / through_disc) < 1e-11);
    assert!(off(chain.report(&state).disc, contact / through_disc / 0.4) < 1e-11);
}

#[test]
fn a_contact_that_closes_has_the_temperature_between_the_first_layers() {
    let (chain, (first, _)) = (Chain::new(&thermal()), first_and_last());
    let mut state = ChainState::at_rest();
    chain.advance(&mut state, 50, 0.1, 70.0, 0.0, Link::Closed(0.2));
    chain.advance(&mut state, 1, 1e-9, 0.0, 0.0, Link::Open);
    assert_eq!((state.contact, state.into_disc), (None, 0.0));
    let closing = chain.closing(&state, 1.7);
    // No power: what leaves the pin's first layer enters the disc's, so the contact parts their difference as the
    // resistances.
    let mut closed = state.clone();
    chain.advance(&mut closed, 1, 1e-9, 0.0, 0.0, Link::Closed(1.7));
    assert!(off(closing, closed.contact.unwrap()) < 1e-6);
    // From below and from above: with R → ∞ it is that of the pin, which is the warmer one.
    let (pin, disc) = (chain.closing(&state, 1e12), chain.closing(&state, 0.0));
    let half = 12e-3 * first / 2.0 / (1.5 * 78.5e-6);
    let half_disc = 6e-3 * first / 2.0 / (50.0 * 31e-4);
    let expected = pin - (pin - disc) * (half + half_disc) / (half + half_disc + 1.7);
    assert!(disc < closing && closing < pin && off(closing, expected) < 1e-9, "{disc} {closing} {pin} {expected}");
}

/// θ of the contact, means of disc and pin, K, and heat lost, J, by another program: a dense matrix of 17 nodes, the
/// contact among them, written in Python after model 11 and solved for the temperatures with LAPACK, whose rounding the
/// tolerance is for.
const BY_ANOTHER_PROGRAM: [[f64; 4]; 3] = [
    [43.311297083296346, 35.10305292849252, 16.391237279629802, 553.368699397493],
    [f64::NAN, 31.169170951375605, 15.227410432131109, 819.3468368286375],
    [27.955529603817492, 28.437994629232595, 16.459246775776915, 999.5110911436938],
];

#[test]
fn it_is_what_another_program_makes_of_it() {
    let disc = Disc { cooling_per_speed: 0.002, ..thermal().disc };
    let (chain, mut state) = (Chain::new(&Thermal { disc, ..thermal() }), ChainState::at_rest());
    let stages = [
        (700, 0.07, 60.0, 90.0, Link::Closed(0.13)),
        (200, 0.1, 0.0, 0.0, Link::Open),
        (150, 0.1, 0.0, 0.0, Link::Closed(1.7)),
    ];
    for ((count, time, power, speed, link), expected) in stages.into_iter().zip(BY_ANOTHER_PROGRAM) {
        chain.advance(&mut state, count, time, power, speed, link);
        let ChainReport { disc, pin, lost, .. } = chain.report(&state);
        let found = [state.contact.unwrap_or(f64::NAN), disc, pin, lost];
        let agrees =
            |(found, expected): (&f64, &f64)| off(*found, *expected) < 1e-11 || (found.is_nan() && expected.is_nan());
        assert!(found.iter().zip(&expected).all(agrees), "{link:?}: {found:?}, {expected:?}");
    }
}

#[test]
fn sub_steps_are_at_most_a_tenth_of_a_second() {
    let times = [1e-12, 0.05, 0.1, 0.1000001, 0.3, 0.35, 1.0, 1e6, 1e9];
    assert_eq!(times.map(sub_steps), [1, 1, 1, 2, 3, 4, 10, 10_000_000, 10_000_000_000]);
}

#[test]
fn bodies_at_extremes_stay_finite_and_keep_their_heat() {
    for disc_conductivity in [1e-12, 50.0, 1e12] {
        for pin_conductivity in [1e-12, 1.5, 1e12] {
            for (power, resistance, time) in
                [(2000.0, 0.1, 0.0706), (1e-9, 0.0, 1e-6), (1e6, 1e12, 0.1), (0.0, 1.0, 0.1)]
            {
                let substance = Substance { conductivity: disc_conductivity, ..IRON };
                let disc = Disc { substance, ..thermal().disc };
                let pin = Pin { substance: Substance { conductivity: pin_conductivity, ..PAD }, ..thermal().pin };
                let chain = Chain::new(&Thermal { disc, pin, ..thermal() });
                let mut state = ChainState::at_rest();
                let mut last = ChainReport { disc: 0.0, pin: 0.0, lost: 0.0, residual: 0.0 };
                let what = format!("{disc_conductivity:e} {pin_conductivity:e} {power} {resistance} {time}");
                for interval in 0..300 {
                    // Two thirds under power, one third lifted.
                    let (power, link) =
                        if interval < 200 { (power, Link::Closed(resistance)) } else { (0.0, Link::Open) };
                    chain.advance(&mut state, 1, time, power, 0.0, link);
                    let report = chain.report(&state);
                    let ChainReport { disc, pin, lost, residual } = report;
                    assert!(
                        [disc, pin, lost].iter().all(|value| value.is_finite() && *value >= 0.0),
                        "{what}: {report:?}"
                    );
                    assert!(residual.abs() <= 1e-12, "{what}: {report:?}");
                    // Under power that does not change everything gets warmer, without it colder; rounding apart.
                    let rises =
                        [disc - last.disc, pin - last.pin].map(|rise| if interval < 200 { rise } else { -rise });
                    let rounding = 1e-13 * (disc + pin + last.disc + last.pin);
                    assert!(rises.iter().all(|rise| *rise >= -rounding), "{what}: {last:?}, {report:?}");
                    assert!(lost >= last.lost);
                    assert_eq!(state.contact.is_some_and(f64::is_finite), interval < 200, "{what}");
                    last = report;
                }
            }
        }
    }
}
