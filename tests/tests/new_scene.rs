//! `plateau new`: a scene to begin with that can be run as it stands.

use std::fs;

use plateau_tests::program::{WorkingDirectory, repository};
use plateau_tests::run_file::RunFile;

/// From nothing to a figure: a pin of 6 x 6 mm at 30 mm, 30 N, 600 rpm, a measured patch of half a millimetre.
#[test]
fn a_measured_patch_and_the_numbers_of_a_rig_become_a_run() {
    let directory = WorkingDirectory::new();
    fs::copy(repository().join("data/surfaces/afm_256x256.sdf"), directory.path("patch.sdf")).unwrap();
    // The same heights at 2 um a point: 0.512 mm wide.
    let numbers = ["--pin-width=6 mm", "--pin-length=6 mm", "--radius=30 mm", "--load=30 N", "--speed=600 rpm"];
    let new = [&["new", "mine.toml", "--disc", "patch.sdf", "--duration=2 s"][..], &numbers].concat();
    let outcome = directory.plateau(&new).ends(0, &[]);
    assert!(outcome.stdout.contains("plateau run mine.toml"), "{}", outcome.stdout);
    let text = fs::read_to_string(directory.path("mine.toml")).unwrap();
    let own = text.lines().filter(|line| line.contains("# <-")).count();
    assert!((8..15).contains(&own), "{own} keys are the user's:\n{text}");
    assert!(text.lines().count() <= 60, "more than a page:\n{text}");
    // The scan is smaller than a cell, and nothing offers to read it as larger.
    assert!(text.contains("less than 4 cells") && !text.contains("pixel = "), "{text}");
    directory.plateau(["check", "mine.toml"]).ends(2, &["take smaller cells"]);
    // Sq of the scan is 10.08 nm in surfalize 0.19.2, slippy 0.5.2 and SurfaceTopography 1.27.1.
    assert!(text.contains("\n# cutoff = \"10 nm\" "), "{text}");
    assert!(outcome.stdout.contains("no peaks are cut. With cutoff = \"10 nm\", one rms height"), "{}", outcome.stdout);
    fs::write(directory.path("mine.toml"), text.replace("[disc.prepare]", "[disc.prepare]\npixel = \"2 um\"")).unwrap();
    for command in [&["check", "mine.toml"][..], &["run", "mine.toml"], &["summary", "mine.h5"]] {
        let outcome = directory.plateau(command);
        assert_eq!(outcome.status, Some(0), "{command:?}: {}", outcome.stderr);
    }
    // 6 mm are 120 cells; the ring at 30 mm has 2 pi 30 mm / 50 um = 3769.9 of them, and 6 mm of it 120.
    let run = RunFile::open(directory.path("mine.h5"));
    assert_eq!(
        [run.floats("radius").len(), run.floats("disc_angle").len(), run.floats("pin_angle").len()],
        [120, 3770, 120]
    );
}

#[test]
fn the_path_of_the_surface_is_relative_to_the_scene() {
    let directory = WorkingDirectory::new();
    fs::create_dir(directory.path("scenes")).unwrap();
    fs::copy(repository().join("data/surfaces/afm_256x256.sdf"), directory.path("scenes/patch.sdf")).unwrap();
    directory.plateau(["new", "scenes/mine.toml", "--disc", "scenes/patch.sdf", "--diameter=10 mm"]).quiet_success();
    let text = fs::read_to_string(directory.path("scenes/mine.toml")).unwrap();
    assert!(text.contains("file = \"patch.sdf\"") && text.contains("shape = \"disc\""), "{text}");
    // It is found from elsewhere; as it stands the scan is too small.
    directory.plateau(["check", "scenes/mine.toml", "--set", "disc.prepare.pixel=50 um"]).ends(0, &[]);
}

