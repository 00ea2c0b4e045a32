//! The command `surface` as docs/surface.md describes it.

mod pictures;

use std::fs;

use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, repository, scene};
use plateau_tests::run_file::{RunFile, created};
use serde_json::Value;

/// The measured surface that comes with the project: an AFM scan, of which `values.json` of the shared surfaces has the
/// parameters (letter G).
fn afm() -> String {
    repository().join("data/surfaces/afm_256x256.sdf").display().to_string()
}

/// An SDF of 4 x 3 points, in µm: a slope along x, with a point missing.
fn small_sdf() -> String {
    let heights = "0 1 2 3\n0 1 BAD 3\n0 1 2 3\n";
    format!(
        "aISO-1.0\nManufacID = test\nCreateDate = 010120250000\nModDate = 010120250000\nNumPoints = 4\nNumProfiles = 3\n\
         Xscale = 2e-6\nYscale = 5e-6\nZscale = 1e-6\nZresolution = -1\nCompression = 0\nDataType = 7\nCheckType = 0\n*\n\
         {heights}*\n"
    )
}

fn json(outcome: Outcome) -> Value {
    serde_json::from_str(&outcome.quiet_success()).expect("one JSON document")
}

/// What a command printed that may have warned: of small patches, and of those with few heights.
fn done(outcome: Outcome) -> String {
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    outcome.stdout
}

fn refused(outcome: &Outcome, reason: &str) {
    let Outcome { status, stdout, stderr } = outcome;
    assert_eq!((*status, stdout.as_str()), (Some(2), ""), "{stderr}");
    assert!(stderr.starts_with("plateau: ") && stderr.contains(reason), "{stderr}\nlacks {reason}");
}

#[test]
fn json_has_the_symbols_of_the_standard() {
    let surface = json(WorkingDirectory::new().plateau(["surface", &afm(), "--json"]));
    // Sa to Sku and Sz: shared values to all digits; the Sk family with its tolerance.
    for (symbol, expected, tolerance) in [
        ("Sa", 0.007850630292339372, 1e-6),
        ("Sq", 0.010084618656752626, 1e-6),
        ("Ssk", 0.3330687746659863, 1e-6),
        ("Sku", 3.065286171324044, 1e-6),
        ("Sz", 0.05503606503315581, 1e-6),
        ("Sk", 0.02176493496909058, 5e-3),
        ("Spk", 0.013370115360182578, 5e-3),
        ("Svk", 0.009136651324949466, 5e-3),
        ("Smr1", 15.135195812096514, 0.05 / 15.0),
        ("Smr2", 87.827632263372, 0.05 / 87.0),
        ("Sdq", 0.4280487450660783, 1e-9),
        ("Sdr", 8.282255201236532, 1e-9),
    ] {
        let found = surface[symbol].as_f64().unwrap_or(f64::NAN);
        assert!((found / expected - 1.0).abs() <= tolerance, "{symbol}: {found}, expected {expected}");
    }
    assert_eq!((&surface["columns"], &surface["rows"], &surface["coverage"]), (&256.into(), &256.into(), &1.0.into()));
    assert_eq!(surface["pitch"][0].as_f64().map(|pitch| (pitch * 1e9).round()), Some(1_953_125.0));
    assert_eq!(surface["level"], "least-squares plane");
    // Every number of a surface has a unit, and every unit a number.
    let units = surface["units"].as_object().expect("units");
    for (symbol, unit) in units {
        assert!(surface.get(symbol).is_some(), "{symbol}");
        assert!(["um", "1", "%", "deg"].iter().any(|known| unit == known), "{symbol}: {unit}");
    }
    let counts = ["columns", "rows", "points", "measured"];
    for (key, value) in surface.as_object().expect("an object") {
        assert!(!value.is_number() || units.contains_key(key) || counts.contains(&key.as_str()), "{key} has no unit");
    }
}

