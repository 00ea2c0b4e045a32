//! Every bad scene is refused, with a message that is fixed here.

use std::path::{Path, PathBuf};

use plateau_io::scene;
use proptest::prelude::*;

use crate::fixtures::place;

/// What a scene is refused with, every problem, of which a message tells the first twenty; the memory of this machine is left out.
fn message(path: &Path, sets: &[&str]) -> String {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let message = match scene::load(path, &sets) {
        Ok(scene) => panic!("{} was accepted:\n{}", path.display(), scene.resolved),
        Err(error) => error.problems().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"),
    };
    let message = message.replace(env!("CARGO_MANIFEST_DIR"), "[crate]");
    match (message.find("of memory and "), message.find(" are available")) {
        (Some(start), Some(end)) => format!("{}of memory and [memory]{}", &message[..start], &message[end..]),
        _ => message,
    }
}

#[test]
fn every_bad_scene_is_refused_with_its_message() {
    let mut scenes: Vec<PathBuf> =
        std::fs::read_dir("tests/scenes/bad").unwrap().map(|entry| entry.unwrap().path()).collect();
    scenes.sort();
    assert!(scenes.len() > 50);
    let messages: Vec<_> =
        scenes.iter().map(|path| format!("# {}\n{}\n", path.display(), message(path, &[]))).collect();
    insta::assert_snapshot!("bad_scenes", messages.join("\n"));
}

#[test]
fn every_bad_set_is_refused_with_its_message() {
    let scene = Path::new("tests/scenes/good/minimal.toml");
    let cases: &[&[&str]] = &[
        &["mesh.rows"],
        &["=3"],
        &["mesh..rows=3"],
        &[".mesh=3"],
        &["mesh=3"],
        &["mesh.rows.count=3"],
        &["mesh.row=3"],
        &["mesh.rows=0"],
        &["mesh.rows=eight"],
        &["mesh.rows="],
        &["mesh={ row = 3 }"],
        &["meshes.rows=3"],
        &["operation.normal_force=47"],
        &["operation.normal_force=47 mm"],
        &["operation.normal_force=47 N\nsteps = 3"],
        &["operation.steps=5", "operation.duration=1 s"],
        &["disc.surface.file=a.sdf", "disc.surface.flat=true"],
        &["extends=other.toml"],
        &["version=2"],
        &["plateaus.captured_fraction=1.5", "plateaus.pad_share=half"],
    ];
    let messages: Vec<_> = cases.iter().map(|sets| format!("# {sets:?}\n{}\n", message(scene, sets))).collect();
    insta::assert_snapshot!("bad_sets", messages.join("\n"));
}

/// The quick scene with these lines in place of its load, speed and duration, beside a table of its cycle.
fn with_cycle(folder: &Path, lines: &str, table: &str) -> String {
    let text = std::fs::read_to_string("../../data/scenes/quick.toml").unwrap();
    let constant = "normal_force = \"5 N\"\nrotational_speed = \"850 rpm\"\nduration = \"60 s\"\n";
    assert!(text.contains(constant), "{text}");
    std::fs::write(folder.join("stops.csv"), table).unwrap();
    std::fs::write(folder.join("scene.toml"), text.replace(constant, lines)).unwrap();
    message(&folder.join("scene.toml"), &[]).replace(&format!("{}/", folder.display()), "")
}