#[test]
fn what_is_there_or_makes_no_sense_is_refused() {
    let directory = WorkingDirectory::new();
    directory.plateau(["new", "mine.toml"]).quiet_success();
    let before = fs::read(directory.path("mine.toml")).unwrap();
    for (arguments, found) in [
        (&["new", "mine.toml"][..], "--force"),
        (&["new", "other.toml", "--load", "30 mm"], "is a length, expected a force"),
        (&["new", "other.toml", "--load=-3 N"], "expected more than 0"),
        (&["new", "other.toml", "--diameter", "5 mm", "--pin-width", "5 mm"], "cannot be used with"),
        (&["new", "other.toml", "--disc", "mine.toml"], "mine.toml"),
        (&["new", "mine.toml", "--force", "--disc", "mine.toml"], "mine.toml"),
    ] {
        let outcome = directory.plateau(arguments);
        assert_eq!(outcome.status, Some(2), "{arguments:?}: {}", outcome.stdout);
        assert!(outcome.stderr.contains(found), "{arguments:?}: {}", outcome.stderr);
    }
    assert_eq!(fs::read(directory.path("mine.toml")).unwrap(), before);
    assert_eq!(directory.names(), ["mine.toml"]);
    // A pin that does not fit its ring is told before the scene is written, by the option that was given.
    for (options, expected) in [
        (["--diameter", "60 mm"], "--diameter \"60 mm\": a pin of 60 mm does not fit"),
        (["--diameter", "43.9 mm"], "--diameter \"43.9 mm\": a round pin of 43.9 mm"),
        (["--pin-length", "200 mm"], "a larger --radius"),
    ] {
        directory.plateau(["new", "wide.toml"].iter().chain(&options)).ends(2, &[expected, "nothing is written"]);
    }
    assert_eq!(directory.names(), ["mine.toml"]);
}

#[test]
fn a_profile_becomes_a_disc_when_its_lay_is_said() {
    let directory = WorkingDirectory::new();
    // 3 mm of a wave of 0.4 mm and 1 um, two numbers a line.
    let point = |i: u32| (f64::from(i) * 1e-3, (f64::from(i) * 1e-3 * std::f64::consts::TAU / 0.4).sin());
    let text: String = (0..3000).map(point).map(|(x, z)| format!("{x:.3} {z:.6}\n")).collect();
    directory.write("profile.txt", text);
    let new = ["new", "mine.toml", "--disc", "profile.txt", "--pitch", "1 um", "--unit", "um"];
    directory.plateau(new).ends(2, &["give --profile-lay along for grooves along sliding"]);
    for lay in ["along", "across", "isotropic"] {
        directory.plateau([&new[..], &["--force", "--profile-lay", lay]].concat()).quiet_success();
        let text = fs::read_to_string(directory.path("mine.toml")).unwrap();
        assert!(text.contains(&format!("profile_lay = \"{lay}\"")) && text.contains("unit = \"um\""), "{text}");
        let outcome = directory.plateau(["surface", "--prepare", "mine.toml"]);
        assert_eq!(outcome.status, Some(0), "{lay}: {}", outcome.stderr);
    }
}