#[test]
fn several_surfaces_are_an_array_and_the_columns_of_a_table() {
    let directory = WorkingDirectory::new();
    directory.write("small.sdf", small_sdf());
    let surfaces = json(directory.plateau(["surface", "small.sdf", &afm(), "--json"]));
    assert_eq!((surfaces[0]["name"].as_str(), surfaces[0]["points"].as_u64()), (Some("small.sdf"), Some(12)));
    assert_eq!((surfaces[0]["measured"].as_u64(), surfaces[1]["measured"].as_u64()), (Some(11), Some(65_536)));
    let table = directory.plateau(["surface", "small.sdf", &afm()]).quiet_success();
    let line = |start: &str| table.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{table}"));
    assert!(table.lines().next().is_some_and(|line| line.ends_with("small.sdf      afm_256x256.sdf")), "{table}");
    assert!(line("Sq ").contains("um") && line("Sq ").ends_with("0.0100846"), "{table}");
    assert!(line("size ").contains("8 um x 15 um") && line("size ").ends_with("500 nm x 500 nm"), "{table}");
    assert!(table.contains("1 of 12 points are missing and take no part"), "{table}");
    assert!(table.lines().all(|line| line == line.trim_end()), "{table}");
}

#[test]
fn level_decides_what_is_taken_out() {
    let directory = WorkingDirectory::new();
    directory.write("small.sdf", small_sdf());
    let sq = |level: &[&str]| {
        let surface = json(directory.plateau([&["surface", "small.sdf", "--json"], level].concat()));
        surface["Sq"].as_f64().expect("Sq")
    };
    // The slope is a plane. Its heights 0, 1, 2, 3 occur 3, 3, 2 and 3 times: Σ z = 16, Σ z² = 38 over 11 points.
    assert_eq!((sq(&[]), sq(&["--level", "plane"])), (0.0, 0.0));
    let expected = (38.0 / 11.0 - (16.0_f64 / 11.0).powi(2)).sqrt();
    for level in ["none", "mean"] {
        assert!((sq(&["--level", level]) / expected - 1.0).abs() < 1e-14);
    }
    refused(&directory.plateau(["surface", "small.sdf", "--level", "cubic"]), "expected none, mean");
}

/// The cell of a parameter in the table of one surface.
fn cell<'a>(table: &'a str, symbol: &str) -> &'a str {
    let line = table.lines().find(|line| line.starts_with(&format!("{symbol:5} "))).expect(symbol);
    line.rsplit(' ').next().unwrap_or_default()
}

#[test]
fn a_slope_that_is_levelled_is_flat() {
    let directory = WorkingDirectory::new();
    directory.write("small.sdf", small_sdf());
    let surface = json(directory.plateau(["surface", "small.sdf", "--json"]));
    let table = directory.plateau(["surface", "small.sdf"]).quiet_success();
    for symbol in ["Sa", "Sq", "Sz", "Sk", "Spk", "Svk", "Vmc", "Sdq", "Sdr", "Ra_x", "Rq_y"] {
        assert_eq!((surface[symbol].as_f64(), cell(&table, symbol)), (Some(0.0), "0"), "{symbol}");
    }
    for symbol in ["Ssk", "Sku", "Smr1", "Smr2", "Sal", "Str", "Rsk_x", "Rku_y"] {
        assert_eq!((&surface[symbol], cell(&table, symbol)), (&Value::Null, "-"), "{symbol}");
    }
    assert!(table.contains("flat: all its heights are equal"), "{table}");
    let slope = directory.plateau(["surface", "small.sdf", "--level", "none"]).quiet_success();
    assert!(!slope.contains("flat:"), "{slope}");
}

#[test]
fn heights_that_are_unrelated_from_point_to_point_have_no_length() {
    let directory = WorkingDirectory::new();
    // Multiplication by a large prime scatters the numbers of the points: r at the next point is of the order of
    // 1/√(60 · 50).
    let noise = |point: u64| point.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_mul(point | 1) >> 61;
    let heights: Vec<String> = (1..=60 * 50).map(|point| noise(point).to_string()).collect();
    let sizes = ("NumPoints = 4\nNumProfiles = 3", "NumPoints = 60\nNumProfiles = 50");
    let sdf = small_sdf().replace(sizes.0, sizes.1).replace("0 1 2 3\n0 1 BAD 3\n0 1 2 3", &heights.join("\n"));
    directory.write("noise.sdf", sdf);
    let surface = json(directory.plateau(["surface", "noise.sdf", "--json"]));
    let table = directory.plateau(["surface", "noise.sdf"]).quiet_success();
    for symbol in ["Sal", "Str"] {
        assert_eq!((&surface[symbol], cell(&table, symbol)), (&Value::Null, "-"), "{symbol}");
    }
    assert!(surface["Sq"].is_number() && surface["Str_below"].is_null(), "{surface}");
    assert!(table.contains("Sal and Str have no value"), "{table}");
}

