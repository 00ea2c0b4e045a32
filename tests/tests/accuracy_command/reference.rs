//! Which reference is taken for a budget, how good it is, and what is advised from it.

use plateau_tests::run_file::changed;
use plateau_tests::table::{number, relative_error};

use super::{WINDOW, WINDOWS, document, expect_near, expect_refusal, mean_areas, measured, number_of, run, with_scene};

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
    let arguments = long("1000", "8 s");
    let (text, rows) = measured(&directory, &arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(
        text.contains("the finest that the budget of 8.0 s allows; for 1, the model itself, give --budget"),
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
    let opening = relative_error(&reference, &model);
    expect_near(number_of(&results["reference"]["opening_error"]), opening, 1e-12, "error in the opening");
    let own = rows.iter().find(|row| row["value"] == "20.0").expect("the scene's own run");
    let growth = (number(own, "contact_area_error") / relative_error(&scene, &reference)).max(1.0);
    let own_error = number_of(&results["reference"]["contact_area_error"]);
    expect_near(own_error, opening * growth, 1e-12, "own error");
    assert!(own_error > 0.0 && text.contains(" in contact area: "), "{text}");
    for row in &rows {
        let above = number(row, "contact_area_error") >= 3.0 * own_error;
        assert_eq!(number(row, "above_reference_error"), f64::from(u8::from(above)));
    }
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