#[test]
fn spikes_and_a_sliding_speed_are_taken_as_they_are_meant() {
    let directory = WorkingDirectory::new();
    // 60 x 60 points of 50 um, a wave of 1 um with four spikes of 60 um.
    let height = |i: u32, j: u32| if i % 30 == 7 && j % 30 == 3 { 60.0 } else { (f64::from(i + 2 * j) / 5.0).sin() };
    let row = |j: u32| (0..60).map(|i| format!("{:.4}", height(i, j))).collect::<Vec<_>>().join(",") + "\n";
    directory.write("spikes.csv", format!("unit: um\npitch: 50 um\n{}", (0..60).map(row).collect::<String>()));
    let new = ["new", "mine.toml", "--disc", "spikes.csv", "--speed", "3 m/s", "--duration", "1 s"];
    let said = directory.plateau(new).quiet_success();
    assert!(said.contains("note: spikes.csv: 4 of 3600 points are spikes") && said.contains("outliers = 6"), "{said}");
    let text = fs::read_to_string(directory.path("mine.toml")).unwrap();
    for line in
        // 3 m/s at 22 mm are 3/0.022 rad/s.
        [
            "or rotational_speed = \"1302 rpm\"",
            "outliers = 6 ",
            "fill = \"interpolate\"",
            "sliding_speed = \"3 m/s\"",
            "maps_at = [\"0 s\"]",
            "# rotate = ",
        ]
    {
        assert!(text.contains(line), "{line} in\n{text}");
    }
    let outcome = directory.plateau(["run", "mine.toml"]).ends(0, &[]);
    assert!(outcome.stdout.contains("outliers: 4 of 3600 points"), "{}", outcome.stdout);
    // 3 m/s at 22 mm.
    assert!(RunFile::open(directory.path("mine.h5")).text("scene").contains("sliding_speed"), "{}", outcome.stdout);
    fs::copy(repository().join("data/surfaces/afm_256x256.sdf"), directory.path("afm.sdf")).unwrap();
    let said = directory.plateau(["new", "afm.toml", "--disc", "afm.sdf"]).quiet_success();
    assert!(said.contains("the scene does not run as it is: take a cell_size of at most 125 nm"), "{said}");
    assert!(!said.contains("pixel"), "{said}");
}

#[test]
fn a_distance_of_points_that_nobody_states_is_asked_for() {
    let directory = WorkingDirectory::new();
    let row =
        |j: u32| (0..200).map(|i| format!("{:.4}", f64::from((i * i + 3 * j * j) % 23))).collect::<Vec<_>>().join(",");
    directory.write("matrix.csv", (0..200).map(|j| row(j) + "\n").collect::<String>());
    let new = ["new", "mine.toml", "--disc", "matrix.csv", "--unit", "um"];
    directory.plateau(new).ends(2, &["how far its points are apart: give --pitch"]);
    assert_eq!(directory.names(), ["matrix.csv"]);
    directory.plateau([&new[..], &["--pitch", "5 um"]].concat()).quiet_success();
    assert!(fs::read_to_string(directory.path("mine.toml")).unwrap().contains("pitch = \"5 um\""));
    // The same with numbers of lines in front and of columns above, as tables of Python are saved.
    let head = (0..200).map(|i| format!(",{i}")).collect::<String>() + "\n";
    directory.write("labels.csv", head + &(0..200).map(|j| format!("{j},{}\n", row(j))).collect::<String>());
    let described = directory.plateau(["surface", "labels.csv", "--unit", "um", "--pitch", "5 um"]);
    for what in ["the first column counts evenly to 199, from 0 on", "the first line counts evenly to 199"] {
        assert!(described.status == Some(0) && described.stderr.contains(what), "{}", described.stderr);
    }
}

