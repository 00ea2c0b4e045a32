//! `plateau new`: a scene to begin with that can be run as it stands.

use std::fs;

use plateau_tests::program::{WorkingDirectory, repository};

/// Makes a scene; what was said, and what in the scene is the user's.
fn new(directory: &WorkingDirectory, arguments: &[&str]) -> String {
    let outcome = directory.plateau(["new"].iter().chain(arguments)).ends(0, &[]);
    let text = directory.text(arguments[0]);
    let (_, own) = text.split_once("\n[operation]\n").expect("the operation");
    let (own, _) = own.split_once("\n# The rest are the numbers").expect("what is the paper's");
    format!("$ plateau new {}\n{}{}\n{own}\n", arguments.join(" "), outcome.stdout, outcome.stderr)
}

/// From nothing to a figure: a pin of 6 x 6 mm at 30 mm, 30 N, 600 rpm, a measured patch of half a millimetre.
#[test]
fn a_measured_patch_and_the_numbers_of_a_rig_become_a_run() {
    let directory = WorkingDirectory::new();
    fs::copy(repository().join("data/surfaces/afm_256x256.sdf"), directory.path("patch.sdf")).unwrap();
    // The same heights at 2 um a point: 0.512 mm wide.
    let numbers = ["--pin-width=6 mm", "--pin-length=6 mm", "--radius=30 mm", "--load=30 N", "--speed=600 rpm"];
    // The scan is smaller than a cell, and nothing offers to read it as larger. Its Sq is 10.08 nm in surfalize 0.19.2, slippy 0.5.2 and
    // SurfaceTopography 1.27.1.
    let arguments = [&["mine.toml", "--disc", "patch.sdf", "--duration=2 s"][..], &numbers].concat();
    let said = new(&directory, &arguments);
    let text = directory.text("mine.toml");
    assert!(text.lines().count() <= 60, "more than a page:\n{text}");
    let (_, rest) = text.split_once("\n# The rest").expect("what is the paper's");
    insta::assert_snapshot!(format!("{said}\n# The rest{rest}"));
    directory.plateau(["check", "mine.toml"]).ends(2, &["take smaller cells"]);
    fs::write(directory.path("mine.toml"), text.replace("[disc.prepare]", "[disc.prepare]\npixel = \"2 um\"")).unwrap();
    for command in [&["check", "mine.toml"][..], &["run", "mine.toml"], &["summary", "mine.h5"]] {
        directory.plateau(command).ends(0, &[]);
    }
    // 6 mm are 120 cells; the ring at 30 mm has 2 pi 30 mm / 50 um = 3769.9 of them, and 6 mm of it 120.
    let run = directory.run_file("mine.h5");
    assert_eq!(["radius", "disc_angle", "pin_angle"].map(|name| run.floats(name).len()), [120, 3770, 120]);
}

#[test]
fn the_path_of_the_surface_is_relative_to_the_scene() {
    let directory = WorkingDirectory::new();
    fs::create_dir(directory.path("scenes")).unwrap();
    fs::copy(repository().join("data/surfaces/afm_256x256.sdf"), directory.path("scenes/patch.sdf")).unwrap();
    directory.plateau(["new", "scenes/mine.toml", "--disc", "scenes/patch.sdf", "--diameter=10 mm"]).quiet_success();
    let text = directory.text("scenes/mine.toml");
    assert!(text.contains("file = \"patch.sdf\"") && text.contains("shape = \"disc\""), "{text}");
    // It is found from elsewhere; as it stands the scan is too small.
    directory.plateau(["check", "scenes/mine.toml", "--set", "disc.prepare.pixel=50 um"]).ends(0, &[]);
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
        let text = directory.text("mine.toml");
        assert!(text.contains(&format!("profile_lay = \"{lay}\"")) && text.contains("unit = \"um\""), "{text}");
        directory.plateau(["surface", "--prepare", "mine.toml"]).ends(0, &[]);
    }
}

