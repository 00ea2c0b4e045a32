//! Intervals and pauses of the accounts, driven step by step without any surface (model 11, order).

use super::expected::{Expected, MU, WORN, parameters, take};
use super::{IRON, insulating_pin, off, thermal};
use plateau_core::model::accounts::Accounts;
use plateau_core::model::cycle::{Cycle, Interpolation, Kind, Node};
use plateau_core::model::parameters::Parameters;
use plateau_core::model::thermal::{Disc, Factor, Substance, Thermal};

#[test]
fn an_interval_is_a_revolution_and_nothing_changes_within_it() {
    let parameters = parameters(Thermal { friction_factor: Factor::default(), ..thermal() }, None);
    let (mut accounts, mut expected) = (Accounts::of(&parameters).unwrap(), Expected::new(&parameters));
    let report = |accounts: &Accounts, number| accounts.report(number, parameters.step_angle(), 0.0, None);
    for number in 1..=200_u64 {
        take(&mut accounts, &parameters, number);
        if number % 10 == 0 {
            // 10 steps of 20 columns each: 20 revolutions.
            let time = 20.0 * std::f64::consts::TAU / parameters.angular_velocity;
            expected.interval(time, parameters.normal_force, parameters.angular_velocity, 1.0);
        }
        let found = report(&accounts, number);
        assert!(expected.agrees(&found), "{number}: {found:?}, {:?}", expected.state);
        // PM10 is φ₁₀ ρ times the emitted volume at once, particles are counted with the interval.
        let emission = found.emission.unwrap();
        assert!(off(emission.pm10, 0.4 * 2600.0 * WORN * number as f64) < 1e-14);
        assert!(off(emission.pm25, 0.15 * 2600.0 * WORN * number as f64) < 1e-14);
        assert_eq!(emission.number > 0.0, number >= 10);
    }
    let heat = report(&accounts, 200).heat.unwrap();
    assert!(heat.contact > heat.face && heat.face > heat.disc && heat.residual.abs() < 1e-14);
    assert_eq!((heat.event_start, heat.event_peak), (296.15, heat.contact));
}

#[test]
fn factors_hold_from_the_end_of_an_interval_to_that_of_the_next() {
    // As steep as they can be.
    let factor = |other| Factor::new(vec![(300.0, 1.0), (320.0, other)]).unwrap();
    let hot = Thermal { friction_factor: factor(0.5), wear_rate_factor: factor(4.0), ..thermal() };
    let parameters = parameters(hot, None);
    let (mut accounts, mut expected) = (Accounts::of(&parameters).unwrap(), Expected::new(&parameters));
    let (mut friction, mut wear, mut number_of_particles) = (1.0, 1.0, 0.0);
    let time = 20.0 * std::f64::consts::TAU / parameters.angular_velocity;
    for number in 1..=300_u64 {
        assert!((accounts.wear_rate_factor() - wear).abs() < 1e-9, "{number}");
        take(&mut accounts, &parameters, number);
        let found = accounts.report(number, parameters.step_angle(), 0.0, None);
        assert!((found.friction.unwrap().coefficient - friction * MU).abs() < 1e-9, "{number}");
        if number % 10 == 0 {
            expected.interval(time, parameters.normal_force, parameters.angular_velocity, friction);
            let temperature = 296.15 + expected.state.contact.unwrap();
            let part = ((temperature - 300.0) / 20.0).clamp(0.0, 1.0);
            (friction, wear) = (1.0 - 0.5 * part, 1.0 + 3.0 * part);
            // f_N goes from 1 to 3 between 300 K and 500 K.
            let factor = 1.0 + 2.0 * ((temperature - 300.0) / 200.0).clamp(0.0, 1.0);
            number_of_particles += 10.0 * 1e15 * 0.4 * 2600.0 * WORN * factor;
            assert!(off(found.emission.unwrap().number, number_of_particles) < 1e-10, "{number}");
        }
    }
    assert!(wear > 1.1, "it has become warm enough to show: {wear}");
}

