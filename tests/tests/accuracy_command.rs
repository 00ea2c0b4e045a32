//! `plateau accuracy`: its numbers are computed anew from run files of `plateau run` with the same settings.

use std::collections::BTreeMap;
use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use hdf5::types::VarLenUnicode;
use ndarray::{Array2, ArrayView2};
use plateau_tests::figure::Figure;
use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, repository, wait_until};
use plateau_tests::run_file::{RunFile, changed, created};

/// Windows of the small scene, s: whole revolutions (60 s/850) of the runs with 1, 2, 5, 10 and 20 times the speed of time,
/// and not narrower than 5 s.
const WINDOW: f64 = 4.0 * 20.0 * 60.0 / 850.0;
/// Their number in 20 s.
const WINDOWS: usize = 3;
const ROWS: usize = 20;

/// A row of `accuracy.csv` by the names of the columns.
type Row = BTreeMap<String, String>;

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

/// The rows of a CSV text; texts may stand in quotation marks.
fn rows(csv: &str) -> Vec<Row> {
    let cells = |line: &str| {
        let (mut cells, mut quoted) = (vec![String::new()], false);
        for letter in line.chars() {
            match letter {
                '"' => quoted = !quoted,
                ',' if !quoted => cells.push(String::new()),
                letter => cells.last_mut().unwrap().push(letter),
            }
        }
        cells
    };
    let mut lines = csv.lines();
    let names = cells(lines.next().expect("names"));
    lines
        .map(|line| {
            let cells = cells(line);
            assert_eq!(cells.len(), names.len(), "{line}");
            names.iter().cloned().zip(cells).collect()
        })
        .collect()
}

fn number(row: &Row, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|_| panic!("{name} is {:?}", row[name]))
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

