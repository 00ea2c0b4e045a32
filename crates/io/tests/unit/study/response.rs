use std::path::Path;

use plateau_core::observe::event::event_quantities;
use plateau_core::observe::{EXTRAS, quantities};

use super::*;
use crate::scene::load;
use crate::study::record::Outcome;

fn response(series: &str, question: Question) -> Response {
    Response { name: "r".into(), series: series.into(), question, transform: "none", stated_unit: None }
}

fn of_pool(question: Question, values: &[f64], until: f64) -> Result<f64, NoAnswer> {
    let time: Vec<f64> = (1..=values.len()).map(|at| at as f64).collect();
    let pool = Series::new(vec!["time".into(), "pool".into()], vec![time, values.to_vec()]);
    let run = Series { until, ..pool };
    response("pool", question).of(&run)
}

fn ask(question: Question, values: &[f64]) -> Option<f64> {
    of_pool(question, values, 0.0).ok()
}

#[test]
fn answers_by_hand() {
    let ramp = [0.0, 2.0, 4.0, 4.0];
    assert_eq!(ask(Question::End, &ramp), Some(4.0));
    assert_eq!(ask(Question::At(2.5), &ramp), Some(3.0));
    assert_eq!(ask(Question::At(4.1), &ramp), None);
    // Trapezia: (2 + 4)/2 · 1 + 4 · 1 over 2 s.
    assert_eq!(ask(Question::Mean(2.0, 4.0), &ramp), Some(3.5));
    assert_eq!(ask(Question::End, &[]), None);
    // Lifted at 3 s: by hand, (2 + 4)/2 over 1 s, (6 + 8)/2 over 1 s; then the window with no value at all.
    let lifted = [2.0, 4.0, f64::NAN, 6.0, 8.0];
    assert_eq!(
        [ask(Question::Mean(1.0, 5.0), &lifted), ask(Question::Mean(4.0, 5.0), &lifted)],
        [Some(5.0), Some(7.0)]
    );
    assert_eq!([ask(Question::Mean(2.2, 3.8), &lifted), ask(Question::At(4.0), &lifted)], [None, Some(6.0)]);
}

#[test]
fn the_last_sample_stands_for_the_step_that_a_run_did_not_take_any_more() {
    // A run of 30 s whose last step ends at 4 s, and one that ends there.
    let ramp = [0.0, 2.0, 4.0, 5.0];
    assert_eq!(of_pool(Question::At(30.0), &ramp, 30.0), Ok(5.0));
    assert_eq!(of_pool(Question::Mean(3.0, 30.0), &ramp, 30.0), Ok(4.5));
    let early = NoAnswer::Ended { asked: 30.0, end: 4.0 };
    assert_eq!(early.to_string(), "the run ends at 4 s, before 30 s");
    assert_eq!(of_pool(Question::At(30.0), &ramp, 4.0), Err(early.clone()));
    assert_eq!(of_pool(Question::Mean(3.0, 30.0), &ramp, 4.0), Err(early));
    assert!(of_pool(Question::At(30.1), &ramp, 30.0).is_err());
    assert_eq!(of_pool(Question::At(2.0), &[0.0, f64::NAN, 4.0], 3.0), Err(NoAnswer::NoNumber));
}

#[test]
fn a_series_reaches_its_end_as_the_contact_area_runs_in() {
    // Half of 8 from the fourth of sixty samples on: each is a window, whose middle is half a second before its sample. What the first
    // stands for is before it.
    let step =
        |before: f64, after: f64| -> Vec<f64> { (0..60).map(|at| if at < 4 { before } else { after }).collect() };
    assert_eq!(of_pool(Question::Reaches(0.9), &step(0.0, 8.0), 60.0), Ok(5.5));
    // From above, and below 0.
    assert_eq!(of_pool(Question::Reaches(0.9), &step(16.0, 8.0), 60.0), Ok(5.5));
    assert_eq!(of_pool(Question::Reaches(0.9), &step(0.0, -8.0), 60.0), Ok(5.5));
    // What falls and rises, and what still rises.
    let dip: Vec<f64> = (0..60).map(|at| if (10..20).contains(&at) { 2.0 } else { 8.0 }).collect();
    let line: Vec<f64> = (0..60).map(f64::from).collect();
    let undefined = |values: &[f64]| of_pool(Question::Reaches(0.9), values, 60.0).unwrap_err().to_string();
    assert_eq!(
        undefined(&dip),
        "not defined: neither rises nor falls all along, it goes back by 75.0 % of its last value"
    );
    assert!(undefined(&line).starts_with("not defined: still rises at the end, by "), "{}", undefined(&line));
    assert!(undefined(&line[..10]).starts_with("not defined: too few samples or simulated revolutions; 20 in the run"));
}