/// Two pauses after 25 steps, one of each kind, in a table of constant load and speed; the 26th step has none.
fn braking(parameters: &Parameters) -> (Cycle, f64) {
    let active = 25.0 * parameters.step_time();
    let (load, speed) = (parameters.normal_force, parameters.angular_velocity);
    let rows = [
        (0.0, load, speed),
        (active, 0.0, speed),
        (active + 1.05, load, 0.0),
        (active + 1.85, load, speed),
        (2.0 * active + 1.85, load, speed),
    ];
    let nodes = rows.map(|(time, force, speed)| Node::new(time, force, speed));
    (Cycle::new(&nodes, Interpolation::Hold, 3).unwrap(), active)
}

#[test]
fn a_pause_ends_the_interval_and_is_reported_sub_step_by_sub_step() {
    let plain = parameters(thermal(), None);
    let (cycle, active) = braking(&plain);
    let parameters = parameters(thermal(), Some(cycle));
    let (load, speed, angle) = (plain.normal_force, plain.angular_velocity, plain.step_angle());
    let (mut accounts, mut expected) = (Accounts::of(&parameters).unwrap(), Expected::new(&parameters));
    (1..=25).for_each(|number| take(&mut accounts, &parameters, number));
    let revolution = 10.0 * plain.step_time();
    (0..2).for_each(|_| expected.interval(revolution, load, speed, 1.0));
    expected.interval(0.5 * revolution, load, speed, 1.0);
    // At the end of the step, before the pause.
    let before = accounts.report(25, angle, active, None);
    assert!(expected.agrees(&before), "{before:?}, {:?}", expected.state);
    // Lifted for 1.05 s, in 11 sub-steps; then standing for 0.8 s in 8.
    let moments = (0..=10).map(|ended| (Kind::Lifted, ended)).chain((0..=7).map(|ended| (Kind::Standing, ended)));
    for (kind, ended) in moments {
        let (start, length, count) = match kind {
            Kind::Lifted => (active, 1.05, 11.0),
            _ => (active + 1.05, 0.8, 8.0),
        };
        for part in [0.0, 0.01, 0.5, 0.99] {
            let time = start + length * (ended as f64 + part) / count;
            let mut then = expected.clone();
            if kind == Kind::Standing {
                then.pause(1.05, 11, Kind::Lifted);
            }
            if ended > 0 {
                then.pause(length, ended, kind);
            }
            let found = accounts.report(25, angle, time, Some(kind));
            assert!(then.agrees(&found), "{kind:?} {ended} {part}: {found:?}, {:?}", then.state);
            let coefficient = found.friction.unwrap().coefficient;
            assert!(if kind == Kind::Lifted { coefficient.is_nan() } else { coefficient == MU });
        }
    }
    // None of these reports has changed anything.
    assert_eq!(format!("{before:?}"), format!("{:?}", accounts.report(25, angle, active, None)));
    expected.pause(1.05, 11, Kind::Lifted);
    expected.pause(0.8, 8, Kind::Standing);
    take(&mut accounts, &parameters, 26);
    let after = accounts.report(26, angle, active + 1.85 + plain.step_time(), None);
    assert!(expected.agrees(&after), "{after:?}, {:?}", expected.state);
    assert_eq!(after.heat.unwrap().event_start, after.heat.unwrap().contact);
    assert!(after.heat.unwrap().event_peak.is_nan() && after.heat.unwrap().share == 0.0);
    // A whole revolution from then on is the next interval.
    (27..=35).for_each(|number| take(&mut accounts, &parameters, number));
    expected.interval(revolution, load, speed, 1.0);
    let found = accounts.report(35, angle, 0.0, None);
    assert!(expected.agrees(&found), "{found:?}, {:?}", expected.state);
}