#[test]
fn a_unit_that_can_hardly_be_meant_is_told_at_once() {
    let directory = WorkingDirectory::new();
    // A list as instruments write it: 60 x 60 points 25 um apart, x and y in mm, z in um, a wave of 1 um; no line says so.
    let line = |point: u32| {
        let (x, y) = (f64::from(point % 60), f64::from(point / 60));
        format!("{:.3};{:.3};{:.4}\n", 0.025 * x, 0.025 * y, ((x + 2.0 * y) / 5.0).sin())
    };
    directory.write("probe.xyz", (0..3600).map(line).collect::<String>());
    let refused = directory.plateau(["new", "mine.toml", "--disc", "probe.xyz", "--unit", "um"]).ends(2, &[]);
    let advice =
        r#"points 25 nm by 25 nm apart, 1.5 um by 1.5 um in all; if they are in mm, say pitch = ["25 um", "25 um"]"#;
    assert!(
        refused.stderr.contains(advice) && refused.stderr.contains("(on the command line: --pitch)"),
        "{}",
        refused.stderr
    );
    directory.plateau(["surface", "probe.xyz", "--unit", "um"]).ends(0, &[advice]);
    // In a scene that tiles it: the first warning names the cause.
    directory.write(
        "tiled.toml",
        "extends = \"mine.toml\"\n[disc.surface]\nfile = \"probe.xyz\"\nunit = \"um\"\n[disc.prepare]\nlevel = \"plane\"\nrepeat = true\n",
    );
    directory.plateau(["new", "mine.toml", "--duration", "1 s"]).quiet_success();
    let ran = directory.plateau(["run", "tiled.toml"]);
    let first = ran.stderr.lines().next().unwrap_or_default();
    assert!(ran.status == Some(0) && first.starts_with("plateau: warning: disc.surface: "), "{}", ran.stderr);
    assert!(first.contains(advice), "{first}");
    assert!(ran.stderr.contains("the patch of 1.5 um by 1.5 um is smaller than a cell of"), "{}", ran.stderr);
    // Heights of 0.7 um rms, read as mm and as nm: by hand 1/sqrt(2) of the unit.
    for (unit, bound) in [("mm", "at most 1 mm"), ("m", "at most 1 mm"), ("nm", "at least 5 nm")] {
        let pitch = ["--pitch", "25 um", "--unit", unit];
        for command in [&["surface", "probe.xyz"][..], &["new", "odd.toml", "--force", "--disc", "probe.xyz"]] {
            let told = directory.plateau([command, &pitch].concat());
            let is_told = told.stderr.contains("the heights have an rms of") && told.stderr.contains(bound);
            // 0.7 mm is a surface that is scored deeply.
            assert_eq!((told.status, is_told), (Some(0), unit != "mm"), "{unit}: {}", told.stderr);
        }
    }
    // What programs write where there is no height.
    let row = |row: u32| {
        let cell = |column: u32| {
            if (row * 60 + column) % 97 == 5 {
                "-9999".to_owned()
            } else {
                format!("{:.3}", (f64::from(row + 2 * column) / 5.0).sin())
            }
        };
        (0..60).map(cell).collect::<Vec<_>>().join(",") + "\n"
    };
    directory.write("gaps.csv", format!("unit: um\npitch: 25 um\n{}", (0..60).map(row).collect::<String>()));
    let told = directory.plateau(["surface", "gaps.csv"]);
    // 5, 102, ... up to 3599: 38 of them.
    let expected = "gaps.csv: 38 points have the height -9.999 mm, far from all others";
    assert!(told.status == Some(0) && told.stderr.contains(expected), "{}", told.stderr);
}

#[test]
fn a_bowed_surface_with_few_spikes_is_put_right() {
    let directory = WorkingDirectory::new();
    // 100 x 100 points of 20 um: 17 equal steps, rms √24/4.6 = 1.06 um if all were as many, on a bow of 8 um from the middle to the ends, rms 8 √(4/45) = 2.39 um, and seven
    // spikes of 20 um.
    let rough = |i: u32, j: u32| (f64::from((i * 7919 + j * 104_729 + i * j * 31) % 17) - 8.0) / 4.6;
    let height = |i: u32, j: u32| {
        let x = f64::from(i) / 49.5 - 1.0;
        8.0 * x * x + rough(i, j) + if (100 * j + i) % 1409 == 700 { 20.0 } else { 0.0 }
    };
    let row = |j: u32| (0..100).map(|i| format!("{:.4}", height(i, j))).collect::<Vec<_>>().join("\t") + "\n";
    let head = "Protocol 7\n100 points each\nunit: um\npitch: 20 um\n";
    directory.write("bowed.txt", format!("{head}{}", (0..100).map(row).collect::<String>()));
    // One step to where the table is understood: what the header says right above it is kept.
    let refused = directory.plateau(["new", "mine.toml", "--disc", "bowed.txt"]);
    assert!(
        refused.stderr.contains("skip = 2 below file in the scene") && refused.stderr.contains("--skip"),
        "{}",
        refused.stderr
    );
    let said = directory.plateau(["new", "mine.toml", "--disc", "bowed.txt", "--skip", "2"]).quiet_success();
    for note in ["level = \"quadratic\"", "7 of 10000 points are spikes", "outliers = 6", "With cutoff = \"1 um\""] {
        assert!(said.contains(note), "{note} in {said}");
    }
    let text = fs::read_to_string(directory.path("mine.toml")).unwrap();
    for line in ["level = \"quadratic\"", "outliers = 6 ", "fill = \"interpolate\"", "# cutoff = \"1 um\""] {
        assert!(text.contains(line), "{line} in\n{text}");
    }
}

