//! `plateau accuracy`: its numbers are computed anew from run files of `plateau run` with the same settings.

mod endings;
mod reference;

use std::fs;

use ndarray::{Array2, ArrayView2};
use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, repository};
use plateau_tests::run_file::{RunFile, created};
use plateau_tests::table::{Row, number, relative_error, rows};

/// Windows of the small scene, s: whole revolutions (60 s/850) of the runs with 1, 2, 5, 10 and 20 times the speed of time,
/// and not narrower than 5 s.
const WINDOW: f64 = 4.0 * 20.0 * 60.0 / 850.0;
/// Their number in 20 s.
const WINDOWS: usize = 3;
const ROWS: usize = 20;

/// A directory with `scene.toml`, 20 s of the quick scene with a sample at the end of every window, and other edits.
fn with_scene(edits: &[(&str, &str)]) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let samples = format!("sample_every = \"{WINDOW} s\"");
    let mut all = vec![("duration = \"60 s\"", "duration = \"20 s\""), ("sample_every = \"0.1 s\"", &samples)];
    all.extend(edits);
    directory.write("scene.toml", quick_scene_with(&all));
    directory
}

/// Measures accuracies into the folder `accuracy`, and reads the table.
fn measured(directory: &WorkingDirectory, arguments: &[&str]) -> (String, Vec<Row>) {
    let all = ["accuracy", "scene.toml", "--force"].iter().chain(arguments);
    let text = directory.plateau(all).quiet_success();
    (text, rows(&fs::read_to_string(directory.path("accuracy/accuracy.csv")).unwrap()))
}

/// All that was found, as JSON.
fn document(directory: &WorkingDirectory) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(directory.path("accuracy/accuracy.json")).unwrap()).unwrap()
}

fn number_of(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("found {value}, expected a number"))
}

/// Runs the scene into a file.
fn run(directory: &WorkingDirectory, file: &str, sets: &[String]) -> RunFile {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    directory.plateau(["run", "scene.toml", "-o", file, "--force"].into_iter().chain(sets)).quiet_success();
    RunFile::open(directory.path(file))
}

/// Means of the contact area over the windows that end at the samples of a run.
fn mean_areas(run: &RunFile) -> Vec<f64> {
    let (time, integral) = (run.floats("/time"), run.floats("/series/contact_area_integral"));
    // The last sample is the end of the run.
    assert_eq!(time.len(), WINDOWS + 1);
    let before = |values: &[f64], window: usize| if window == 0 { 0.0 } else { values[window - 1] };
    let mean = |window: usize| (integral[window] - before(&integral, window)) / (time[window] - before(&time, window));
    (0..WINDOWS).map(mean).collect()
}

fn expect_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found}, expected {expected}");
}

fn last(run: &RunFile, name: &str) -> f64 {
    *run.floats(&format!("/series/{name}")).last().unwrap()
}

/// Root mean square of a field, weighted by the radii, about its weighted mean or about 0.
fn weighted_rms(field: &[f64], radii: &[f64], about_mean: bool) -> f64 {
    let weight = |cell: usize| radii[cell % radii.len()];
    let whole: f64 = (0..field.len()).map(weight).sum();
    let mean = (0..field.len()).map(|cell| weight(cell) * field[cell]).sum::<f64>() / whole;
    let level = if about_mean { mean } else { 0.0 };
    ((0..field.len()).map(|cell| weight(cell) * (field[cell] - level).powi(2)).sum::<f64>() / whole).sqrt()
}

/// What is wrong is said in one message, and nothing is written.
fn expect_refusal(directory: &WorkingDirectory, arguments: &[&str], words: &[&str]) {
    let before = directory.content();
    let Outcome { status, stdout, stderr } = directory.plateau(["accuracy"].iter().chain(arguments));
    assert_eq!((status, stdout.as_str()), (Some(2), ""), "{stderr}");
    assert!(stderr.starts_with("plateau: "), "{stderr}");
    for words in words {
        assert!(stderr.contains(words), "{words:?} is not in {stderr}");
    }
    assert!(directory.content() == before, "something was written");
}