#[test]
fn a_lumped_disc_under_lifted_pads_is_cooled_at_its_speed() {
    // A disc that conducts so well that it has one temperature: from θ it falls as exp(−∫(H₀ + H₁ω)dt/C).
    let (at_rest, per_speed) = (0.4, 0.01);
    let substance = Substance { conductivity: 1e12, ..IRON };
    let disc = Disc { substance, cooling: at_rest, cooling_per_speed: per_speed, coating: None, ..thermal().disc };
    let lumped = Thermal { disc, pin: insulating_pin(), ..thermal() };
    let capacity = 7200.0 * 500.0 * disc.area * disc.thickness;
    let plain = parameters(lumped.clone(), None);
    let (load, speed, angle) = (plain.normal_force, plain.angular_velocity, plain.step_angle());
    let active = 20.0 * plain.step_time();
    // Lifted: on at this speed for 30 s, up to three times as fast in 10 s, down to rest in 20 s, and 15 s there.
    let rows = [
        (0.0, load, speed),
        (active, load, speed),
        (active, 0.0, speed),
        (active + 30.0, 0.0, speed),
        (active + 40.0, 0.0, 3.0 * speed),
        (active + 60.0, 0.0, 0.0),
        (active + 75.0, 0.0, 0.0),
    ];
    let nodes = rows.map(|(time, force, speed)| Node::new(time, force, speed));
    let parameters = parameters(lumped, Some(Cycle::new(&nodes, Interpolation::Linear, 1).unwrap()));
    let mut accounts = Accounts::of(&parameters).unwrap();
    (1..=20).for_each(|number| take(&mut accounts, &parameters, number));
    let warmed = accounts.report(20, angle, active, None).heat.unwrap().disc - 296.15;
    // By hand: ∫ω dt in speeds times s, until the end of each part.
    for (end, turned) in [(30.0, 30.0), (40.0, 30.0 + 20.0), (60.0, 50.0 + 30.0), (75.0, 80.0)] {
        let left = (accounts.report(20, angle, active + end, Some(Kind::Lifted)).heat.unwrap().disc - 296.15) / warmed;
        let exponent = (at_rest * end + per_speed * speed * turned) / capacity;
        // Implicit Euler lies above an exponential, by at most Σ(H Δt/C)²/2 in its logarithm, H at most that of twice the speed.
        let slower = (at_rest + 2.0 * per_speed * speed) / capacity * 0.1 * exponent / 2.0;
        let above = left.ln() + exponent;
        assert!((-1e-9..=slower).contains(&above), "{end} s: {left}, {above} above, at most {slower}");
    }
}

#[test]
fn a_lifted_contact_leaves_the_factors_as_they_were() {
    let factor = Factor::new(vec![(296.0, 1.0), (330.0, 3.0)]).unwrap();
    let hot = Thermal { wear_rate_factor: factor.clone(), ..thermal() };
    let plain = parameters(hot.clone(), None);
    let active = 20.0 * plain.step_time();
    let speed = plain.angular_velocity;
    for kind in [Kind::Lifted, Kind::Standing] {
        let (load, slow) = if kind == Kind::Lifted { (0.0, speed) } else { (plain.normal_force, 0.0) };
        let rows = [(0.0, plain.normal_force, speed), (active, load, slow), (active + 30.0, plain.normal_force, speed)];
        let rows = rows.into_iter().chain([(2.0 * active + 30.0, 0.0, 0.0)]);
        let nodes: Vec<Node> = rows.map(|(time, force, speed)| Node::new(time, force, speed)).collect();
        let cycle = Cycle::new(&nodes, Interpolation::Hold, 1).unwrap();
        let parameters = parameters(hot.clone(), Some(cycle));
        let mut accounts = Accounts::of(&parameters).unwrap();
        (1..=20).for_each(|number| take(&mut accounts, &parameters, number));
        let before = accounts.wear_rate_factor();
        let heated = accounts.report(20, parameters.step_angle(), active, None).heat.unwrap();
        accounts.begin(21, parameters.step_angle());
        let after = accounts.wear_rate_factor();
        let cooled = accounts.report(20, parameters.step_angle(), active + 30.0, None).heat.unwrap();
        if kind == Kind::Lifted {
            // The factor was read at the end of the first revolution; that of the second ended with the pause.
            assert!(before == after && before < factor.at(heated.contact), "{before} {after}");
            assert!(cooled.contact.is_nan());
        } else {
            assert!(after == factor.at(cooled.contact) && cooled.contact < heated.contact, "{before} {after}");
        }
    }
}