#[test]
fn a_micrograph_becomes_the_fibres_of_the_pin_and_is_repeated_where_it_is_too_small() {
    let directory = WorkingDirectory::new();
    // The shipped picture, 352 x 192 pixels, with a statement of so many in a metre behind its header.
    let picture = fs::read(repository().join("data/surfaces/micrograph.png")).unwrap();
    let write = |per_metre: Option<u32>| {
        let mut content = picture.clone();
        if let Some(count) = per_metre.map(u32::to_be_bytes) {
            let chunk = [&b"pHYs"[..], &count, &count, &[1]].concat();
            let mut sum = flate2::Crc::new();
            sum.update(&chunk);
            content.splice(33..33, [&9_u32.to_be_bytes()[..], &chunk, &sum.sum().to_be_bytes()].concat());
        }
        directory.write("pin.png", content);
    };
    write(None);
    let new = ["new", "mine.toml", "--micrograph", "pin.png"];
    let refused = directory.plateau(new);
    assert_eq!(refused.status, Some(2), "{}", refused.stdout);
    assert!(refused.stderr.contains("give --pixel, such as --pixel \"2 um\""), "{}", refused.stderr);
    // 8.8 by 4.8 mm cover the pin of 6 by 4 mm.
    let numbers = ["--pin-width=4 mm", "--pin-length=6 mm", "--duration=1 s"];
    let said = directory.plateau([&new[..], &numbers, &["--pixel", "25 um"]].concat()).quiet_success();
    assert!(said.contains("pin.png: 8.8 mm by 4.8 mm; fibre is ") && said.contains(" % of the pin: compare"), "{said}");
    let text = fs::read_to_string(directory.path("mine.toml")).unwrap();
    for line in ["image = \"pin.png\" ", "pixel = \"25 um\" ", "threshold = \"otsu\" ", "fibres = \"bright\" "] {
        assert!(text.contains(line), "{line} in\n{text}");
    }
    assert!(!text.contains("repeat"), "{text}");
    // What a microscope states is taken, what a program prints at is not.
    write(Some(200_000));
    let said = directory.plateau([&new[..], &numbers, &["--force"]].concat()).quiet_success();
    assert!(said.contains("pixels of 5 um are what it states") && said.contains("smaller than the pin"), "{said}");
    let text = fs::read_to_string(directory.path("mine.toml")).unwrap();
    assert!(text.contains("pixel = \"5 um\" ") && text.contains("\nrepeat = true "), "{text}");
    let run = directory.plateau(["run", "mine.toml"]);
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    assert!(run.stdout.contains("the picture of 1.76 mm by 960 um repeated 3."), "{}", run.stdout);
    let said = directory.plateau([&new[..], &numbers, &["--force", "--pixel", "25 um"]].concat()).quiet_success();
    assert!(said.contains("it states pixels of 5 um, --pixel 25 um, which holds"), "{said}");
    write(Some(2835));
    let refused = directory.plateau([&new[..], &["--force"]].concat());
    assert!(
        refused.stderr.contains("it states pixels of 352.7 um, at which a program would print it"),
        "{}",
        refused.stderr
    );
    let refused = directory.plateau(["new", "other.toml", "--pixel", "2 um"]);
    assert!(refused.status == Some(2) && refused.stderr.contains("--micrograph"), "{}", refused.stderr);
    assert!(!directory.path("other.toml").exists());
}