#[test]
fn every_error_is_that_of_the_run_files() {
    let directory = with_scene(&[]);
    let ladders = ["time_acceleration", "integrator", "perturbation"];
    let (text, rows) = measured(&directory, &["--ladder", &ladders.join(",")]);
    // 20 s are 283 revolutions: with 8 of them at least, m goes up to 35.
    let accelerations: Vec<&str> =
        rows.iter().filter(|row| row["ladder"] == "time_acceleration").map(|row| row["value"].as_str()).collect();
    assert_eq!(accelerations, ["2.0", "5.0", "10.0", "20.0"]);
    assert_eq!(rows.len(), 4 + 1 + 3, "{text}");
    assert!(text.contains("3 of 5.647 s"), "{text}");

    let reference = run(&directory, "reference.h5", &["numerics.time_acceleration=1".to_owned()]);
    let areas = mean_areas(&reference);
    let own = mean_areas(&run(&directory, "own.h5", &[]));
    for row in &rows {
        let sets = [
            format!("numerics.time_acceleration={}", row["time_acceleration"]),
            format!("numerics.integrator={}", row["integrator"]),
            format!("disc.prepare.scale={:?}", 1.0 + number(row, "perturbation")),
        ];
        let run = run(&directory, "run.h5", &sets);
        let what = &row["setting"];
        let near =
            |name: &str, expected: f64| expect_near(number(row, name), expected, 1e-12, &format!("{what}, {name}"));
        let found = mean_areas(&run);
        near("contact_area_error", relative_error(&found, &areas));
        let largest = found.iter().zip(&areas).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        near("contact_area_largest_error", largest);
        match row["ladder"].as_str() {
            "time_acceleration" | "perturbation" => assert_eq!(row["contact_area_change"], ""),
            _ => near("contact_area_change", relative_error(&found, &own)),
        }
        let [filled, expected] = [&run, &reference].map(|run| run.floats("/series/filled_fraction"));
        near("filled_fraction_error", filled[WINDOWS] - expected[WINDOWS]);
        near(
            "filled_fraction_largest_error",
            filled.iter().zip(&expected).take(WINDOWS).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
        );
        let worn =
            |run: &RunFile| ["worn_pin", "worn_resin", "worn_disc"].map(|name| last(run, name)).iter().sum::<f64>();
        near("worn_error", worn(&run) / worn(&reference) - 1.0);
        near("emitted_error", last(&run, "emitted") / last(&reference, "emitted") - 1.0);
        for name in ["disc_secondary", "pin_secondary"] {
            near(&format!("{name}_error"), last(&run, name) - last(&reference, name));
        }
        // The area of the pin is the same part of the ring 20 mm to 21 mm for both.
        let pin_area = std::f64::consts::PI * (21e-3_f64.powi(2) - 20e-3_f64.powi(2)) * 40.0 / 690.0;
        near("contact_ratio_error", (found[WINDOWS - 1] - areas[WINDOWS - 1]) / pin_area);
        assert_eq!(number(row, "steps"), (20.0 / (run.floats("/time")[WINDOWS] / number(row, "steps"))).ceil());

        let radii = run.floats("/radius");
        let heights = |body: &str| -> Vec<f64> {
            let name = format!("/{body}/height");
            run.last_map(&name).iter().zip(reference.last_map(&name)).map(|(a, b)| a - b).collect()
        };
        // Heights are of the order of 1e-6 m.
        let near =
            |name: &str, expected: f64| expect_near(number(row, name), expected, 1e-17, &format!("{what}, {name}"));
        near("disc_height_error", weighted_rms(&heights("disc"), &radii, false));
        near("pin_height_error", weighted_rms(&heights("pin"), &radii, true));
    }
}

