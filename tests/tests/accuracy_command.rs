//! `plateau accuracy`: its numbers are computed anew from run files of `plateau run` with the same settings.

mod endings;
mod mesh;
mod reference;

use std::fs;

use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, repository, sets};
use plateau_tests::run_file::RunFile;
use plateau_tests::table::{Row, number, relative_error, rows};

/// Windows of the small scene, s: whole revolutions (60 s/850) of the runs with 1, 2, 5, 10 and 20 times the speed of time,
/// and not narrower than 5 s.
const WINDOW: f64 = 4.0 * 20.0 * 60.0 / 850.0;
/// Their number in 20 s.
const WINDOWS: usize = 3;
/// Names of the quantities in files, and the series of a run file whose sum each is.
const QUANTITIES: [(&str, &[&str]); 4] = [
    ("contact_area", &["contact_area_integral"]),
    ("filled_fraction", &["filled_fraction"]),
    ("worn", &["worn_pin", "worn_resin", "worn_disc"]),
    ("emitted", &["emitted"]),
];

/// A directory with `scene.toml`, 20 s of the quick scene with a sample at the end of every window, and other edits.
fn with_scene(edits: &[(&str, &str)]) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let samples = format!("sample_every = \"{WINDOW} s\"");
    // A narrower ring under the same pressure, which takes less than half of the time.
    let mut all = vec![
        ("duration = \"60 s\"", "duration = \"20 s\""),
        ("sample_every = \"0.1 s\"", &samples),
        ("outer_radius = \"21 mm\"", "outer_radius = \"20.4 mm\""),
        ("rows = 20", "rows = 8"),
        ("normal_force = \"5 N\"", "normal_force = \"2 N\""),
    ];
    all.extend(edits);
    directory.write("scene.toml", quick_scene_with(&all));
    directory
}

/// Measures accuracies into the folder `accuracy`, and reads the table.
fn measured(directory: &WorkingDirectory, arguments: &[&str]) -> (String, Vec<Row>) {
    let all = ["accuracy", "scene.toml", "--force"].iter().chain(arguments);
    let text = directory.plateau(all).quiet_success();
    (text, rows(&directory.text("accuracy/accuracy.csv")))
}

/// All that was found, as JSON.
fn document(directory: &WorkingDirectory) -> serde_json::Value {
    serde_json::from_str(&directory.text("accuracy/accuracy.json")).unwrap()
}

fn number_of(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("found {value}, expected a number"))
}

/// Runs the scene into a file.
fn run(directory: &WorkingDirectory, file: &str, settings: &[impl AsRef<str>]) -> RunFile {
    let settings: Vec<&str> = settings.iter().map(AsRef::as_ref).collect();
    directory.plateau([&["run", "scene.toml", "-o", file, "--force"], &sets(&settings)[..]].concat()).quiet_success();
    directory.run_file(file)
}

/// Sum of series, from the start on, at the samples of a run.
fn sum(run: &RunFile, series: &[&str]) -> Vec<f64> {
    let mut sum = vec![0.0; run.floats("/time").len() + 1];
    for name in series {
        sum[1..].iter_mut().zip(run.floats(&format!("/series/{name}"))).for_each(|(sum, value)| *sum += value);
    }
    sum
}

/// Means of a quantity over the windows that end at the samples of a run: mean rates of what only grows, and the filled fraction at
/// the end of each.
fn means(run: &RunFile, series: &[&str]) -> Vec<f64> {
    let (time, sum) = ([&[0.0], &run.floats("/time")[..]].concat(), sum(run, series));
    // The last sample is the end of the run.
    assert_eq!(time.len(), WINDOWS + 2);
    let mean = |window: usize| match series {
        ["filled_fraction"] => sum[window],
        _ => (sum[window] - sum[window - 1]) / (time[window] - time[window - 1]),
    };
    (1..=WINDOWS).map(mean).collect()
}

fn expect_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found}, expected {expected}");
}

/// What is wrong is said in one message, which is given, and nothing is written.
fn refusal(directory: &WorkingDirectory, arguments: &[&str]) -> String {
    let before = directory.content();
    let Outcome { status, stdout, stderr, .. } = directory.plateau(["accuracy"].iter().chain(arguments));
    assert_eq!((status, stdout.as_str()), (Some(2), ""), "{stderr}");
    assert!(stderr.starts_with("plateau: "), "{stderr}");
    assert!(directory.content() == before, "something was written");
    stderr
}