#[test]
fn without_a_pitch_what_needs_none_is_given() {
    let directory = WorkingDirectory::new();
    let heights: Vec<f64> = (0..12 * 10).map(|point| 0.2e-6 * f64::from(point * point % 17)).collect();
    let file = created(directory.path("heights.h5"));
    let heights = ndarray::ArrayView2::from_shape((12, 10), &heights).unwrap();
    file.new_dataset_builder().with_data(heights).create("height").unwrap();
    file.close().unwrap();
    let without = json(directory.plateau(["surface", "heights.h5", "--dataset", "height", "--json"]));
    let with =
        json(directory.plateau(["surface", "heights.h5", "--dataset", "height", "--json", "--pitch", "2 um, 0.5 um"]));
    assert_eq!(without["pitch"], Value::Null);
    assert_eq!(with["size"], serde_json::json!([24.0, 5.0]));
    for symbol in ["Sa", "Sk", "Vmp", "Ra_x", "Rku_y"] {
        assert!(without[symbol].is_number() && without[symbol] == with[symbol], "{symbol}");
    }
    for symbol in ["Sdq", "Sdr", "Sal", "Str"] {
        assert!(without.get(symbol).is_none() && with.get(symbol).is_some(), "{symbol}");
    }
    let table = directory.plateau(["surface", "heights.h5", "--dataset", "height"]).quiet_success();
    assert!(table.contains("Sdq, Sdr, Sal and Str need the distance of the points: give --pitch"), "{table}");
    for (pitch, reason) in [("2", "\"2\" has no unit"), ("0 um", "more than 0"), ("1 um, 2 N", "\"2 N\" is a force")] {
        let outcome = directory.plateau(["surface", "heights.h5", "--pitch", pitch]);
        assert_eq!(outcome.status, Some(2), "{pitch}");
        assert!(outcome.stderr.contains(reason), "{pitch}: {}", outcome.stderr);
    }
    refused(&directory.plateau(["surface", "heights.h5", "--to", "heights.sdf"]), "which --to needs: give --pitch");
}

#[test]
fn a_pitch_that_would_not_be_used_is_refused() {
    let outcome = WorkingDirectory::new().plateau(["surface", &afm(), "--pitch", "2 um", "--json"]);
    refused(&outcome, "for which pitch has no meaning: leave it out");
}

#[test]
fn a_converted_surface_is_the_same_surface() {
    let directory = WorkingDirectory::new();
    let parameters = |arguments: &[&str]| {
        let json = directory.plateau([&["surface"], arguments, &["--json"]].concat()).quiet_success();
        let mut document: Value = serde_json::from_str(&json).unwrap();
        // What differs is the file itself.
        let object = document.as_object_mut().unwrap();
        ["name", "format", "notes"].iter().for_each(|key| drop(object.remove(*key)));
        document
    };
    let original = parameters(&[&afm()]);
    assert!(original["Sq"].as_f64().unwrap() > 0.0, "{original}");
    for to in ["out.sdf", "out.h5"] {
        assert_eq!(parameters(&[&afm(), "--to", to]), original);
        assert_eq!(parameters(&[to]), original, "{to}");
    }
    parameters(&[&afm(), "--to", "out.npy"]);
    assert_eq!(parameters(&["out.npy", "--pitch", "1.953125 nm"]), original);
}

