//! Events and their accounts.

use std::f64::consts::TAU;

use plateau_core::model::accounts::AccountsReport;
use plateau_core::model::cycle::{Cycle, Interpolation, Kind, Node};
use plateau_core::model::emission::EmissionReport;
use plateau_core::model::friction::FrictionReport;
use plateau_core::model::heat::account::HeatReport;
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::Parameters;
use plateau_core::observe::Sample;
use plateau_core::observe::event::EventLog;

/// Ten revolutions a second for a second, a second of rest, five revolutions: steps of half a revolution on two columns.
fn log(until: f64) -> EventLog {
    let paper = Parameters::paper();
    let mesh = Mesh::new(1, 2, 1, 1.0, 3.0).unwrap();
    let parameters = Parameters { mesh, ..paper };
    let node = |time, force| Node::new(time, force, 10.0 * TAU);
    let nodes = [node(0.0, 1.0), node(1.0, 1.0), node(1.0, 0.0), node(2.0, 0.0), node(2.0, 1.0), node(2.5, 1.0)];
    let cycle = Cycle::new(&nodes, Interpolation::Linear, 1).unwrap();
    EventLog::new(&parameters, Some(&cycle), until, cycle.steps_done(until, parameters.step_angle()))
}

fn sample(step: u64) -> Sample {
    let (worn, area) = (step as f64, 100.0 + step as f64);
    let friction = FrictionReport { coefficient: 0.4, coefficient_mean: 0.4, work: 4.0 * worn, load_work: 10.0 * worn };
    let heat = HeatReport {
        contact: 400.0,
        disc: 300.0,
        pin: 300.0,
        face: 390.0,
        share: 0.9,
        lost: 0.0,
        residual: 0.0,
        event_start: 350.0,
        event_peak: 300.0 + worn,
    };
    let emission = EmissionReport { mass: worn, pm10: 0.4 * worn, pm25: 0.1 * worn, number: 3.0 * worn };
    let accounts = AccountsReport { friction: Some(friction), heat: Some(heat), emission: Some(emission) };
    Sample { step, worn_pin: worn, emitted: 0.5 * worn, contact_area: area, accounts, ..Sample::default() }
}

#[test]
fn each_event_has_what_was_worn_between_its_ends() {
    let mut log = log(2.5);
    let mut asked = Vec::new();
    let mut done = 0;
    while let Some(step) = log.next(done) {
        asked.push(step);
        log.note(&sample(step));
        done = step;
    }
    assert_eq!(asked, [1, 20, 21, 30]);
    let [first, second] = log.progress().records[..] else { panic!("{log:?}") };
    assert_eq!((first.start, first.end, second.start, second.end), (0.0, 1.0, 2.0, 2.5));
    assert_eq!((first.worn, second.worn, second.emitted), (20.0, 10.0, 5.0));
    assert_eq!((first.contact_area_start, first.contact_area_end), (101.0, 120.0));
    assert_eq!((second.contact_area_start, second.contact_area_end), (121.0, 130.0));
    assert_eq!((first.work, second.work, second.friction_coefficient), (80.0, 40.0, 0.4));
    assert_eq!((second.temperature_start, second.temperature_peak), (350.0, 330.0));
    assert_eq!((first.pm10_mass, second.particle_number), (8.0, 30.0));
    // Ten and five revolutions at a mean radius of 2 m.
    assert!((first.distance - 20.0 * TAU).abs() < 1e-9 && (second.distance - 10.0 * TAU).abs() < 1e-9);
}

#[test]
fn an_event_that_the_end_of_a_run_cut_short_goes_on_with_a_longer_one() {
    let (mut whole, mut log) = (self::log(2.5), self::log(2.2));
    for step in [1, 20, 21, 24] {
        whole.note(&sample(step));
        log.note(&sample(step));
    }
    assert_eq!((log.progress().records.len(), log.progress().records[1].worn), (2, 4.0));
    let kept = log.progress().clone();
    log = self::log(2.5);
    log.restore(kept);
    assert_eq!((log.progress().records.len(), log.next(24)), (1, Some(30)));
    whole.note(&sample(30));
    log.note(&sample(30));
    assert_eq!(log.progress().records, whole.progress().records);
    assert_eq!(log.progress().records[1].worn, 10.0);
}

#[test]
fn a_log_that_was_kept_within_an_event_goes_on() {
    let (mut whole, mut stopped) = (log(2.5), log(2.5));
    for step in [1, 20, 21, 30] {
        whole.note(&sample(step));
        stopped.note(&sample(step));
        let kept = serde_json::to_string(stopped.progress()).unwrap();
        stopped = log(2.5);
        stopped.restore(serde_json::from_str(&kept).unwrap());
    }
    assert_eq!(stopped.progress(), whole.progress());
}

/// Event 1 has 20.4 steps, event 2 less than one: a run that ends after both has 20, so that a pause ends each within a step that is not
/// taken; in a longer run the 21st is that of event 1.
#[test]
fn events_that_end_within_a_step_that_is_not_taken_have_the_account_of_their_pause() {
    let mesh = Mesh::new(1, 2, 1, 1.0, 3.0).unwrap();
    let parameters = Parameters { mesh, ..Parameters::paper() };
    let rows = [
        (0.0, 1.0),
        (1.02, 1.0),
        (1.02, 0.0),
        (2.0, 0.0),
        (2.0, 1.0),
        (2.01, 1.0),
        (2.01, 0.0),
        (3.0, 0.0),
        (3.0, 1.0),
        (3.5, 1.0),
    ];
    let nodes = rows.map(|(time, force)| Node::new(time, force, 10.0 * TAU));
    let cycle = Cycle::new(&nodes, Interpolation::Linear, 1).unwrap();
    let log =
        |until: f64| EventLog::new(&parameters, Some(&cycle), until, cycle.steps_done(until, parameters.step_angle()));
    let (mut whole, mut short) = (log(3.5), log(2.5));
    let closing = short.closing(20).map(|moment| (moment.step, moment.time, moment.pause));
    assert_eq!(closing, Some((20, 1.02, Some(Kind::Lifted))));
    assert!(whole.closing(20).is_none());
    for step in [1, 20] {
        whole.note(&sample(step));
        short.note(&sample(step));
    }
    let [first, second] = short.progress().records[..] else { panic!("{short:?}") };
    assert_eq!((first.worn, first.temperature_peak), (20.0, 320.0));
    assert!(second.worn == 0.0 && second.temperature_peak.is_nan() && second.contact_area_end.is_nan());
    // Neither has ended for a run that goes on.
    let mut longer = log(3.5);
    longer.restore(short.progress().clone());
    assert_eq!((longer.progress().records.len(), longer.next(20)), (0, Some(21)));
    for step in [21, 22, 30] {
        whole.note(&sample(step));
        longer.note(&sample(step));
    }
    assert_eq!(format!("{:?}", longer.progress().records), format!("{:?}", whole.progress().records));
    let worn: Vec<f64> = longer.progress().records.iter().map(|record| record.worn).collect();
    assert_eq!(worn, [21.0, 0.0, 9.0]);
}
