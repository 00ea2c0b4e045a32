//! Which reference is taken for a budget, how good it is, and what is advised from it.

use plateau_tests::program::sets;
use plateau_tests::run_file::changed;
use plateau_tests::table::{number, relative_error};

use super::{QUANTITIES, WINDOW, WINDOWS, document, expect_near, means, measured, number_of, refusal, run, with_scene};

/// Arguments that make the scene one of 196 million steps with `time_acceleration` = 1, which no machine does in 10 s.
fn long(time_acceleration: &str, budget: &str) -> Vec<String> {
    let settings = [
        "operation.duration=20000 s",
        "mesh.rows=1",
        // As long as two of the wide cells.
        "disc.surface.synthetic.correlation_length=400 um",
        "pin.surface.synthetic.correlation_length=400 um",
        &format!("numerics.time_acceleration={time_acceleration}"),
    ];
    let words = sets(&settings).into_iter().chain(["--budget", budget, "--ladder", "time_acceleration"]);
    words.map(str::to_owned).collect()
}

#[test]
fn a_budget_for_no_finer_reference_is_too_small() {
    let directory = with_scene(&[]);
    // There would be time for runs that are coarser than the scene.
    let arguments = long("2", "4 s");
    let arguments: Vec<&str> = ["scene.toml"].into_iter().chain(arguments.iter().map(String::as_str)).collect();
    let message = refusal(&directory, &arguments);
    assert!(message.contains("the budget of 4.0 s is too small: at "), "{message}");
    assert!(message.contains("a reference with time_acceleration = 1 needs a budget of "), "{message}");
}

#[test]
fn a_small_budget_has_a_reference_between_the_model_and_the_scene() {
    let directory = with_scene(&[]);
    let arguments = long("1000", "8 s");
    // The coarsest reference takes 260 thousand steps, the model itself 500 times as many: the budget lies between on machines that take
    // 54 thousand to 27 million steps/s.
    let shorter = ["--set", "operation.duration=4000 s"];
    let (text, rows) = measured(&directory, &arguments.iter().map(String::as_str).chain(shorter).collect::<Vec<_>>());
    let said = "the finest that the budget of 8.0 s allows; for 1, the model itself, give --budget";
    assert!(text.contains(said), "{text}");
    let results = document(&directory);
    let reference = number_of(&results["reference"]["time_acceleration"]);
    assert!(1.0 < reference && reference < 1000.0, "{text}");
    assert!(rows.iter().all(|row| number(row, "time_acceleration") > reference), "{text}");
    assert!(rows.iter().any(|row| row["value"] == "1000.0"), "{text}");
    assert!(number_of(&results["reference"]["contact_area_error"]) > 0.0, "{text}");
}

#[test]
fn the_own_error_of_a_reference_is_that_of_its_opening_and_grows_with_the_finest_run() {
    let directory = with_scene(&[]);
    let sample_every = format!("output.sample_every={} s", WINDOW / 2.0);
    drop(run(&directory, "five.h5", &["numerics.time_acceleration=5", &sample_every]));
    let (text, rows) = measured(&directory, &["--reference", "five.h5"]);
    let results = document(&directory);
    assert!(text.contains("runs that choose their acceleration begin with 1: not run"), "{text}");
    let reference = |name: &str| number_of(&results["reference"][name]);
    let end = reference("opening_end");
    let windows = (end / WINDOW).round() as usize;
    assert!((1..=WINDOWS).contains(&windows) && (end / WINDOW - windows as f64).abs() < 1e-12, "{end}");
    let made =
        ["1", "5", "10"].map(|m| run(&directory, &format!("{m}.h5"), &[format!("numerics.time_acceleration={m}")]));
    let finest = rows.iter().find(|row| row["value"] == "10.0").expect("the finest run");
    let mut worst = 0.0_f64;
    for (name, series) in QUANTITIES {
        let [model, five, ten] = made.each_ref().map(|run| means(run, series)[..windows].to_vec());
        let opening = relative_error(&five, &model);
        expect_near(reference(&format!("{name}_opening_error")), opening, 1e-12, "error in the opening");
        let growth = (number(finest, &format!("{name}_error")) / relative_error(&ten, &five)).max(1.0);
        let own = reference(&format!("{name}_error"));
        expect_near(own, opening * growth, 1e-12, "own error");
        worst = worst.max(own);
    }
    assert_eq!(reference("error"), worst);
    assert!(worst > 0.0 && text.contains("about contact area "), "{text}");
}

#[test]
fn the_own_error_of_a_reference_counts_for_the_advice() {
    let directory = with_scene(&[]);
    drop(run(&directory, "half.h5", &["numerics.time_acceleration=10"]));
    let twenty = ["--reference", "half.h5", "--ladder", "time_acceleration"];
    let (_, rows) = measured(&directory, &twenty);
    let [error, own] = [number(&rows[0], "error"), number_of(&document(&directory)["reference"]["error"])];
    assert!(rows.len() == 1 && own > 0.0, "{rows:?}");
    // More than the error against the reference, but not more than both together.
    for (tolerance, words) in
        [(error + 0.5 * own, "no run has at most"), (1.001 * (error + own), " error use time_acceleration = 20")]
    {
        let tolerance = tolerance.to_string();
        let (text, _) = measured(&directory, &[&twenty[..], &["--tolerance", &tolerance]].concat());
        assert!(text.contains(words) && text.contains("and the reference's own error is about "), "{text}");
    }
}

#[test]
fn nothing_is_advised_that_is_slower_than_the_reference() {
    let directory = with_scene(&[]);
    drop(run(&directory, "quick.h5", &["numerics.time_acceleration=1"]));
    let with_wall_time = |time: f64| {
        let file = changed(directory.path("quick.h5"));
        file.attr("wall_time").unwrap().write_scalar(&time).unwrap();
        file.close().unwrap();
        measured(&directory, &["--ladder", "time_acceleration", "--reference", "quick.h5"])
    };
    let (text, rows) = with_wall_time(1e-9);
    assert!(text.contains("no setting is advised: no other run is quicker than the reference"), "{text}");
    assert!(!text.contains(" error use "), "{text}");
    assert!(rows.len() == 4 && rows.iter().all(|row| number(row, "on_front") == 0.0), "{text}");

    // A reference that was cut out of a run has no wall time.
    let (text, rows) = with_wall_time(f64::NAN);
    assert!(text.contains("not recorded, for ") && !text.contains("NaN"), "{text}");
    assert!(rows.iter().any(|row| number(row, "on_front") == 1.0), "{text}");
}

#[test]
fn a_smooth_disc_with_pooled_debris_needs_the_model_itself_as_the_reference() {
    let directory = with_scene(&[]);
    let smooth = ["disc.prepare.scale=0.01", "plateaus.debris=contact", "plateaus.captured_fraction=0.06"];
    drop(run(&directory, "two.h5", &[&smooth[..], &["numerics.time_acceleration=2"]].concat()));
    let message = refusal(&directory, &[&["scene.toml", "--reference", "two.h5"], &sets(&smooth)[..]].concat());
    assert!(message.contains("time_acceleration = 2: expected 1, the model itself"), "{message}");
}