#[test]
fn every_bad_cycle_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let header = "time [s], normal_force [N], rotational_speed [rpm]\n";
    let rows = ["0,1,1\n2,1,1\n1,1,1\n", "0,1,1\n2,-1,1\n", "0,1,1\n2,nan,1\n", "0,1,1\n2,,1\n", "0,1,1\n2\n"];
    let rows = rows.into_iter().chain(["0,1,1\n2,4 N,1\n", "0,1,1\n2,1,1,1\n", "0,1,1\n", "0,1,0\n2,1,0\n"]);
    let tables = rows.map(|rows| format!("{header}{rows}"));
    let tables = tables.chain(
        [
            "",
            "time,normal_force [N]\n0,1\n",
            "time [h:mm:ss],normal_force [N]\n0:60:00,1\n",
            "time [s],normal_force\n0,1\n",
            "time [s],force [N]\n0,1\n",
            "time [s],normal_force [N],nominal_pressure [Pa]\n",
            "normal_force [N]\n1\n",
            "time [s],normal_force [N]\n0,1\n2,1\n",
            // As a spreadsheet of Germany or France writes 1200 rpm and 10.5 N.
            "time [s];normal_force [N];rotational_speed [rpm]\n0;10,5;1.200\n3;10,5;0\n",
            "time [s],normal_force [N]\n0,1\n\n2,1\n",
            "time [s],normal_force [N]\n0,1\ntime [s],normal_force [N]\n0,1\n",
            "time [s],normal_force [N]\n0,O.3\n",
            "time [s],normal_force [N]\n0,1e400\n",
        ]
        .map(str::to_owned),
    );
    let file = "[operation.cycle]\nfile = \"stops.csv\"\n";
    let mut found: Vec<String> =
        tables.map(|table| format!("# {table:?}\n{}\n", with_cycle(folder.path(), file, &table))).collect();
    let logger = "Uhrzeit;Tempo (km/h);Druck;Temp [degC]\n12:00:05,5;36;0,5;kalt\n12:01:00;18;10;warm\n";
    let columns = ["time = \"Zeit\"", "time = \"Uhrzeit\", road_speed = \"Tempo [m/s]\""];
    let columns = columns.into_iter().chain(["time = \"Uhrzeit\", brake_torque = \"Druck\""]);
    found.extend(columns.map(|columns| {
        let lines = format!("{file}columns = {{ {columns} }}\n");
        format!("# {columns}\n{}\n", with_cycle(folder.path(), &lines, logger))
    }));
    let first = "[operation.cycle]\npoints = [[\"0 s\", \"5 N\", \"850 rpm\"]";
    let scenes = [
        "[operation.cycle]\n".to_owned(),
        format!("{first}, [\"3 s\", \"5 Pa\", \"850 rpm\"]]\n"),
        format!("{first}, [\"3 s\", \"5 N\"]]\n"),
        format!("duration = \"20 s\"\n{first}, [\"3 s\", \"5 N\", \"50 rpm\"]]\n"),
    ];
    found.extend(scenes.map(|lines| format!("# {lines}{}\n", with_cycle(folder.path(), &lines, ""))));
    // Not together with an acceleration that the run chooses.
    let chosen = "numerics.time_acceleration={ tolerance = 0.01, max = 100 }";
    found.push(format!("# {chosen}\n{}\n", message(Path::new("../../data/scenes/stops.toml"), &[chosen])));
    insta::assert_snapshot!("bad_cycles", found.join("\n"));
}

#[test]
fn what_is_no_readable_file_is_refused() {
    assert!(message(Path::new("tests/scenes"), &[]).starts_with("tests/scenes: cannot read the scene: "));
    assert!(message(Path::new("tests/none.toml"), &[]).starts_with("tests/none.toml: cannot read the scene: "));
    let (_folder, large) = place("large.toml");
    std::fs::write(&large, "# a comment\n".repeat(100_000)).unwrap();
    assert!(message(&large, &[]).ends_with("it is larger than 1 MiB, expected a scene in TOML"));
}

#[test]
fn a_text_of_any_depth_gets_an_answer() {
    let folder = tempfile::tempdir().unwrap();
    for (open, close) in [("[", "]"), ("{a=", "}")] {
        let path = folder.path().join("deep.toml");
        std::fs::write(&path, format!("title = {}1{}", open.repeat(100_000), close.repeat(100_000))).unwrap();
        message(&path, &[]);
    }
    message(Path::new("tests/scenes/good/minimal.toml"), &[&format!("mesh.rows={}", "[".repeat(100_000))]);
}

proptest! {
    #[test]
    fn a_damaged_scene_gets_an_answer(at in any::<prop::sample::Index>(), length in 0_usize..20, text in "[ -~\\n]{0,4}") {
        let scene = std::fs::read_to_string("tests/scenes/good/full.toml").unwrap();
        let start = scene.floor_char_boundary(at.index(scene.len()));
        let end = scene.floor_char_boundary((start + length).min(scene.len()));
        let (_folder, path) = place("damaged.toml");
        std::fs::write(&path, format!("{}{text}{}", &scene[..start], &scene[end..])).unwrap();
        // Accepted or refused with a message; what is accepted is written as a scene that is accepted too.
        match scene::load(&path, &[]) {
            Err(error) => prop_assert!(error.to_string().contains("damaged.toml")),
            Ok(scene) => {
                std::fs::write(&path, &scene.resolved).unwrap();
                prop_assert_eq!(scene::load(&path, &[]).map(|again| again.resolved), Ok(scene.resolved));
            }
        }
    }
}
