//! Run files in other processes: readers that follow them, and writers that are killed or find the disk full.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::few_or_all;
use crate::fixtures::{header, open_following, place, run_file, sample, small, snapshot, text};
use plateau_core::observe::{Map, QUANTITIES};
use plateau_io::process::report_file_size_limit;
use plateau_io::run_file::{End, RunWriter};

#[test]
fn a_reader_sees_a_sample_within_a_second() {
    let (_directory, path) = place("run.h5");
    let header = small();
    let mut writer = RunWriter::create(&path, false, &header).unwrap();
    let reader = open_in_another_process(&path);
    writer.sample(sample(1)).unwrap();
    writer.snapshot(snapshot(&header, 1.0)).unwrap();
    let seen = reader.wait_with_output().unwrap();
    assert!(seen.status.success(), "{}", String::from_utf8_lossy(&seen.stdout));
    writer.finish(&End::Finished, &[], None).unwrap();
}

/// Runs one of the `child_…` functions below on `path` in a process of its own, under a shell command.
fn child(function: &str, shell: &str, path: &Path) -> Command {
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("{shell} exec \"$0\" --ignored --exact run_file_processes::{function} --nocapture")])
        .arg(std::env::current_exe().unwrap())
        .env("RUN_FILE", path)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn open_in_another_process(path: &Path) -> std::process::Child {
    child("child_follows", "", path).spawn().unwrap()
}

#[test]
#[ignore = "started by another test"]
fn child_follows() {
    let file = open_following(&run_file());
    let (time, map_time) = (file.dataset("time").unwrap(), file.dataset("map_time").unwrap());
    let start = Instant::now();
    while time.size() + map_time.size() < 2 {
        assert!(start.elapsed() < Duration::from_secs(1), "{} times, {} map times", time.size(), map_time.size());
        std::thread::sleep(Duration::from_millis(10));
        time.refresh().unwrap();
        map_time.refresh().unwrap();
    }
    let pool = file.dataset("series/pool").unwrap().read_raw::<f64>().unwrap();
    assert_eq!(pool, [sample(1).pool]);
}

#[test]
fn a_killed_writer_leaves_what_was_complete() {
    let directory = tempfile::tempdir().unwrap();
    for attempt in 0..few_or_all(3, 10) {
        let path = directory.path().join(format!("run{attempt}.h5"));
        let mut writer = child("child_writes_for_ever", "", &path).spawn().unwrap();
        let start = Instant::now();
        while !path.exists() {
            assert!(start.elapsed() < Duration::from_secs(30));
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(700 + 61 * attempt));
        writer.kill().unwrap();
        writer.wait().unwrap();

        let file = open_following(&path);
        assert_eq!(text(&file, "state"), "running");
        let samples = file.dataset("time").unwrap().size();
        assert!(samples > 0);
        for quantity in QUANTITIES {
            let series = file.dataset(&format!("series/{}", quantity.name)).unwrap().read_raw::<f64>().unwrap();
            for (step, value) in (1..=samples as u64).zip(&series) {
                assert!((value - quantity.value(&sample(step))).abs() < 1e-6, "{}[{step}]", quantity.name);
            }
            assert!(series.len() >= samples);
        }
        let maps = file.dataset("map_time").unwrap().size();
        assert!(maps > 0);
        let height = file.dataset("disc/height").unwrap().read_dyn::<f64>().unwrap();
        for level in 0..maps {
            assert_eq!(height[[level, 3, 2]], 14.0 + 1000.0 * level as f64, "level {level}");
        }
    }
}

#[test]
#[ignore = "started by another test"]
fn child_writes_for_ever() {
    let header = small();
    let mut writer = RunWriter::create(&run_file(), false, &header).unwrap();
    for step in 1.. {
        writer.sample(sample(step)).unwrap();
        if step % 100 == 1 {
            writer.snapshot(snapshot(&header, (step / 100) as f64)).unwrap();
        }
        std::thread::sleep(Duration::from_micros(200));
    }
}

#[test]
fn a_full_disk_is_an_error_of_the_run() {
    let directory = tempfile::tempdir().unwrap();
    // The limit, in blocks of 512 bytes, is met while samples, maps or the last attributes are written.
    for blocks in [200, 300, 500, 1000, 2000] {
        let path = directory.path().join(format!("run{blocks}.h5"));
        let output = child("child_fills_the_disk", &format!("ulimit -f {blocks};"), &path).output().unwrap();
        let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success(), "{blocks} blocks: {:?}\n{out}\n{err}", output.status);
        assert!(out.contains("File too large"), "{out}");
        assert!(!err.contains("HDF5"), "the library's own messages are of no use to a user: {err}");
        let file = open_following(&path);
        assert_eq!(text(&file, "state"), "running");
        let samples = file.dataset("time").unwrap().size();
        for quantity in QUANTITIES {
            let series = file.dataset(&format!("series/{}", quantity.name)).unwrap();
            let found = series.read_slice_1d::<f64, _>(..samples).unwrap();
            assert!(
                found.iter().zip(1..).all(|(value, step)| *value == quantity.value(&sample(step))),
                "{}",
                quantity.name
            );
        }
    }
}

#[test]
#[ignore = "started by another test"]
fn child_fills_the_disk() {
    report_file_size_limit().unwrap();
    let header = header(40, 200, 50, &Map::ALL);
    let mut writer = RunWriter::create(&run_file(), false, &header).unwrap();
    let start = Instant::now();
    let error = (1..)
        .find_map(|step| {
            assert!(start.elapsed() < Duration::from_secs(60), "no error in a minute");
            let sent = writer.sample(sample(step));
            let sent = if step % 1000 == 0 { sent.and(writer.snapshot(snapshot(&header, step as f64))) } else { sent };
            sent.err()
        })
        .unwrap();
    println!("{error}");
    assert_eq!(writer.finish(&End::Finished, &[], None).unwrap_err(), error);
}