#[test]
fn files_are_replaced_only_on_demand() {
    let directory = WorkingDirectory::new();
    directory.write("small.sdf", small_sdf());
    directory.write("out.png", "precious");
    let plot = ["surface", "small.sdf", "--plot", "out.png"];
    refused(&directory.plateau(plot), "out.png exists; give --force to replace it");
    refused(&directory.plateau(["surface", "absent.sdf", "--plot", "out.png", "--force"]), "absent.sdf: ");
    assert_eq!(fs::read(directory.path("out.png")).unwrap(), b"precious");
    directory.plateau(plot.iter().chain(&["--force"])).quiet_success();
    assert!(directory.path("out.png").is_file());
    assert_eq!(directory.names(), ["out-2.png", "out.png", "small.sdf"]);
    fs::rename(directory.path("small.sdf"), directory.path("small.png")).unwrap();
    let itself = ["surface", "small.png", "--plot", "./small.png", "--force"];
    refused(&directory.plateau(itself), "small.png is an input and is not replaced");
    refused(&directory.plateau(["surface", "small.png", "--plot", "nowhere/a.png"]), "nowhere is not a directory");
    refused(&directory.plateau(["surface", "small.png", "--plot", "a.jpg"]), "expected the ending .png");
    refused(&directory.plateau(["surface", "small.png", "--to", "a.bmp"]), "a.bmp");
    refused(&directory.plateau(["surface", "small.png", &afm(), "--to", "a.sdf"]), "--to converts one FILE");
    assert_eq!(directory.names(), ["out-2.png", "out.png", "small.png"]);
}

#[test]
fn what_is_no_surface_is_refused() {
    let directory = WorkingDirectory::new();
    let rows = "BAD BAD BAD BAD\n".repeat(3);
    directory.write("all-missing.sdf", small_sdf().replace("0 1 2 3\n0 1 BAD 3\n0 1 2 3\n", &rows));
    directory.write("not.sdf", "\u{1}\u{2}\u{3}");
    for (file, reason) in [
        ("absent.sdf", "cannot be read"),
        (".", "this is a folder"),
        ("not.sdf", "not a surface file that is known"),
        ("all-missing.sdf", "none of its 12 points has a height"),
    ] {
        refused(&directory.plateau(["surface", file]), &format!("{file}: "));
        refused(&directory.plateau(["surface", file]), reason);
    }
    assert_eq!(directory.plateau(["surface"]).status, Some(2));
}

#[test]
fn a_scene_shows_what_it_makes_of_its_surfaces() {
    let directory = WorkingDirectory::new();
    directory.write("scene.toml", quick_scene_with(&[]));
    let bodies = json(directory.plateau(["surface", "--prepare", "scene.toml", "--json", "--plot", "both.png"]));
    let [disc, pin] = [&bodies[0], &bodies[1]];
    assert_eq!((disc["name"].as_str(), pin["name"].as_str()), (Some("disc"), Some("pin")));
    assert_eq!((disc["columns"].as_u64(), disc["rows"].as_u64()), (Some(690), Some(20)));
    assert_eq!((pin["columns"].as_u64(), pin["level"].as_str()), (Some(40), Some("nothing")));
    // Cut at one rms height of 3 µm: the highest points are at the cut, 3 µm above the mean before it.
    let (highest, lowered) = (disc["Sp"].as_f64().unwrap(), disc["Sq"].as_f64().unwrap());
    assert!(highest > 3.0 && highest < 3.5 && lowered < 3.0, "{highest} {lowered}");
    // 30 % fibres stand 8 µm above the resin, peaks positive: the skewness of two values p = 0.3 apart is positive.
    assert!(pin["Ssk"].as_f64().unwrap() > 0.5 && pin["Sz"].as_f64().unwrap() > 8.0, "{pin}");
    assert!(disc["notes"].as_array().unwrap().iter().any(|note| note.as_str().unwrap().contains("cut at 3 um")));
    assert!(directory.path("both.png").is_file());
    let table = directory.plateau(["surface", &afm(), "--prepare", "scene.toml"]).quiet_success();
    assert!(
        table.lines().next().is_some_and(|line| line.split_whitespace().eq(["afm_256x256.sdf", "disc", "pin"])),
        "{table}"
    );
    assert!(table.contains("pin.surface: resin set back by 8 um"), "{table}");
    directory.write("bad.toml", "version = 1\n");
    refused(&directory.plateau(["surface", "--prepare", "bad.toml"]), "required keys are missing");
}