/// Root mean square error relative to a reference.
fn error(values: &[f64], reference: &[f64]) -> f64 {
    let squares = |pairs: &mut dyn Iterator<Item = f64>| pairs.map(|value| value * value).sum::<f64>();
    let difference = squares(&mut values.iter().zip(reference).map(|(a, b)| a - b));
    (difference / squares(&mut reference.iter().copied())).sqrt()
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
        near("contact_area_error", error(&found, &areas));
        let largest = found.iter().zip(&areas).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        near("contact_area_largest_error", largest);
        match row["ladder"].as_str() {
            "time_acceleration" | "perturbation" => assert_eq!(row["contact_area_change"], ""),
            _ => near("contact_area_change", error(&found, &own)),
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
    expect_near(number(row, "contact_area_error"), error(&mean_areas(&run), &mean_areas(&fine)), 1e-6, "error");
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

    let figure = Figure::read(&fs::read_to_string(directory.path("accuracy/accuracy.svg")).unwrap());
    let panel = figure.panel(figure.boxes()[0]);
    for row in &rows {
        let colour = if row["ladder"] == "integrator" { "#CC79A7" } else { "#0072B2" };
        let place = [panel.x.place(number(row, "wall_time")), panel.y.place(100.0 * number(row, "contact_area_error"))];
        let dots = figure.areas.iter().filter(|(found, dot)| found == colour && dot.len() == 4);
        let is_there =
            |dot: &Vec<[f64; 2]>| (0..2).all(|axis| (0.5 * (dot[0][axis] + dot[2][axis]) - place[axis]).abs() < 3.0);
        assert!(dots.map(|(_, dot)| dot).any(is_there), "no dot for {}", row["setting"]);
    }
    assert!(fs::read(directory.path("accuracy/accuracy.png")).unwrap().starts_with(b"\x89PNG"));
    assert!(fs::read(directory.path("accuracy/accuracy.pdf")).unwrap().starts_with(b"%PDF-"));
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
fn bad_input_is_refused() {
    let directory = with_scene(&[]);
    let fine = ["numerics.time_acceleration=5".to_owned()];
    drop(run(&directory, "good.h5", &fine));
    drop(run(&directory, "other.h5", &[fine.to_vec(), vec!["operation.normal_force=6 N".to_owned()]].concat()));
    drop(run(&directory, "short.h5", &[fine.to_vec(), vec!["operation.duration=10 s".to_owned()]].concat()));
    fs::copy(directory.path("good.h5"), directory.path("stopped.h5")).unwrap();
    let file = changed(directory.path("stopped.h5"));
    let state: VarLenUnicode = "interrupted".parse().unwrap();
    file.attr("state").unwrap().write_scalar(&state).unwrap();
    file.close().unwrap();
    let model = ["--set", "numerics.time_acceleration=1"];
    let chosen = ["--set", "numerics.time_acceleration={ tolerance = 0.01, max = 20 }"];
    let cases: [(&[&str], &[&str]); 14] = [
        (
            &["scene.toml", "--ladder", "steps"],
            &["'steps'", "time_acceleration, tolerance, mesh, integrator, perturbation"],
        ),
        (&["scene.toml", "--budget", "10"], &["'10'", "a time such as"]),
        (&["scene.toml", "--budget", "0 s"], &["expected more than 0 s"]),
        (
            &["scene.toml", "--budget", "1 us"],
            &[
                "the budget of",
                "is too small: at ",
                "steps/s, as measured, a reference with time_acceleration = ",
                "finer than the scene's time_acceleration = 20",
                "give --budget",
                "for a reference with 1, the model itself",
            ],
        ),
        (
            &[&["scene.toml", "--budget", "1 us"], &model[..]].concat(),
            &["too small", "the scene's own run, which is the reference, and one to hold against it take about"],
        ),
        (&["missing.toml"], &["missing.toml"]),
        (&["scene.toml", "--reference", "scene.toml"], &["scene.toml is no HDF5 file"]),
        (
            &["scene.toml", "--reference", "other.h5"],
            &["other.h5 is a run of another scene", "operation.normal_force: \"6 N\" there, \"5 N\" here"],
        ),
        (&["scene.toml", "--reference", "short.h5"], &["short.h5 ends at 10.", "expected 20 s"]),
        (&["scene.toml", "--reference", "stopped.h5"], &["stopped.h5 is interrupted, expected a run that is finished"]),
        (
            &["scene.toml", "--reference", "good.h5", "--ladder", "mesh", "--budget", "1 us"],
            &["the budget of", "is too small: at ", "the runs to hold against the reference take about"],
        ),
        // A reference is finer than what it judges.
        (
            &["scene.toml", "--reference", "good.h5", "--set", "numerics.time_acceleration=5"],
            &["the reference has time_acceleration = 5, the scene has time_acceleration = 5: expected a reference"],
        ),
        (
            &[&["scene.toml", "--reference", "good.h5"], &chosen[..]].concat(),
            &["the scene has time_acceleration = { tolerance = 0.01, max = 20 }: expected a reference"],
        ),
        (&["scene.toml", "-o", "scene.toml"], &["cannot make the folder scene.toml"]),
    ];
    for (arguments, words) in cases {
        expect_refusal(&directory, arguments, words);
    }
    directory.write("taken/accuracy.svg", "mine");
    expect_refusal(&directory, &["scene.toml", "-o", "taken"], &["taken/accuracy.svg exists; give --force"]);
}

/// Arguments that make the scene one of 196 million steps with `time_acceleration` = 1, which no machine does in 10 s.
fn long(time_acceleration: &str, budget: &str) -> Vec<String> {
    let sets = [
        "operation.duration=20000 s",
        "mesh.rows=1",
        // As long as two of the wide cells.
        "disc.surface.synthetic.correlation_length=400 um",
        "pin.surface.synthetic.correlation_length=400 um",
        &format!("numerics.time_acceleration={time_acceleration}"),
    ];
    let sets = sets.iter().flat_map(|set| ["--set".to_owned(), (*set).to_owned()]);
    sets.chain(["--budget", budget, "--ladder", "integrator"].map(str::to_owned)).collect()
}

#[test]
fn a_budget_for_no_finer_reference_is_too_small() {
    let directory = with_scene(&[]);
    // There would be time for runs that are coarser than the scene.
    let arguments = long("2", "4 s");
    let arguments: Vec<&str> = ["scene.toml"].into_iter().chain(arguments.iter().map(String::as_str)).collect();
    let words = [
        "the budget of 4.0 s is too small: at ",
        "a reference with time_acceleration = 1, finer than the scene's time_acceleration = 2",
        "give --budget ",
    ];
    expect_refusal(&directory, &arguments, &words);
}

#[test]
fn a_small_budget_has_a_reference_between_the_model_and_the_scene() {
    let directory = with_scene(&[]);
    // 1.3 million steps are needed.
    let arguments = long("1000", "20 s");
    let (text, rows) = measured(&directory, &arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(
        text.contains("the finest that the budget of 20.0 s allows; for 1, the model itself, give --budget"),
        "{text}"
    );
    let results = document(&directory);
    let reference = number_of(&results["reference"]["time_acceleration"]);
    assert!(1.0 < reference && reference < 1000.0, "{text}");
    assert!(rows.iter().all(|row| number(row, "time_acceleration") > reference), "{text}");
    assert!(rows.iter().any(|row| row["value"] == "1000.0"), "{text}");
    assert!(number_of(&results["reference"]["contact_area_error"]) > 0.0, "{text}");
}

#[test]
fn the_own_error_of_a_reference_is_that_of_its_opening_and_grows_with_the_scene() {
    let directory = with_scene(&[]);
    drop(run(&directory, "five.h5", &["numerics.time_acceleration=5".to_owned()]));
    let (text, rows) = measured(&directory, &["--ladder", "integrator,mesh", "--reference", "five.h5"]);
    let results = document(&directory);
    // Windows of the opening are whole revolutions with 5 and with 20: as wide as those of all runs.
    let end = number_of(&results["reference"]["opening_end"]);
    let windows = (end / WINDOW).round() as usize;
    assert!((1..=WINDOWS).contains(&windows) && (end / WINDOW - windows as f64).abs() < 1e-12, "{end}");
    let areas = |time_acceleration: &str| {
        let mut areas =
            mean_areas(&run(&directory, "run.h5", &[format!("numerics.time_acceleration={time_acceleration}")]));
        areas.truncate(windows);
        areas
    };
    let [model, reference, scene] = ["1", "5", "20"].map(areas);
    let opening = error(&reference, &model);
    expect_near(number_of(&results["reference"]["opening_error"]), opening, 1e-12, "error in the opening");
    let own = rows.iter().find(|row| row["value"] == "20.0").expect("the scene's own run");
    let growth = (number(own, "contact_area_error") / error(&scene, &reference)).max(1.0);
    let own_error = number_of(&results["reference"]["contact_area_error"]);
    expect_near(own_error, opening * growth, 1e-12, "own error");
    assert!(own_error > 0.0 && text.contains(" in contact area: "), "{text}");
    for row in &rows {
        let above = number(row, "contact_area_error") >= 3.0 * own_error;
        assert_eq!(number(row, "above_reference_error"), f64::from(u8::from(above)));
    }

    // A line across the figure.
    let figure = Figure::read(&fs::read_to_string(directory.path("accuracy/accuracy.svg")).unwrap());
    let panel = figure.panel(figure.boxes()[0]);
    let height = panel.y.place(100.0 * own_error);
    let is_there = |line: &[[f64; 2]]| line.len() == 2 && line.iter().all(|place| (place[1] - height).abs() < 3.0);
    assert!(figure.lines.iter().any(|(_, line)| is_there(line)), "no line at the reference's own error");
}

#[test]
fn nothing_is_advised_from_a_reference_that_is_hardly_better() {
    let directory = with_scene(&[]);
    drop(run(&directory, "half.h5", &["numerics.time_acceleration=10".to_owned()]));
    let (text, rows) = measured(&directory, &["--ladder", "integrator", "--reference", "half.h5"]);
    let results = document(&directory);
    let own_error = number_of(&results["reference"]["contact_area_error"]);
    for row in &rows {
        assert!(number(row, "contact_area_error") < 3.0 * own_error, "{own_error}: {row:?}");
        assert_eq!([number(row, "above_reference_error"), number(row, "on_front")], [0.0, 0.0]);
    }
    let advice = results["advice"][0].as_str().unwrap();
    assert!(advice.starts_with("no setting is advised") && results["advice"][1].is_null(), "{advice}");
    assert!(text.contains(advice) && text.contains("in brackets: the reference's own error is of that size"), "{text}");
    assert!(!text.contains("error in contact area use"), "{text}");

    let figure = Figure::read(&fs::read_to_string(directory.path("accuracy/accuracy.svg")).unwrap());
    let is_said = |words: &str| figure.texts.iter().any(|text| text.text.contains(words));
    assert!(is_said("its own error") && !is_said("no other run"), "{:?}", figure.texts);
}

#[test]
fn nothing_is_advised_that_is_slower_than_the_reference() {
    let directory = with_scene(&[]);
    drop(run(&directory, "quick.h5", &["numerics.time_acceleration=1".to_owned()]));
    let file = changed(directory.path("quick.h5"));
    file.attr("wall_time").unwrap().write_scalar(&1e-9).unwrap();
    file.close().unwrap();
    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration", "--reference", "quick.h5"]);
    assert!(text.contains("no setting is advised: no other run is quicker than the reference"), "{text}");
    assert!(!text.contains("error in contact area use"), "{text}");
    assert!(rows.len() == 4 && rows.iter().all(|row| number(row, "on_front") == 0.0), "{text}");

    // A reference that was cut out of a run has no wall time.
    let file = changed(directory.path("quick.h5"));
    file.attr("wall_time").unwrap().write_scalar(&f64::NAN).unwrap();
    file.close().unwrap();
    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration", "--reference", "quick.h5"]);
    assert!(text.contains("not recorded, for ") && !text.contains("NaN"), "{text}");
    assert!(rows.iter().any(|row| number(row, "on_front") == 1.0), "{text}");
}

#[test]
fn a_smooth_disc_with_pooled_debris_needs_the_model_itself_as_the_reference() {
    let directory = with_scene(&[]);
    let smooth = ["disc.prepare.scale=0.01", "plateaus.debris=contact", "plateaus.captured_fraction=0.06"];
    let sets = smooth.iter().chain(&["numerics.time_acceleration=2"]).map(|set| (*set).to_owned());
    drop(run(&directory, "two.h5", &sets.collect::<Vec<_>>()));
    let set: Vec<&str> = smooth.iter().flat_map(|set| ["--set", set]).collect();
    let (text, _) = measured(&directory, &[&["--ladder", "integrator", "--reference", "two.h5"], &set[..]].concat());
    assert!(text.contains("no setting is advised: on a disc as smooth as this one"), "{text}");
    assert!(text.contains("more later"), "{text}");
}

#[test]
fn a_signal_ends_it_in_good_order() {
    let directory = with_scene(&[]);
    let long = ["accuracy", "scene.toml", "--set", "operation.duration=1000 h", "--budget", "10000 h"];
    let mut command = directory.command(long);
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    // The folder is made just before signals are heard; the reference takes hours.
    let started = wait_until(|| directory.path("accuracy").is_dir());
    sleep(Duration::from_secs(1));
    let sent = Command::new("kill").args(["-s", "INT", &child.id().to_string()]).status().unwrap();
    let outcome = child.wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&outcome.stderr);
    assert!(started && sent.success());
    assert_eq!(outcome.status.code(), Some(130), "{message}");
    assert!(
        message.contains("stopped by signal 2 during the reference run with time_acceleration = 1; nothing is written"),
        "{message}"
    );
    assert_eq!(directory.names(), ["scene.toml"]);
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

#[test]
fn a_run_that_fails_is_in_the_table_and_the_others_go_on() {
    let directory = with_scene(&[]);
    // The explicit rule wears far beyond what numbers can hold; the exponential one no farther than the overlap.
    let sets = [
        "numerics.integrator=exponential",
        "materials.pin_primary.specific_wear_rate=1e100 1/Pa",
        "plateaus.debris=contact",
        "plateaus.captured_fraction=0.06",
    ];
    let mut arguments: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    arguments.extend(["--ladder", "integrator", "--ladder", "time_acceleration"]);
    let (text, rows) = measured(&directory, &arguments);
    let failed: Vec<&Row> = rows.iter().filter(|row| row["state"] == "failed").collect();
    assert_eq!(failed.len(), 1, "{text}");
    assert_eq!((failed[0]["integrator"].as_str(), failed[0]["contact_area_error"].as_str()), ("explicit", ""));
    assert!(failed[0]["failure"].contains("nothing carries the load"), "{failed:?}");
    assert!(rows.len() > 3 && text.contains("integrator = \"explicit\" failed: step "), "{text}");
    assert!(text.contains("above 2 it is unstable"), "{text}");
}
