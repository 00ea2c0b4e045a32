//! Very many sub-steps, which are taken at once: the same as one after the other.

use super::{IRON, PAD, off, thermal};
use plateau_core::model::heat::chain::{Chain, ChainReport, ChainState, Link, sub_steps};
use plateau_core::model::thermal::{Disc, Pin, Substance, Thermal};

/// So few sub-steps are taken one by one.
const FEW: u64 = 10_000;

/// A chain with these conductivities, with a part of its cooling.
fn chain(disc_conductivity: f64, pin_conductivity: f64, cooling: f64) -> Chain {
    let Thermal { disc, pin, .. } = thermal();
    let substance = Substance { conductivity: disc_conductivity, ..IRON };
    let disc = Disc { substance, cooling: cooling * disc.cooling, ..disc };
    let substance = Substance { conductivity: pin_conductivity, ..PAD };
    let pin = Pin { substance, cooling: cooling * pin.cooling, ..pin };
    Chain::new(&Thermal { disc, pin, ..thermal() })
}

/// After a minute of friction.
fn warm(chain: &Chain) -> ChainState {
    let mut state = ChainState::at_rest();
    chain.advance(&mut state, 600, 0.1, 70.0, 90.0, Link::Closed(0.1));
    state
}

#[test]
fn many_sub_steps_at_once_are_those_one_by_one() {
    let cooled = [(50.0, 1.5, 1.0), (50.0, 1.5, 1e-3), (50.0, 1.5, 0.0), (1e12, 1.5, 1.0), (50.0, 1e12, 1e-3)];
    for (disc, pin, cooling) in cooled.into_iter().chain([(1e-12, 1e12, 1.0), (1e-12, 1e-12, 0.0), (1e3, 0.1, 1e-6)]) {
        for (power, link) in [(0.0, Link::Open), (0.0, Link::Closed(1.7)), (3.0, Link::Closed(0.1))] {
            let (chain, rounds) = (chain(disc, pin, cooling), 12);
            let [mut one_by_one, mut at_once] = [warm(&chain), warm(&chain)];
            (0..rounds).for_each(|_| chain.advance(&mut one_by_one, FEW, 0.1, power, 0.0, link));
            chain.advance(&mut at_once, rounds * FEW, 0.1, power, 0.0, link);
            let what = format!("{disc:e} {pin:e} {cooling:e} {link:?}");
            let [one, other] = [&one_by_one, &at_once].map(|state| chain.report(state));
            // Against how warm it was, or got.
            let start = chain.report(&warm(&chain));
            let scale = start.disc.max(one.disc).max(start.pin).max(one.pin);
            assert!((one.disc - other.disc).abs() <= 1e-12 * scale, "{what}: {one:?}, {other:?}");
            assert!((one.pin - other.pin).abs() <= 1e-12 * scale, "{what}: {one:?}, {other:?}");
            assert!((one.lost - other.lost).abs() <= 1e-12 * one.lost, "{what}: {one:?}, {other:?}");
            assert!(one.residual.abs() <= 1e-12 && other.residual.abs() <= 1e-12, "{what}: {one:?}, {other:?}");
            match (one_by_one.contact, at_once.contact) {
                (Some(one), Some(other)) => assert!((one - other).abs() <= 1e-12 * scale, "{what}: {one}, {other}"),
                (one, other) => assert_eq!(one, other),
            }
        }
    }
}

#[test]
fn a_pause_of_years_brings_all_to_the_ambient_and_no_colder() {
    let chain = chain(50.0, 1.5, 1.0);
    for link in [Link::Open, Link::Closed(1.7)] {
        let mut before = chain.report(&warm(&chain));
        for length in [1.0, 1e2, 1e3, 1.1e3, 1e4, 1e6, 1e9] {
            let mut state = warm(&chain);
            let count = sub_steps(length);
            chain.advance(&mut state, count, length / count as f64, 0.0, 0.0, link);
            let report = chain.report(&state);
            let ChainReport { disc, pin, lost, residual } = report;
            // What is left after a long pause is rounding.
            let rounding = 1e-15 * chain.report(&warm(&chain)).disc;
            assert!(
                disc >= -rounding && pin >= -rounding && lost >= before.lost * (1.0 - 1e-14),
                "{length}: {report:?}"
            );
            assert!(disc <= before.disc + rounding && residual.abs() <= 1e-12, "{length}: {report:?}");
            before = report;
        }
        assert!(before.disc.abs() < 1e-12 && before.pin.abs() < 1e-12, "{before:?}");
    }
}