#[test]
fn pauses_before_the_first_step_and_after_the_last_are_taken_too() {
    let plain = parameters(thermal(), None);
    let (load, speed, angle) = (plain.normal_force, plain.angular_velocity, plain.step_angle());
    // Standing for 2 s, 7.5 steps, lifted for 3 s, a quarter of a step, standing for 1 s; 7 steps are taken.
    let active = 7.5 * plain.step_time();
    let quarter = 0.25 * plain.step_time();
    let end = 2.0 + active + 3.0 + quarter;
    let rows = [
        (0.0, load, 0.0),
        (2.0, load, speed),
        (2.0 + active, 0.0, 0.0),
        (5.0 + active, load, speed),
        (end, load, 0.0),
        (end + 1.0, 0.0, 0.0),
    ];
    let nodes = rows.map(|(time, force, speed)| Node::new(time, force, speed));
    let parameters = parameters(thermal(), Some(Cycle::new(&nodes, Interpolation::Hold, 1).unwrap()));
    let (mut accounts, mut expected) = (Accounts::of(&parameters).unwrap(), Expected::new(&parameters));
    assert!(expected.agrees(&accounts.report(0, angle, 1.5, Some(Kind::Standing))));
    (1..=7).for_each(|number| take(&mut accounts, &parameters, number));
    // No interval has ended until the pause ends it, in the midst of a step that is not taken.
    assert!(expected.agrees(&accounts.report(7, angle, 2.0 + 7.0 * plain.step_time(), None)));
    expected.interval(7.0 * plain.step_time(), load, speed, 1.0);
    expected.pause(3.0, 15, Kind::Lifted);
    let found = accounts.report(7, angle, 2.0 + active + 1.51, Some(Kind::Lifted));
    assert!(expected.agrees(&found), "{found:?}, {:?}", expected.state);
    expected.pause(3.0, 15, Kind::Lifted);
    expected.pause(1.0, 10, Kind::Standing);
    let found = accounts.report(7, angle, end + 1.0, Some(Kind::Standing));
    assert!(expected.agrees(&found), "{found:?}, {:?}", expected.state);
}

#[test]
fn a_pause_after_a_step_that_has_pauses_itself_is_not_forgotten() {
    let plain = parameters(thermal(), None);
    let (load, speed, angle) = (plain.normal_force, plain.angular_velocity, plain.step_angle());
    // Two steps, the second with a pause of 2 s within; then half a step and a pause of 3 s, which ends the run.
    let (first, rest) = (1.5 * plain.step_time(), plain.step_time());
    let rows = [
        (0.0, load, speed),
        (first, load, 0.0),
        (first + 2.0, load, speed),
        (first + 2.0 + rest, load, 0.0),
        (first + 5.0 + rest, 0.0, 0.0),
    ];
    let nodes = rows.map(|(time, force, speed)| Node::new(time, force, speed));
    let parameters = parameters(thermal(), Some(Cycle::new(&nodes, Interpolation::Hold, 1).unwrap()));
    let (mut accounts, mut expected) = (Accounts::of(&parameters).unwrap(), Expected::new(&parameters));
    (1..=2).for_each(|number| take(&mut accounts, &parameters, number));
    expected.interval(2.0 * plain.step_time(), load, speed, 1.0);
    expected.pause(2.0, 20, Kind::Standing);
    let found = accounts.report(2, angle, first + 2.0 + 0.5 * plain.step_time(), None);
    assert!(expected.agrees(&found), "{found:?}, {:?}", expected.state);
    expected.pause(3.0, 30, Kind::Standing);
    let found = accounts.report(2, angle, first + 5.0 + rest, Some(Kind::Standing));
    assert!(expected.agrees(&found), "{found:?}, {:?}", expected.state);
}