#[test]
fn every_error_is_that_of_the_run_files() {
    let directory = with_scene(&[]);
    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration,perturbation"]);
    // 20 s are 283 revolutions: with 8 of them at least, m goes up to 35.
    let accelerations = rows.iter().filter(|row| row["ladder"] == "time_acceleration");
    let accelerations: Vec<&str> = accelerations.map(|row| row["value"].as_str()).collect();
    assert_eq!(accelerations, ["2.0", "5.0", "10.0", "20.0"]);
    assert_eq!(rows.len(), 4 + 3, "{text}");
    assert!(text.contains("3 of 5.647 s"), "{text}");

    let reference = run(&directory, "reference.h5", &["numerics.time_acceleration=1"]);
    for row in &rows {
        let sets: Vec<String> = row["setting"].split(", ").map(|set| set.replace("time_", "numerics.time_")).collect();
        let run = run(&directory, "run.h5", &sets);
        let near = |name: &str, expected: f64| {
            expect_near(number(row, name), expected, 1e-12, &format!("{}, {name}", row["setting"]));
        };
        let mut worst = 0.0_f64;
        for (name, series) in QUANTITIES {
            let [found, expected] = [&run, &reference].map(|run| means(run, series));
            let error = relative_error(&found, &expected);
            worst = worst.max(error);
            near(&format!("{name}_error"), error);
            let largest = found.iter().zip(&expected).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
            near(&format!("{name}_largest_error"), largest);
            // Rates since the start: windows end at most a step late.
            let [found, expected] = [&run, &reference].map(|run| {
                let time = if name == "filled_fraction" { 1.0 } else { run.floats("/time")[WINDOWS - 1] };
                sum(run, series)[WINDOWS] / time
            });
            near(&format!("{name}_end_error"), found / expected - 1.0);
        }
        near("error", worst);
        assert_eq!(number(row, "steps"), (20.0 / (run.floats("/time")[WINDOWS] / number(row, "steps"))).ceil());
    }
}

#[test]
fn front_and_advice_follow_from_the_table() {
    let directory = with_scene(&[]);
    // Of the contact area alone there is a run within 1 %; of all quantities none is within 0.001 %.
    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration", "--quantity", "contact_area"]);
    let point = |row: &Row| (number(row, "wall_time"), number(row, "error"));
    let longest = number_of(&document(&directory)["reference"]["wall_time"]);
    let quicker: Vec<&Row> = rows.iter().filter(|row| point(row).0 < longest).collect();
    for row in &rows {
        assert_eq!(row["error"], row["contact_area_error"]);
        let (time, error) = point(row);
        let beats = |(other_time, other)| other_time <= time && other <= error && (other_time < time || other < error);
        let beaten = quicker.iter().any(|row| beats(point(row)));
        assert_eq!(number(row, "on_front"), if beaten || time >= longest { 0.0 } else { 1.0 });
    }
    let within = quicker.iter().filter(|row| point(row).1 <= 0.01);
    let quickest = within.min_by(|one, other| point(one).0.total_cmp(&point(other).0)).expect("a run within 1 %");
    assert!(text.contains(&format!("for 1 % error use {}: ", quickest["setting"])), "{text}");
    assert!(text.contains("(contact area)") && text.contains("none, it is the model itself"), "{text}");

    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration", "--tolerance", "1e-5"]);
    let quicker = rows.iter().filter(|row| number(row, "on_front") == 1.0);
    let least = quicker.min_by(|one, other| point(one).1.total_cmp(&point(other).1)).expect("a run on the front");
    let worst = QUANTITIES.map(|(name, _)| number(least, &format!("{name}_error"))).into_iter().fold(0.0, f64::max);
    assert_eq!(number(least, "error"), worst);
    let words = [
        "no run has at most 0.001 % error: the least is ",
        &format!(", with {}, ", least["setting"]),
        "; --quantity asks for single quantities",
    ];
    assert!(words.iter().all(|words| text.contains(words)), "{words:?} in {text}");
}