#[test]
fn orders_front_and_advice_follow_from_the_table() {
    let directory = with_scene(&[]);
    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration"]);
    let point = |row: &Row| (number(row, "wall_time"), number(row, "contact_area_error"));
    for pair in rows.windows(2) {
        let ratio = |name: &str| (number(&pair[1], name) / number(&pair[0], name)).ln();
        let expected = ratio("contact_area_error") / ratio("value");
        expect_near(number(&pair[1], "order"), expected, 1e-12, "order");
        let means_nothing = expected <= 0.0 || number(&pair[0], "value") < 3.0;
        assert_eq!(!pair[1]["order_note"].is_empty(), means_nothing, "{pair:?}");
    }
    // What took as long as the reference is no choice.
    let longest = number_of(&document(&directory)["reference"]["wall_time"]);
    let quicker: Vec<&Row> = rows.iter().filter(|row| point(row).0 < longest).collect();
    for row in &rows {
        let (time, error) = point(row);
        let beaten = quicker
            .iter()
            .map(|row| point(row))
            .any(|(other_time, other)| other_time <= time && other <= error && (other_time < time || other < error));
        assert_eq!(number(row, "on_front"), if beaten || time >= longest { 0.0 } else { 1.0 });
        assert_eq!(number(row, "above_reference_error"), 1.0);
    }
    let quickest = quicker
        .iter()
        .filter(|row| point(row).1 <= 0.01)
        .min_by(|one, other| point(one).0.total_cmp(&point(other).0))
        .expect("a run within 1 %");
    assert!(text.contains(&format!("for 1 % error in contact area use {}: ", quickest["setting"])), "{text}");
    assert!(text.contains("none, it is the model itself"), "{text}");
}

#[test]
fn a_coarser_mesh_is_averaged_by_area() {
    // No cut and no resin, so that what is averaged here is all that there is.
    let base = "synthetic = { seed = 2, fibre_fraction = 0.3, fibre_length = \"600 um\", fibre_width = \"200 um\" }";
    let directory = with_scene(&[("cutoff = \"3 um\"", ""), (base, "uniform = \"primary\"")]);
    let (_, rows) = measured(&directory, &["--ladder", "mesh"]);
    let row = rows.iter().find(|row| row["ladder"] == "mesh" && row["value"] == "2.0").expect("a coarser mesh");
    assert_eq!([number(row, "rows"), number(row, "disc_columns"), number(row, "pin_columns")], [10.0, 345.0, 20.0]);

    let fine = run(&directory, "reference.h5", &["numerics.time_acceleration=1".to_owned()]);
    let radii = fine.floats("/radius");
    let coarse = |field: &[f64]| -> Array2<f64> {
        // Two by two cells, each with its radius as weight.
        Array2::from_shape_fn((field.len() / ROWS / 2, ROWS / 2), |(column, row)| {
            let cells = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(c, r)| (2 * column + c, 2 * row + r));
            let weight: f64 = cells.iter().map(|(_, row)| radii[*row]).sum();
            cells.iter().map(|(column, row)| radii[*row] * field[column * ROWS + row]).sum::<f64>() / weight
        })
    };
    let first = run(&directory, "first.h5", &["output.maps_at=[\"0 s\"]".to_owned()]);
    let file = created(directory.path("coarse.h5"));
    for body in ["disc", "pin"] {
        let heights = coarse(&first.map(&format!("/{body}/height"), 0));
        file.new_dataset_builder().with_data(ArrayView2::from(&heights)).create(body).unwrap();
    }
    file.close().unwrap();
    let sets = [
        "mesh.rows=10",
        "mesh.disc_columns=345",
        "mesh.pin_columns=20",
        "disc.surface.file=coarse.h5",
        "disc.surface.dataset=disc",
        "pin.surface.file=coarse.h5",
        "pin.surface.dataset=pin",
    ];
    let run = run(&directory, "run.h5", &sets.map(str::to_owned));
    // What is rounded otherwise grows little.
    expect_near(
        number(row, "contact_area_error"),
        relative_error(&mean_areas(&run), &mean_areas(&fine)),
        1e-6,
        "error",
    );
    let worn = |run: &RunFile| last(run, "worn_pin");
    expect_near(number(row, "worn_error"), worn(&run) / worn(&fine) - 1.0, 1e-6, "worn");
    let coarse_radii = run.floats("/radius");
    for (body, about_mean) in [("disc", false), ("pin", true)] {
        let name = format!("/{body}/height");
        let expected = coarse(&fine.last_map(&name));
        let difference: Vec<f64> = run.last_map(&name).iter().zip(&expected).map(|(a, b)| a - b).collect();
        let expected = weighted_rms(&difference, &coarse_radii, about_mean);
        expect_near(number(row, &format!("{body}_height_error")) / expected, 1.0, 1e-4, body);
    }
}