#[test]
fn what_nothing_cools_keeps_its_heat_for_years_and_shares_it() {
    let chain = chain(50.0, 1.5, 0.0);
    let start = warm(&chain);
    let ChainReport { disc, pin, .. } = chain.report(&start);
    let [disc_capacity, pin_capacity] = [7200.0 * 500.0 * 31e-4 * 6e-3, 2600.0 * 900.0 * 78.5e-6 * 12e-3];
    let shared = (disc_capacity * disc + pin_capacity * pin) / (disc_capacity + pin_capacity);
    for count in [100_000_u64, 10_000_000, 10_000_000_000] {
        // On each other, both come to the mean; apart, each to its own.
        for (link, ends) in [(Link::Closed(1.7), [shared, shared]), (Link::Open, [disc, pin])] {
            let mut state = start.clone();
            chain.advance(&mut state, count, 0.1, 0.0, 0.0, link);
            let report = chain.report(&state);
            assert!(off(report.disc, ends[0]) < 1e-12 && off(report.pin, ends[1]) < 1e-12, "{link:?}: {report:?}");
            assert!(report.lost == 0.0 && report.residual.abs() < 1e-12, "{link:?}: {report:?}");
        }
    }
}

#[test]
fn bodies_of_very_unlike_capacity_keep_their_heat_and_get_no_colder_than_the_ambient() {
    let scales = [1e-9, 1.0, 1e9];
    let bodies = scales.iter().flat_map(|disc| scales.iter().map(move |pin| (*disc, *pin)));
    let cases = bodies.flat_map(|body| [1e-3, 1e4].into_iter().map(move |conductivity| (body, conductivity)));
    for ((disc_scale, pin_scale), conductivity) in cases {
        for cooling in [[0.4, 0.02], [4e-5, 0.0], [0.0, 2e-8], [0.0, 0.0]] {
            let scaled = |body: Substance, scale: f64, conductivity: f64| Substance {
                density: scale * body.density,
                conductivity: conductivity * body.conductivity,
                ..body
            };
            let disc = Disc { substance: scaled(IRON, disc_scale, 1.0), cooling: cooling[0], ..thermal().disc };
            let pin = Pin { substance: scaled(PAD, pin_scale, conductivity), cooling: cooling[1], ..thermal().pin };
            let chain = Chain::new(&Thermal { disc, pin, ..thermal() });
            let start = warm(&chain);
            for (power, link) in [(0.0, Link::Open), (0.0, Link::Closed(1.7)), (60.0, Link::Closed(0.1))] {
                for count in [FEW + 1, 1_000_000, 3_000_000_000] {
                    let mut state = start.clone();
                    chain.advance(&mut state, count, 0.1, power, 0.0, link);
                    let what = format!("{disc_scale} {pin_scale} {conductivity} {cooling:?} {power} {link:?} {count}");
                    let ChainReport { disc, pin, residual, .. } = chain.report(&state);
                    assert!(
                        disc >= 0.0 && pin >= 0.0 && residual.abs() < 1e-13,
                        "{what}: {disc:e} {pin:e} {residual:e}"
                    );
                }
                let [mut one_by_one, mut at_once] = [start.clone(), start.clone()];
                (0..2).for_each(|_| chain.advance(&mut one_by_one, FEW, 0.1, power, 0.0, link));
                chain.advance(&mut at_once, 2 * FEW, 0.1, power, 0.0, link);
                let [start, one, other] = [&start, &one_by_one, &at_once].map(|state| chain.report(state));
                let scale = start.disc.max(one.disc).max(start.pin).max(one.pin);
                let what = format!("{disc_scale} {pin_scale} {conductivity} {cooling:?} {power} {link:?}");
                assert!((one.disc - other.disc).abs() <= 1e-12 * scale, "{what}: {one:?}, {other:?}");
                assert!((one.pin - other.pin).abs() <= 1e-12 * scale, "{what}: {one:?}, {other:?}");
                assert!((one.lost - other.lost).abs() <= 1e-12 * one.lost, "{what}: {one:?}, {other:?}");
            }
        }
    }
}