#[test]
fn a_run_file_is_as_good_a_reference_as_a_run() {
    let directory = with_scene(&[]);
    let (_, made) = measured(&directory, &["--ladder", "time_acceleration"]);
    for (file, every) in [
        ("coarse.h5", &*format!("output.sample_every={} s", WINDOW / 2.0)),
        ("dense.h5", "output.sample_every_steps=690"),
        ("other.h5", "output.sample_every=0.3 s"),
    ] {
        drop(run(&directory, file, &["numerics.time_acceleration=1", "output.maps=[]", every]));
    }
    // Values are interpolated between samples, which is exact where windows end at them, as with one sample a revolution.
    for (file, tolerance) in [("coarse.h5", 1e-12), ("dense.h5", 1e-9)] {
        let (text, read) = measured(&directory, &["--ladder", "time_acceleration", "--reference", file]);
        assert!(text.contains(&format!("time_acceleration = 1, {file}")), "{text}");
        assert!(!text.contains("windows end between samples"), "{text}");
        assert_eq!(read.len(), made.len());
        for (read, made) in read.iter().zip(&made) {
            for (name, _) in QUANTITIES {
                let name = format!("{name}_error");
                expect_near(number(read, &name), number(made, &name), tolerance, &format!("{file}, {name}"));
            }
        }
        let results = document(&directory);
        assert_eq!(results["reference"]["file"], file);
        assert_eq!(results["reference"]["sha256"].as_str().map(str::len), Some(64));
    }
    // Where windows end between samples, they are as wide as twenty of these: 6 s, which is in units of 20 revolutions five.
    let (text, _) = measured(&directory, &["--ladder", "time_acceleration", "--reference", "other.h5"]);
    assert!(text.contains("2 of 7.059 s") && text.contains("windows end between samples of the reference"), "{text}");
}

#[test]
fn every_file_has_the_same_numbers() {
    let directory = with_scene(&[]);
    let arguments = ["accuracy", "scene.toml", "--ladder", "time_acceleration", "--ladder", "tolerance", "--json"];
    let json = directory.plateau(arguments).ends(0, &[]).json();
    let csv = directory.text("accuracy/accuracy.csv");
    assert_eq!(document(&directory), json);
    let runs = json["runs"].as_array().unwrap();
    let names: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let mut sorted = names.clone();
    sorted.sort_unstable();
    let keys = |value: &serde_json::Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(keys(&runs[0]), sorted);
    for (run, row) in runs.iter().zip(rows(&csv)) {
        for name in &names {
            match &run[name] {
                // JSON is read without the last bit.
                value @ serde_json::Value::Number(_) => {
                    let expected = number_of(value);
                    expect_near(number(&row, name), expected, 1e-15 * expected.abs(), name);
                }
                text => assert_eq!(text, &row[*name], "{name}"),
            }
        }
    }
    let all_keys = [names.join(" "), keys(&json["reference"]).join(" "), keys(&json).join(" ")];
    insta::assert_snapshot!("keys", all_keys.join("\n"));
    assert_eq!(json["state"], "finished");
    assert_eq!(json["reference"]["time_acceleration"].as_f64(), Some(1.0));
    assert_eq!(json["reference"]["error"].as_f64(), Some(0.0));
    expect_near(number_of(&json["window_width"]), WINDOW, 1e-12, "width");
    assert_eq!(json["windows"], WINDOWS);
    for name in ["program", "source_revision", "host", "scene", "advice"] {
        assert!(json[name].as_str().is_some_and(|text| !text.is_empty()), "{name}");
    }

    for format in ["png", "svg", "pdf"] {
        assert!(directory.path(&format!("accuracy/accuracy.{format}")).is_file(), "{format}");
    }
}

#[test]
fn the_help_tells_every_ladder() {
    insta::assert_snapshot!(WorkingDirectory::new().plateau(["accuracy", "--help"]).quiet_success());
}

#[test]
fn every_column_is_documented() {
    let directory = with_scene(&[]);
    let (_, rows) = measured(&directory, &["--ladder", "perturbation"]);
    let documentation = fs::read_to_string(repository().join("docs/evidence/accuracy.md")).unwrap();
    for name in rows[0].keys() {
        assert!(documentation.contains(&format!("`{name}`")), "{name} is not in docs/evidence/accuracy.md");
    }
}
