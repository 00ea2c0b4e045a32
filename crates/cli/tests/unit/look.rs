use std::f64::consts::TAU;
use std::time::Duration;

use plateau_core::model::mesh::Mesh;
use plateau_io::run_file::State;

use super::*;

#[test]
fn a_finished_run_is_done_however_its_last_time_is_rounded() {
    let times = vec![60.0 * (1.0 - 1e-15)];
    let look = |state| Look { state, times: times.clone(), duration: Some(60.0), ..look(1, 0, 0) };
    assert_eq!(look(State::Finished).progress(), Some(1.0));
    assert!(look(State::Interrupted).progress() < Some(1.0));
}

fn of(operation: &str) -> Option<f64> {
    let scene = format!("[operation]\n{operation}\n[numerics]\ntime_acceleration = 20.0\n");
    duration(&scene.parse().unwrap(), &Mesh::new(4, 100, 5, 1.0, 3.0).unwrap())
}

#[test]
fn is_given_or_follows_from_the_steps() {
    assert_eq!(of("duration = \"2 ms\""), Some(2e-3));
    // 100 steps are one revolution, at 60 rpm 1 s, and each stands for 20.
    let revolution = of("steps = 100\nrotational_speed = \"60 rpm\"").unwrap();
    assert!((revolution - 20.0).abs() < 1e-12, "{revolution}");
    // One revolution at the mean radius of 2 m is a way of 4 pi m.
    let revolution = of("steps = 100\nsliding_speed = \"2 m/s\"").unwrap();
    assert!((revolution - 20.0 * TAU).abs() < 1e-12, "{revolution}");
    assert_eq!(of("steps = 100"), None);
}

fn look(samples: usize, elapsed: u64, age: u64) -> Look {
    Look {
        title: "a run".into(),
        state: State::Running,
        error: None,
        times: (1..=samples).map(|sample| sample as f64).collect(),
        duration: Some(100.0),
        contact_area: vec![1e-6; samples],
        contact_area_mean: vec![1e-6; samples],
        filled_fraction: None,
        elapsed: Some(Duration::from_secs(elapsed)),
        age: Duration::from_secs(age),
    }
}

#[test]
fn speed_is_that_since_the_start_and_later_that_of_the_last_half_minute() {
    let start = Instant::now();
    let mut pace = Pace::new(start);
    pace.note(&look(20, 10, 0), start);
    assert_eq!(pace.speed(&look(20, 10, 0)), Some(2.0));
    pace.note(&look(80, 20, 0), start + Duration::from_secs(10));
    assert_eq!(pace.speed(&look(80, 20, 0)), Some(6.0));
    assert_eq!(Pace::new(start).speed(&look(0, 10, 0)), None);
}

#[test]
fn a_run_without_news_may_have_been_killed() {
    let start = Instant::now();
    let mut pace = Pace::new(start);
    // Written an hour ago, as far as the clocks agree.
    let old = look(20, 10, 3600);
    pace.note(&old, start);
    assert_eq!(pace.silence(&old, start), Some(Duration::from_secs(3600)));
    // It grows after all.
    let grown = look(21, 3610, 3600);
    pace.note(&grown, start + Duration::from_secs(5));
    assert_eq!(pace.silence(&grown, start + Duration::from_secs(6)), None);
    // One sample in 10 min until now: a minute without one says nothing.
    let slow = look(6, 3600, 0);
    let mut pace = Pace::new(start);
    pace.note(&slow, start);
    assert_eq!(pace.silence(&slow, start + Duration::from_secs(300)), None);
    assert_eq!(pace.silence(&slow, start + Duration::from_secs(6000)), Some(Duration::from_secs(6000)));
}