#[test]
fn a_run_file_is_as_good_a_reference_as_a_run() {
    let directory = with_scene(&[]);
    let (_, made) = measured(&directory, &["--ladder", "time_acceleration"]);
    let sets = |every: &str| ["numerics.time_acceleration=1".to_owned(), format!("output.{every}")];
    drop(run(&directory, "coarse.h5", &sets(&format!("sample_every={} s", WINDOW / 2.0))));
    drop(run(&directory, "dense.h5", &sets("sample_every_steps=690")));
    drop(run(&directory, "other.h5", &sets("sample_every=0.3 s")));
    // The integral of the contact area is interpolated between samples, which is exact where windows end at them, as with
    // one sample a revolution.
    for (file, tolerance) in [("coarse.h5", 1e-12), ("dense.h5", 1e-9)] {
        let (text, read) = measured(&directory, &["--ladder", "time_acceleration", "--reference", file]);
        assert!(text.contains(&format!("time_acceleration = 1, {file}")), "{text}");
        assert!(!text.contains("windows end between samples"), "{text}");
        assert_eq!(read.len(), made.len());
        for (read, made) in read.iter().zip(&made) {
            for name in
                ["contact_area_error", "filled_fraction_error", "worn_error", "disc_height_error", "pin_height_error"]
            {
                expect_near(number(read, name), number(made, name), tolerance, &format!("{file}, {name}"));
            }
        }
        let results = document(&directory);
        assert_eq!(results["reference"]["file"], file);
        assert_eq!(results["reference"]["sha256"].as_str().map(str::len), Some(64));
    }
    // Where windows end between samples, they are as wide as twenty of these: 6 s, which is in units of 20 revolutions five.
    let (text, _) = measured(&directory, &["--ladder", "time_acceleration", "--reference", "other.h5"]);
    assert!(text.contains("2 of 7.059 s") && text.contains("windows end between samples of the reference"), "{text}");
    // What a reference did not record is left out.
    let without = [sets("sample_every=1 s").to_vec(), vec!["output.maps=[]".to_owned()]].concat();
    drop(run(&directory, "bare.h5", &without));
    let (text, read) = measured(&directory, &["--ladder", "time_acceleration", "--reference", "bare.h5"]);
    assert_eq!(read[0]["disc_height_error"], "");
    assert!(text.contains("bare.h5 has no map of the disc's heights at its end: not compared"), "{text}");
}

#[test]
fn every_file_has_the_same_numbers() {
    let directory = with_scene(&[]);
    let arguments = ["accuracy", "scene.toml", "--ladder", "time_acceleration", "--ladder", "integrator", "--json"];
    let json = directory.plateau(arguments).quiet_success();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let rows = rows(&fs::read_to_string(directory.path("accuracy/accuracy.csv")).unwrap());
    assert_eq!(document(&directory), json);
    for name in [
        "wall_time",
        "steps",
        "contact_area_error",
        "above_reference_error",
        "filled_fraction_error",
        "load_residual",
        "on_front",
    ] {
        let expected: Vec<f64> = rows.iter().map(|row| number(row, name)).collect();
        for (run, expected) in json["runs"].as_array().unwrap().iter().zip(expected) {
            expect_near(run[name].as_f64().unwrap(), expected, 1e-15 * expected.abs(), name);
        }
    }
    assert_eq!(json["state"], "finished");
    assert_eq!(json["reference"]["time_acceleration"].as_f64(), Some(1.0));
    assert_eq!(json["reference"]["contact_area_error"].as_f64(), Some(0.0));
    expect_near(number_of(&json["window_width"]), WINDOW, 1e-12, "width");
    assert_eq!(json["windows"], WINDOWS);
    for name in ["program", "source_revision", "host", "scene"] {
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
    let (_, rows) = measured(&directory, &["--ladder", "integrator"]);
    let documentation = fs::read_to_string(repository().join("docs/accuracy.md")).unwrap();
    for name in rows[0].keys() {
        assert!(documentation.contains(&format!("`{name}`")), "{name} is not in docs/accuracy.md");
    }
}