#[test]
fn spikes_and_a_sliding_speed_are_taken_as_they_are_meant() {
    let directory = WorkingDirectory::new();
    // 60 x 60 points of 50 um, a wave of 1 um with four spikes of 60 um.
    let height = |i: u32, j: u32| if i % 30 == 7 && j % 30 == 3 { 60.0 } else { (f64::from(i + 2 * j) / 5.0).sin() };
    let row = |j: u32| (0..60).map(|i| format!("{:.4}", height(i, j))).collect::<Vec<_>>().join(",") + "\n";
    directory.write("spikes.csv", format!("unit: um\npitch: 50 um\n{}", (0..60).map(row).collect::<String>()));
    // 3 m/s at 22 mm are 3/0.022 rad/s.
    let spikes = new(&directory, &["mine.toml", "--disc", "spikes.csv", "--speed", "3 m/s", "--duration", "1 s"]);
    let outcome = directory.plateau(["run", "mine.toml"]).ends(0, &[]);
    assert!(outcome.stdout.contains("outliers: 4 of 3600 points"), "{}", outcome.stdout);
    assert!(directory.run_file("mine.h5").text("scene").contains("sliding_speed"), "{}", outcome.stdout);
    fs::copy(repository().join("data/surfaces/afm_256x256.sdf"), directory.path("afm.sdf")).unwrap();
    insta::assert_snapshot!(spikes + &new(&directory, &["afm.toml", "--disc", "afm.sdf"]));
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
    assert!(directory.text("mine.toml").contains("pitch = \"5 um\""));
    // The same with numbers of lines in front and of columns above, as tables of Python are saved.
    let head = (0..200).map(|i| format!(",{i}")).collect::<String>() + "\n";
    directory.write("labels.csv", head + &(0..200).map(|j| format!("{j},{}\n", row(j))).collect::<String>());
    let labels = ["the first column counts evenly to 199, from 0 on", "the first line counts evenly to 199"];
    directory.plateau(["surface", "labels.csv", "--unit", "um", "--pitch", "5 um"]).ends(0, &labels);
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
    let advice =
        r#"points 25 nm by 25 nm apart, 1.5 um by 1.5 um in all; if they are in mm, say pitch = ["25 um", "25 um"]"#;
    let probe = ["new", "mine.toml", "--disc", "probe.xyz", "--unit", "um"];
    directory.plateau(probe).ends(2, &[advice, "(on the command line: --pitch)"]);
    directory.plateau(["surface", "probe.xyz", "--unit", "um"]).ends(0, &[advice]);
    // In a scene that tiles it: the first warning names the cause.
    let surface =
        "[disc.surface]\nfile = \"probe.xyz\"\nunit = \"um\"\n[disc.prepare]\nlevel = \"plane\"\nrepeat = true\n";
    directory.write("tiled.toml", format!("extends = \"mine.toml\"\n{surface}"));
    directory.plateau(["new", "mine.toml", "--duration", "1 s"]).quiet_success();
    let small = "the patch of 1.5 um by 1.5 um is smaller than a cell of";
    let ran = directory.plateau(["run", "tiled.toml"]).ends(0, &[small]);
    let first = ran.stderr.lines().next().unwrap_or_default();
    assert!(first.starts_with("plateau: warning: disc.surface: ") && first.contains(advice), "{first}");
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
        let is_gap = |column: u32| (row * 60 + column) % 97 == 5;
        let height = |column: u32| if is_gap(column) { -9999.0 } else { (f64::from(row + 2 * column) / 5.0).sin() };
        let cell = |column: u32| format!("{:.3}", height(column));
        (0..60).map(cell).collect::<Vec<_>>().join(",") + "\n"
    };
    directory.write("gaps.csv", format!("unit: um\npitch: 25 um\n{}", (0..60).map(row).collect::<String>()));
    // 5, 102, ... up to 3599: 38 of them.
    let expected = "gaps.csv: 38 points have the height -9.999 mm, far from all others";
    directory.plateau(["surface", "gaps.csv"]).ends(0, &[expected]);
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
    let bowed = ["new", "mine.toml", "--disc", "bowed.txt"];
    directory.plateau(bowed).ends(2, &["skip = 2 below file in the scene", "--skip"]);
    insta::assert_snapshot!(new(&directory, &["mine.toml", "--disc", "bowed.txt", "--skip", "2"]));
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
    let picture_of = ["mine.toml", "--micrograph", "pin.png"];
    let refused = |more: &[&str], said: &str| {
        directory.plateau([&["new"], &picture_of[..], more].concat()).ends(2, &[said]);
    };
    refused(&[], "give --pixel, such as --pixel \"2 um\"");
    // 8.8 by 4.8 mm cover the pin of 6 by 4 mm.
    let numbers = ["--pin-width=4 mm", "--pin-length=6 mm", "--duration=1 s"];
    let mut said = new(&directory, &[&picture_of[..], &numbers, &["--pixel", "25 um"]].concat());
    // What a microscope states is taken, what a program prints at is not.
    write(Some(200_000));
    said += &new(&directory, &[&picture_of[..], &numbers, &["--force"]].concat());
    let run = directory.plateau(["run", "mine.toml"]);
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    assert!(run.stdout.contains("the picture of 1.76 mm by 960 um repeated 3."), "{}", run.stdout);
    said += &new(&directory, &[&picture_of[..], &numbers, &["--force", "--pixel", "25 um"]].concat());
    insta::assert_snapshot!(said);
    write(Some(2835));
    refused(&["--force"], "it states pixels of 352.7 um, at which a program would print it");
    directory.plateau(["new", "other.toml", "--pixel", "2 um"]).ends(2, &["--micrograph"]);
    assert!(!directory.path("other.toml").exists());
}
