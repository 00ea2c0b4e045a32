//! What a run file holds is what was written, or `plateau verify` names what is not.

use std::fs;
use std::process::Stdio;

use plateau_tests::program::{WorkingDirectory, kill, scene, wait_until};
use plateau_tests::run_file::{RunFile, changed, differences};
use plateau_tests::scenes::Stream;

/// A short run with maps of two moments.
fn run(directory: &WorkingDirectory, file: &str) {
    let sets = ["--set", "operation.duration=20 s", "--set", "output.maps_at=[\"0 s\"]"];
    directory.plateau(["run", &scene("quick.toml"), "-o", file].iter().chain(&sets)).quiet_success();
}

fn verdict(directory: &WorkingDirectory, file: &str) -> (Option<i32>, serde_json::Value) {
    let outcome = directory.plateau(["verify", file, "--json"]);
    let document: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap_or_default();
    (outcome.status, document[0].clone())
}

#[test]
fn a_flipped_bit_is_found_or_changes_nothing() {
    let directory = WorkingDirectory::new();
    run(&directory, "run.h5");
    assert_eq!(verdict(&directory, "run.h5").1["verdict"], "intact");
    let whole = fs::read(directory.path("run.h5")).unwrap();
    let content = RunFile::open(directory.path("run.h5")).content();
    let mut random = Stream(12);
    let mut found = 0;
    for _ in 0..150 {
        let mut bytes = whole.clone();
        let (at, bit) = ((random.uniform() * bytes.len() as f64) as usize, (random.uniform() * 8.0) as u32);
        bytes[at] ^= 1 << bit;
        directory.write("flipped.h5", &bytes);
        let (status, document) = verdict(&directory, "flipped.h5");
        match status {
            Some(0) => {
                let flipped = RunFile::open(directory.path("flipped.h5"));
                assert_eq!(differences(&content, &flipped.content()), [""; 0], "bit {bit} of byte {at}");
            }
            // A file that is no longer known as a run file has nothing more to be named.
            Some(2) => found += 1,
            Some(1) => {
                assert_eq!(document["verdict"], "damaged", "bit {bit} of byte {at}");
                assert_ne!(document["damage"][0]["place"], "", "bit {bit} of byte {at}");
                found += 1;
            }
            other => panic!("{other:?} for bit {bit} of byte {at}"),
        }
    }
    // Nearly all of a file is data.
    assert!(found > 100, "{found}");
}

#[test]
fn what_is_damaged_is_named() {
    let directory = WorkingDirectory::new();
    run(&directory, "run.h5");
    let whole = fs::read(directory.path("run.h5")).unwrap();
    // The title is a text of which HDF5 keeps no checksum.
    let title = b"Quick look";
    let at = whole.windows(title.len()).position(|bytes| bytes == title).unwrap();
    let mut bytes = whole.clone();
    bytes[at] ^= 1;
    directory.write("title.h5", &bytes);
    let (status, document) = verdict(&directory, "title.h5");
    assert_eq!((status, &document["damage"][0]["place"]), (Some(1), &"attributes".into()), "{document}");

    // What HDF5 sees nothing wrong with: values written by somebody else.
    directory.write("value.h5", &whole);
    let file = changed(directory.path("value.h5"));
    file.dataset("series/pool").unwrap().write_slice(&[1.0], 3..4).unwrap();
    file.close().unwrap();
    let (status, document) = verdict(&directory, "value.h5");
    assert_eq!((status, &document["damage"][0]["place"]), (Some(1), &"/series/pool".into()), "{document}");

    // A link that leads elsewhere.
    directory.write("link.h5", &whole);
    let file = changed(directory.path("link.h5"));
    file.unlink("series/time").unwrap();
    file.link_soft("/radius", "series/time").unwrap();
    file.close().unwrap();
    let (status, document) = verdict(&directory, "link.h5");
    assert_eq!((status, &document["damage"][0]["place"]), (Some(1), &"attributes".into()), "{document}");
    let both = directory.plateau(["verify", "run.h5", "value.h5"]);
    assert_eq!(both.status, Some(1));
    assert!(both.stdout.contains("intact") && both.stdout.contains("/series/pool: it is not what was written"));
    assert_eq!(directory.plateau(["verify", &scene("quick.toml")]).status, Some(2));
}

#[test]
fn a_killed_run_is_repaired_and_a_healthy_file_is_left_alone() {
    let directory = WorkingDirectory::new();
    let long = ["--set", "operation.duration=1 h", "--set", "numerics.time_acceleration=1"];
    let arguments = ["run", &scene("quick.toml"), "-o", "run.h5"];
    let mut command = directory.command(arguments.iter().chain(&long));
    let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let file = directory.path("run.h5");
    assert!(wait_until(|| RunFile::follow(&file).is_ok_and(|run| run.shape("/time")[0] > 1)));
    let live = fs::read(&file).unwrap().len();
    let refused = directory.plateau(["repair", "run.h5"]);
    assert_eq!(refused.status, Some(2));
    assert!(refused.stderr.contains(&format!("being written by process {}", child.id())), "{}", refused.stderr);
    for more in ["--force", "--resume"] {
        let refused = directory.plateau(arguments.iter().chain(&[more]));
        assert_eq!(refused.status, Some(2), "{more}: {refused:?}");
    }
    kill(child);
    assert_eq!(verdict(&directory, "run.h5").1["verdict"], "not-closed");
    let before = fs::read(&file).unwrap();
    assert!(before.len() >= live);
    let samples = RunFile::follow(&file).unwrap().floats("/time");

    let repaired = directory.plateau(["repair", "run.h5"]);
    assert_eq!(repaired.status, Some(0), "{repaired:?}");
    let run = RunFile::open(&file);
    assert_eq!((run.text("state").as_str(), run.floats("/time")), ("interrupted", samples));
    assert_eq!(verdict(&directory, "run.h5").1["verdict"], "intact");
    assert!(fs::read(directory.path("run.h5.before-repair")).unwrap() == before);

    let healthy = directory.content();
    assert!(directory.plateau(["repair", "run.h5"]).quiet_success().contains("healthy"));
    assert!(directory.content() == healthy);
}