#[test]
fn a_patch_is_shown_beside_what_a_scene_makes_of_it() {
    let directory = WorkingDirectory::new();
    let source = "synthetic = { seed = 1, rms_height = \"3 um\", correlation_length = \"200 um\" }";
    let file = format!("file = \"{}\"", afm());
    // 256 pixels of 3 um are 0.768 mm: narrower than the track of 1 mm.
    let prepare = |way: &str| format!("level = \"plane\"\npixel = \"3 um\"\nscale = 300\n{way}");
    for way in ["repeat = true", "extend = \"statistics\"\nextend_seed = 5"] {
        directory.write("scene.toml", quick_scene_with(&[(source, &file), ("cutoff = \"3 um\"", &prepare(way))]));
        let bodies = done(directory.plateau(["surface", "--prepare", "scene.toml", "--json"]));
        let bodies: Value = serde_json::from_str(&bodies).expect("one JSON document");
        let [disc, comparison] = [&bodies[0], &bodies[0]["comparison"]];
        assert!(bodies[1].get("comparison").is_none(), "the pin is of no patch");
        // 0.768 mm hold 4 cells of 186.7 um along (128.8 mm of ring have 690) and 15 of 50 um.
        assert_eq!((comparison["cells"][0].as_u64(), comparison["cells"][1].as_u64()), (Some(4), Some(15)));
        let of = |what: &str, symbol: &str| comparison[what][symbol].as_f64().unwrap_or(f64::NAN);
        // The patch is the whole scan, 300 times as high; form and pixel change no height.
        assert!((of("patch", "Sq") / (300.0 * 0.010084618656752626) - 1.0).abs() < 1e-6, "{comparison}");
        for symbol in ["Sa", "Sq", "Sdq", "Rq_y"] {
            let found = disc[symbol].as_f64().unwrap() - of("patch_in_cells", symbol);
            assert!((of("difference", symbol) - found).abs() < 1e-12, "{symbol}: {comparison}");
            assert!(of("sampling_error", symbol) > 0.0, "{symbol}: {comparison}");
        }
        // Averages over cells are no rougher than the patch.
        assert!(of("patch_in_cells", "Sq") < of("patch", "Sq"));
        assert!(comparison["sampling_error"]["Sz"].is_null());
        // Means over cells are within the heights of the patch.
        assert!(disc["Sz"].as_f64().unwrap() < of("patch", "Sz"));
        let picture = ["surface", "--prepare", "scene.toml", "--plot", "both.png", "--force"];
        let table = done(directory.plateau(picture));
        assert!(table.contains("averaged over 4 x 15 cells of 186.7 um x 50 um"), "{table}");
        let header = ["patch", "in", "cells", "+-", "disc", "difference"];
        assert!(table.lines().any(|line| line.split_whitespace().eq(header)), "{table}");
        assert!(directory.path("both.png").is_file());
    }
}

#[test]
fn roughness_is_in_the_run_file_on_request() {
    let directory = WorkingDirectory::new();
    let edits = [
        ("duration = \"60 s\"", "steps = 25"),
        ("sample_every = \"0.1 s\"", "sample_every_steps = 10\nroughness = true"),
        ("maps_at = [\"0 s\"]", "maps_at = []"),
    ];
    directory.write("scene.toml", quick_scene_with(&edits));
    directory.plateau(["run", "scene.toml", "-o", "one.h5"]).quiet_success();
    let one = RunFile::open(directory.path("one.h5"));
    for (body, sign) in [("disc", 1.0), ("pin", -1.0)] {
        // The last map's area-weighted moments, summed row by row; areas are as the radii.
        let (heights, radius) = (one.floats(&format!("/{body}/height")), one.floats("/radius"));
        let weights: Vec<f64> = radius.iter().cycle().take(heights.len()).copied().collect();
        let total: f64 = weights.iter().sum();
        let mean = |value: &dyn Fn(f64) -> f64| {
            heights.iter().zip(&weights).map(|(height, weight)| weight * value(*height)).sum::<f64>() / total
        };
        let centre = mean(&|height| height);
        let moment = |power: i32| mean(&|height: f64| (sign * (height - centre)).powi(power));
        let rms = moment(2).sqrt();
        for (name, expected) in [
            ("sa", mean(&|height: f64| (height - centre).abs())),
            ("sq", rms),
            ("ssk", moment(3) / rms.powi(3)),
            ("sku", moment(4) / rms.powi(4)),
        ] {
            let series = one.floats(&format!("/series/{body}_{name}"));
            assert_eq!(series.len(), 3);
            assert!((series[2] / expected - 1.0).abs() < 1e-11, "{body}_{name}: {series:?}, {expected}");
        }
    }
    // The same bits for any number of workers; without roughness nothing of it.
    directory.plateau(["run", "scene.toml", "-o", "three.h5", "--workers", "3"]).status.expect("an end");
    assert!(RunFile::open(directory.path("three.h5")).content() == one.content());
    directory.plateau(["run", "scene.toml", "-o", "none.h5", "--set", "output.roughness=false"]).quiet_success();
    let none = RunFile::open(directory.path("none.h5"));
    assert!(!none.has("/series/disc_sa") && none.has("/series/pool"));
    let check = json(directory.plateau(["check", "scene.toml", "--json"]));
    let reason = check["needed"].as_array().unwrap().iter().find(|part| part["part"] == "roughness with every sample");
    assert_eq!(reason.expect("the part")["reason"], "output.roughness = true");
}