#[test]
fn a_series_with_gaps_reaches_its_end_over_the_time_in_which_it_has_a_value() {
    // As above, 0 until 4 s and 8 from 5 s on, but with ten samples without a value; the pieces beside them have no mean either. So there are 69 s
    // and windows of 1.15 s. By hand, the fifth has (0.4 · 4 + 0.75 · 8)/1.15 = 6.6, and the sixth is the first of 8.
    let values: Vec<f64> = (0..80)
        .map(|at| match at {
            0..4 => 0.0,
            20..30 => f64::NAN,
            _ => 8.0,
        })
        .collect();
    let found = of_pool(Question::Reaches(0.9), &values, 80.0).unwrap();
    assert!((found - 5.5 * 69.0 / 60.0).abs() < 1e-9, "{found}");
    assert_eq!(of_pool(Question::Reaches(0.9), &[f64::NAN; 80], 80.0), Err(NoAnswer::NoNumber));
}

#[test]
fn reaches_of_the_contact_area_needs_its_integral_and_knows_its_pulses() {
    let area = response("contact_area", Question::Reaches(0.9));
    assert_eq!(area.needs().collect::<Vec<_>>(), ["contact_area", INTEGRAL, CONTACT_TIME]);
    assert_eq!(response("pool", Question::Reaches(0.9)).needs().collect::<Vec<_>>(), ["pool"]);
    assert_eq!(response("contact_area", Question::End).needs().collect::<Vec<_>>(), ["contact_area"]);
    // 1 − exp(−t/40 s): in 600 s a quarter is two pulses of 75 s.
    let time: Vec<f64> = (1..=600).map(f64::from).collect();
    let integral: Vec<f64> = time.iter().map(|time| time - 40.0 * (1.0 - (-time / 40.0).exp())).collect();
    let names = ["time", "contact_area", INTEGRAL].map(String::from).to_vec();
    let run = Series::new(names, vec![time.clone(), time, integral]);
    let answer = |pulse_time| {
        let packed = run.pack();
        let outcome = Outcome::Finished { steps: 600, until: 600.0, series: packed, events: None, pulse_time };
        area.of(&outcome.series().unwrap())
    };
    // ln 10 · 40 s is 92.1 s: the mean of the window from 90 s on, 1 − 4 e^(−90/40) (1 − e^(−1/4)), is 0.9068.
    assert_eq!([answer(None), answer(Some(50.0))], [Ok(95.0), Ok(95.0)]);
    assert_eq!(
        answer(Some(75.0)).unwrap_err().to_string(),
        "not defined: a quarter of the run has at most 2.0 pulses of the contact area, 3 are needed"
    );
}

#[test]
fn means_of_the_contact_area_of_a_cycle_are_over_the_time_in_contact() {
    // 3 m2 for 2 s, lifted for 2 s.
    let columns = ["time", "contact_area", "contact_area_integral", CONTACT_TIME].map(String::from).to_vec();
    let values = [[1.0, 2.0, 3.0, 4.0], [3.0, 3.0, 0.0, 0.0], [3.0, 6.0, 6.0, 6.0], [1.0, 2.0, 2.0, 2.0]];
    let run = Series::new(columns, values.map(Vec::from).to_vec());
    assert_eq!(response("contact_area", Question::Mean(0.0, 4.0)).of(&run), Ok(3.0));
}

#[test]
fn events_are_asked_by_number_and_in_the_mean() {
    let run = Series { events: vec![("worn".into(), vec![3.0, f64::NAN, 5.0])], ..Series::default() };
    let ask = |which| response("event/worn", Question::Event(which)).of(&run).ok();
    assert_eq!(ask(WhichEvent::Number(1)), Some(3.0));
    assert_eq!([ask(WhichEvent::Number(2)), ask(WhichEvent::Number(4)), ask(WhichEvent::Number(0))], [None; 3]);
    assert_eq!((ask(WhichEvent::Last), ask(WhichEvent::Mean)), (Some(5.0), Some(4.0)));
}

#[test]
fn means_of_the_contact_area_come_from_its_integral() {
    let columns = ["time", "contact_area", "contact_area_integral"].map(String::from).to_vec();
    let run = Series::new(columns, vec![vec![1.0, 2.0], vec![7.0, 7.0], vec![3.0, 8.0]]);
    let mean = |from, to| response("contact_area", Question::Mean(from, to)).of(&run).ok();
    assert_eq!([mean(0.0, 2.0), mean(1.0, 2.0)], [Some(4.0), Some(5.0)]);
}

