//! The command `surface` as docs/surface.md describes it.

mod pictures;

use std::fs;

use plateau_tests::program::{Outcome, WorkingDirectory, run, run_words};

/// An SDF of 4 x 3 points, in µm: a slope along x, with a point missing.
fn small_sdf() -> String {
    let heights = "0 1 2 3\n0 1 BAD 3\n0 1 2 3\n";
    format!(
        "aISO-1.0\nManufacID = test\nCreateDate = 010120250000\nModDate = 010120250000\nNumPoints = 4\nNumProfiles = 3\n\
         Xscale = 2e-6\nYscale = 5e-6\nZscale = 1e-6\nZresolution = -1\nCompression = 0\nDataType = 7\nCheckType = 0\n*\n\
         {heights}*\n"
    )
}

fn refused(outcome: &Outcome, reason: &str) {
    let Outcome { status, stdout, stderr, .. } = outcome;
    assert_eq!((*status, stdout.as_str()), (Some(2), ""), "{stderr}");
    assert!(stderr.starts_with("plateau: ") && stderr.contains(reason), "{stderr}\nlacks {reason}");
}

#[test]
fn files_are_replaced_only_on_demand() {
    let directory = WorkingDirectory::with("small.sdf", small_sdf());
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
    assert_eq!(directory.names(), ["out-2.png", "out.png", "small.png"]);
}

#[test]
fn roughness_is_in_the_run_file_on_request() {
    let edits = [
        ("duration = \"60 s\"", "steps = 25"),
        ("sample_every = \"0.1 s\"", "sample_every_steps = 10\nroughness = true"),
        ("maps_at = [\"0 s\"]", "maps_at = []"),
    ];
    let directory = WorkingDirectory::with_scene(&edits);
    directory.plateau(["run", "scene.toml", "-o", "one.h5"]).quiet_success();
    let one = directory.run_file("one.h5");
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
    assert!(directory.run_file("three.h5").content() == one.content());
    directory.plateau(["run", "scene.toml", "-o", "none.h5", "--set", "output.roughness=false"]).quiet_success();
    let none = directory.run_file("none.h5");
    assert!(!none.has("/series/disc_sa") && none.has("/series/pool"));
    let check = directory.plateau(["check", "scene.toml", "--json"]).json();
    let reason = check["needed"].as_array().unwrap().iter().find(|part| part["part"] == "roughness with every sample");
    assert_eq!(reason.expect("the part")["reason"], "output.roughness = true");
}

#[test]
fn what_cannot_be_asked_of_a_run_is_refused() {
    let directory = WorkingDirectory::new();
    let settings = ["operation.duration=1 s", "output.maps_at=[\"0 s\", \"1 s\"]"];
    directory.plateau(run_words("quick.toml", "run.h5", &settings, &[])).quiet_success();
    for (more, reason) in [
        (&["--unit", "um"][..], "a run file says what its heights are: leave out --unit"),
        (&["--dataset", "disc/status"], "\"disc/status\": expected a map of heights: disc/height, pin/height"),
        (&["--to", "all.sdf"], "--to converts one surface, and these are 4: say which with --dataset"),
    ] {
        refused(&directory.plateau([&["surface", "run.h5"][..], more].concat()), reason);
    }
}

#[test]
fn without_the_package_it_is_said_what_to_install_and_only_then() {
    let directory = WorkingDirectory::with("small.sdf", small_sdf());
    let call = |arguments: &[&str]| {
        let mut command = directory.command(arguments);
        command.env("PATH", "/usr/bin:/bin");
        run(command)
    };
    let outcome = call(&["surface", "small.sdf", "--json"]);
    assert_eq!((outcome.status, outcome.stdout.as_str()), (Some(1), ""), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("pip install 'plateau-brake[all]'") && outcome.stderr.lines().count() == 1);
    refused(&call(&["surface", "absent.sdf"]), "absent.sdf: ");
    // A file is written all the same.
    let outcome = call(&["surface", "small.sdf", "--to", "out.sdf"]);
    assert_eq!((outcome.status, outcome.stdout.as_str()), (Some(0), "wrote out.sdf\n"), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("pip install 'plateau-brake[all]'") && directory.path("out.sdf").is_file());
}
