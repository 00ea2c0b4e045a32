//! Heat at its limits: everything stays finite, keeps its energy, and takes no longer.

use std::sync::Arc;

use super::expected::{parameters, take};
use super::{CERMET, IRON, PAD, thermal};
use plateau_core::model::accounts::Accounts;
use plateau_core::model::cycle::{Cycle, Interpolation, Kind, Node};
use plateau_core::model::heat::account::HeatReport;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::thermal::{Coating, Disc, Factor, Pin, Substance, Thermal};

/// Whether temperatures are numbers not below the ambient, rounding apart, and the balance holds.
fn is_sound(report: &HeatReport) -> bool {
    let HeatReport { contact, disc, pin, face, share, lost, residual, .. } = *report;
    let least = 296.15 * (1.0 - 1e-12);
    // Faces and contacts may be hot beyond any measure, but not above 1e300.
    [contact, disc, pin, face].iter().all(|temperature| (least..1e300).contains(temperature))
        && (-1e-12..=1.0 + 1e-12).contains(&share)
        && (0.0..1e300).contains(&lost)
        && residual.abs() <= 1e-12
}

#[test]
fn any_conductivity_coating_speed_and_load_give_finite_temperatures() {
    let conductivities = [1e-12, 10.0, 1e12];
    let mut cases = 0;
    for (disc, pin) in conductivities.iter().flat_map(|disc| conductivities.iter().map(move |pin| (*disc, *pin))) {
        for (thickness, coating) in [(0.0, 15.0), (1e-9, 1e12), (60e-6, 1e-12), (1.0, 15.0)] {
            let coating = Coating { thickness, substance: Substance { conductivity: coating, ..CERMET } };
            let substance = Substance { conductivity: disc, ..IRON };
            let disc = Disc { substance, coating: Some(coating), ..thermal().disc };
            let pin = Pin { substance: Substance { conductivity: pin, ..PAD }, ..thermal().pin };
            // From 1e-6 to 1e6 of what brakes do: an interval lasts from 1e-6 s to weeks.
            for (speed, load) in [(1e-4, 1e3), (90.0, 47.0), (1e8, 1e-3), (90.0, 1e6)] {
                let thermal = Thermal { disc, pin, ..thermal() };
                let parameters =
                    Parameters { angular_velocity: speed, normal_force: load, ..parameters(thermal, None) };
                let mut accounts = Accounts::of(&parameters).unwrap();
                let mut before = 296.15;
                for number in 1..=30 {
                    take(&mut accounts, &parameters, number);
                    let report = accounts.report(number, parameters.step_angle(), 0.0, None).heat.unwrap();
                    assert!(is_sound(&report), "{thickness} {speed} {load} {disc:?} {pin:?}: {report:?}");
                    // Power that does not change warms.
                    assert!(report.contact >= before * (1.0 - 1e-12), "{before}, {report:?}");
                    before = report.contact;
                }
                cases += 1;
            }
        }
    }
    assert_eq!(cases, 144);
}

#[test]
fn factors_hold_at_2000_degrees() {
    let factor = Factor::new(vec![(300.0, 1.0), (2273.15, 0.1), (2274.15, 0.0)]).unwrap();
    let hot = Thermal { friction_factor: factor.clone(), wear_rate_factor: factor, ..thermal() };
    let parameters = Parameters { normal_force: 1e5, ..parameters(hot, None) };
    let mut accounts = Accounts::of(&parameters).unwrap();
    let mut hottest = 0.0_f64;
    for number in 1..=2000 {
        take(&mut accounts, &parameters, number);
        let report = accounts.report(number, parameters.step_angle(), 0.0, None);
        let heat = report.heat.unwrap();
        hottest = hottest.max(heat.contact);
        assert!(is_sound(&heat) && (0.0..=0.4).contains(&report.friction.unwrap().coefficient));
    }
    assert!(hottest > 2273.15, "{hottest}");
}

#[test]
fn a_pause_of_years_is_told_of_at_any_time_within_it() {
    let plain = Parameters { normal_force: 1000.0, ..parameters(thermal(), None) };
    let active = 30.0 * plain.step_time();
    let (load, speed, angle) = (plain.normal_force, plain.angular_velocity, plain.step_angle());
    for (length, kind) in [(1e6, Kind::Standing), (1e9, Kind::Standing), (1e6, Kind::Lifted), (1e9, Kind::Lifted)] {
        let (in_pause, slow) = if kind == Kind::Lifted { (0.0, speed) } else { (load, 0.0) };
        let rows = [
            (0.0, load, speed),
            (active, in_pause, slow),
            (active + length, load, speed),
            (2.0 * active + length, load, 0.0),
        ];
        let nodes = rows.map(|(time, force, speed)| Node::new(time, force, speed));
        let cycle = Cycle::new(&nodes, Interpolation::Hold, 1).unwrap();
        let parameters = Parameters { cycle: Some(Arc::new(cycle)), ..plain.clone() };
        let mut accounts = Accounts::of(&parameters).unwrap();
        (1..=30).for_each(|number| take(&mut accounts, &parameters, number));
        let mut before = accounts.report(30, angle, active, None).heat.unwrap();
        assert!(before.disc > 297.0);
        for elapsed in
            [1.0, 10.0, 999.95, 1000.25, 1e4, 1e5, 9e5, 1e8, 9.99e8].into_iter().filter(|time| *time < length)
        {
            let found = accounts.report(30, angle, active + elapsed, Some(kind)).heat.unwrap();
            assert!(found.residual.abs() <= 1e-12 && found.contact.is_nan() == (kind == Kind::Lifted), "{found:?}");
            // A lifted pin and its disc get colder each for itself; on each other, neither gets warmer than the warmer
            // one.
            let rounding = 1e-12 * before.disc;
            let warmer = before.disc.max(before.pin);
            let most = if kind == Kind::Lifted { [before.disc, before.pin] } else { [warmer; 2] };
            for (mean, most) in [found.disc, found.pin].into_iter().zip(most) {
                assert!(mean <= most + rounding && mean >= 296.15 - rounding, "{before:?} {found:?}");
            }
            assert!(found.lost >= before.lost * (1.0 - 1e-12), "{before:?} {found:?}");
            before = found;
        }
        take(&mut accounts, &parameters, 31);
        let after = accounts.report(31, angle, active + length + plain.step_time(), None).heat.unwrap();
        assert!((after.disc - 296.15).abs() < 1e-9 && (after.event_start - 296.15).abs() < 1e-9, "{after:?}");
        assert!(after.residual.abs() <= 1e-12);
    }
}