#[test]
fn means_of_the_last_tenth_take_in_ten_revolutions() {
    let time: Vec<f64> = (1..=200).map(f64::from).collect();
    // The contact area is 2 t, its integral t²; a revolution takes 1 or 4 s.
    let square: Vec<f64> = time.iter().map(|time| time * time).collect();
    let quick = time.clone();
    let slow: Vec<f64> = time.iter().map(|time| time / 4.0).collect();
    let ask = |series: &str, revolutions: Option<&Vec<f64>>| {
        let names = ["time", "contact_area_integral", "contact_area", "contact_area_mean", "pool", REVOLUTIONS];
        let columns = [Some(&time), Some(&square), Some(&time), Some(&time), Some(&time), revolutions];
        let known = names.into_iter().zip(columns).filter_map(|(name, column)| Some((name.into(), column?.clone())));
        let (names, columns) = known.unzip();
        let response = response(series, Question::MeanOfLastTenth);
        let run = Series::new(names, columns);
        (response.of(&run).ok(), response.error_of(&run).is_some())
    };
    // Of the contact area from the integral, of another series from its samples, here t.
    assert_eq!(ask("contact_area_mean", Some(&quick)), (Some(380.0), true));
    assert_eq!(ask("contact_area", Some(&slow)), (Some(360.0), true));
    assert_eq!(ask("contact_area", None), (Some(380.0), true));
    assert_eq!(ask("pool", Some(&slow)), (Some(180.0), false));
}

fn scene(name: &str, sets: &[&str]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes").join(name);
    load(&path, &sets.iter().map(|set| (*set).to_owned()).collect::<Vec<_>>()).unwrap()
}

#[test]
fn every_series_of_a_part_asks_for_it() {
    let quick = scene("quick.toml", &[]);
    assert_eq!((lacking(&quick, "contact_area"), lacking(&quick, "pool")), (None, None));
    for (series, expected) in [
        ("disc_sq", "output.roughness = true"),
        ("pressure_gini", "output.pressure_spread = true"),
        ("contact_temperature_heated", "output.contact_temperature = true"),
        ("friction_coefficient", "[friction]"),
        ("contact_temperature", "[thermal]"),
        ("pm10_mass", "[emission]"),
        ("normal_force", "[operation.cycle]"),
        ("road_distance", "road_speed"),
        ("acceleration_error", "tolerance"),
        ("event/worn", "[operation.cycle]"),
    ] {
        let found = lacking(&quick, series).unwrap_or_else(|| panic!("{series}"));
        assert!(found.contains(expected), "{series}: {found}");
    }
    let rough = scene("quick.toml", &["output.roughness=true"]);
    assert_eq!(lacking(&rough, "disc_sq"), None);
}

#[test]
fn no_series_of_a_run_is_lacking() {
    // All parts of the model, and nothing on request.
    let drive = scene("drive.toml", &[]);
    let extras = drive.extras(false);
    assert!(quantities(&extras).all(|quantity| lacking(&drive, quantity.name).is_none()));
    assert!(event_quantities(&extras).all(|quantity| lacking(&drive, &format!("{EVENT}{}", quantity.name)).is_none()));
    let plain = scene("stops.toml", &[]);
    let has_heat = plain.parameters.thermal.is_some();
    assert_eq!(lacking(&plain, "event/temperature_peak").is_none(), has_heat);
}

fn bounds(series: &str, question: Question) -> Bounds {
    response(series, question).bounds()
}

#[test]
fn areas_volumes_and_fractions_have_bounds_and_heights_have_none() {
    assert_eq!(bounds("contact_area", Question::End), Bounds::NOT_NEGATIVE);
    assert_eq!(bounds("event/worn", Question::End), Bounds::NOT_NEGATIVE);
    assert_eq!(bounds("filled_fraction", Question::End), Bounds::FRACTION);
    assert_eq!(bounds("displacement", Question::End), Bounds::NONE);
    assert_eq!(bounds("lost_pin", Question::End), Bounds::NONE);
    assert_eq!(bounds("displacement", Question::Reaches(0.9)), Bounds::NOT_NEGATIVE);
    assert_eq!(bounds("balance_residual", Question::End), Bounds::NONE);
    assert_eq!(bounds("", Question::Imported("m2")), Bounds::NOT_NEGATIVE);
    assert_eq!(bounds("", Question::Imported("1")), Bounds::NONE);
}

#[test]
fn names_are_those_of_series() {
    let known: Vec<&str> = quantities(EXTRAS).map(|quantity| quantity.name).collect();
    for name in FRACTIONS.iter().chain(&NOT_NEGATIVE) {
        assert!(known.contains(name), "{name}");
    }
}