#[test]
fn heights_of_a_run_are_described_before_and_after() {
    let directory = WorkingDirectory::new();
    let maps = "output.maps_at=[\"0 s\", \"1 s\", \"2 s\"]";
    let quick = scene("quick.toml");
    let sets = ["--set", "operation.duration=2 s", "--set", maps];
    directory.plateau([&["run", &quick, "-o", "run.h5"][..], &sets].concat()).quiet_success();
    let run = RunFile::open(directory.path("run.h5"));
    let all = json(directory.plateau(["surface", "run.h5", "--level", "mean", "--json"]));
    let names: Vec<&str> = all.as_array().unwrap().iter().map(|surface| surface["name"].as_str().unwrap()).collect();
    // Maps are those of the first step at or after their time.
    let expected = ["disc height, 0 s", "disc height, 2.00", "pin height, 0 s", "pin height, 2.00"];
    assert!(
        names.len() == 4
            && names.iter().zip(expected).all(|(name, begin)| name.starts_with(&format!("run.h5 {begin}")))
    );
    // Sq about the mean by its formula, in um, from the maps as another library reads them; the pin's peaks are at its least z.
    for (at, (map, moment)) in
        [("disc/height", 0), ("disc/height", 2), ("pin/height", 0), ("pin/height", 2)].into_iter().enumerate()
    {
        let heights = run.map(map, moment);
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        let square = heights.iter().map(|height| (height - mean).powi(2)).sum::<f64>() / heights.len() as f64;
        assert!((all[at]["Sq"].as_f64().unwrap() / (1e6 * square.sqrt()) - 1.0).abs() < 1e-9, "{map} {moment}");
        let sign = if map.starts_with("pin") { -1.0 } else { 1.0 };
        let peak = heights.iter().map(|height| sign * (height - mean)).fold(0.0, f64::max);
        assert!((all[at]["Sp"].as_f64().unwrap() / (1e6 * peak) - 1.0).abs() < 1e-9, "{map} {moment}");
    }
    // The table need not repeat the file.
    let table = directory.plateau(["surface", "run.h5"]).quiet_success();
    let heads = table.lines().next().unwrap();
    assert!(heads.contains("disc height, 0 s") && !heads.contains("run.h5"), "{heads}");
    // One of them, drawn and written for other programs.
    let one = ["--dataset", "disc/height", "--at", "0.9 s", "--to", "worn.sdf", "--plot", "worn.png"];
    let told = directory.plateau([&["surface", "run.h5"][..], &one].concat()).quiet_success();
    assert!(told.contains("wrote worn.sdf") && directory.path("worn.png").exists(), "{told}");
    let worn = json(directory.plateau(["surface", "worn.sdf", "--level", "mean", "--json"]));
    let recorded = ["surface", "run.h5", "--dataset", "disc/height", "--at", "1 s", "--level", "mean", "--json"];
    let recorded = json(directory.plateau(recorded));
    assert!((worn["Sq"].as_f64().unwrap() / recorded["Sq"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    for (more, reason) in [
        (&["--unit", "um"][..], "a run file says what its heights are: leave out --unit"),
        (
            &["--dataset", "disc/status"],
            "--dataset \"disc/status\": expected a map of heights: disc/height, pin/height",
        ),
        (&["--to", "all.sdf"], "--to converts one surface, and these are 4: say which with --dataset"),
    ] {
        refused(&directory.plateau([&["surface", "run.h5"][..], more].concat()), reason);
    }
    refused(&directory.plateau(["surface", &afm(), "--at", "1 s"]), "--at is a time of a run");
}
