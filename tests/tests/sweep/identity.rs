//! What results are the results of: the scene, what was read of its files, and the generation of the program's numbers.

use std::fs;

use plateau_io::generation;
use plateau_io::input::sha256_of;
use plateau_tests::program::{DISC, Outcome, WorkingDirectory, ended, quick_scene_with, start, wait_until};
use plateau_tests::run_file::{RunFile, differences};
use plateau_tests::studies::Study;
use serde_json::Value;

use super::{counts, directory, records, study, sweep};

/// The lines of `results.csv` that are there, by the number of the run.
fn table(directory: &WorkingDirectory) -> Vec<String> {
    let text = directory.text("results/results.csv");
    text.lines().skip(1).map(str::to_owned).collect()
}

fn collect(directory: &WorkingDirectory, more: &[&str]) -> Outcome {
    directory.plateau(["sweep", "collect", "study.toml", "--json"].iter().chain(more))
}

#[test]
fn a_result_is_named_by_its_scene_and_the_generation_alone() {
    let directory = directory();
    directory.write("study.toml", study().replace("seeds = [7, 8, 9]", "seeds = [7]"));
    sweep(&directory, &[]);
    let shard = fs::read_dir(directory.path("results/journal")).unwrap().next().unwrap().unwrap().path();
    let text = fs::read_to_string(shard).unwrap();
    let record: Value = serde_json::from_str(text.lines().next().unwrap().get(9..).unwrap()).unwrap();
    assert_eq!(record["of"]["generation"].as_u64(), Some(generation::current().into()));
    assert_eq!(record["of"]["files"], serde_json::json!({}));
    let scene = record["of"]["scene"].as_str().unwrap();
    let name = sha256_of(format!("{}\n{scene}\n", generation::current()).as_bytes());
    assert_eq!(record["identity"].as_str(), Some(name.as_str()));
}

#[test]
fn a_table_is_not_replaced_by_one_with_fewer_finished_runs() {
    let directory = WorkingDirectory::with("quick.toml", quick_scene_with(&[]));
    let base = plateau_tests::program::scene("quick.toml");
    directory.write("study.toml", study().replace(&base, "quick.toml"));
    sweep(&directory, &["--jobs", "2"]);
    assert_eq!(collect(&directory, &[]).status, Some(0));
    let files = || ["results/results.csv", "results/results.h5"].map(|file| fs::read(directory.path(file)).unwrap());
    let before = files();
    // Another scene: nothing of what is there is its result.
    directory
        .write("quick.toml", quick_scene_with(&[("foundation_height = \"50 um\"", "foundation_height = \"40 um\"")]));
    let refused = collect(&directory, &[]);
    let left_out = "27 results are left out: of scenes that no run";
    refused.ends(2, &["has 27 runs that finished, of which there are 0 now", left_out, "--force replaces"]);
    assert!(files() == before);
    // Why is said without a word of what is quiet, too; elsewhere there is nothing to lose.
    assert!(collect(&directory, &["-q"]).stderr.contains("27 results are left out"));
    assert_eq!(collect(&directory, &["-o", "elsewhere"]).json()["missing"].as_u64(), Some(27));
    assert_eq!(collect(&directory, &["--force"]).json()["finished"].as_u64(), Some(0));
    assert!(files() != before);
    // As many, or more, are no loss.
    directory.write("quick.toml", quick_scene_with(&[]));
    assert_eq!(collect(&directory, &[]).json()["finished"].as_u64(), Some(27));
    assert_eq!(collect(&directory, &[]).status, Some(0));
}

#[test]
fn runs_that_did_not_keep_a_series_are_named_and_made_again_when_asked() {
    let directory = directory();
    let small = study().replace("seeds = [7, 8, 9]", "seeds = [7]");
    let (head, responses) = small.split_once("[[response]]").unwrap();
    let kept = head.replace("directory = \"results\"", "directory = \"results\"\nseries = [\"worn_pin\"]");
    directory.write("study.toml", &kept);
    sweep(&directory, &["--jobs", "2"]);
    assert_eq!(records(&directory).len(), 9);
    directory.write("study.toml", format!("{kept}[[response]]{responses}"));
    let said = "was not kept by 9 runs, so that responses to it have no value there";
    for command in [["collect", "study.toml"], ["run", "study.toml"]] {
        let again = "sweep run study.toml --retry` makes them again";
        let outcome = directory.plateau(["sweep"].into_iter().chain(command));
        outcome.ends(0, &[said, "/series/filled_fraction", "1, 2, 3, 4, 5, 6, 7, 8, 9", again]);
    }
    let again = directory.plateau(["sweep", "run", "study.toml", "--retry", "--json"]);
    assert_eq!(again.ends(0, &["are made again: 1, 2, 3"]).json()["finished"].as_u64(), Some(9));
    // What was kept before still is, beside what is new.
    let collected = directory.plateau(["sweep", "collect", "study.toml"]);
    assert!(collected.status == Some(0) && !collected.stderr.contains("not kept"), "{collected:?}");
    for line in table(&directory) {
        assert!(line.split(',').skip(6).take(3).all(|cell| cell.parse::<f64>().is_ok()), "{line}");
    }
    let file = directory.run_file("results/results.h5");
    assert!(file.floats("/worn_pin").iter().all(|value| value.is_finite()));
    assert_eq!(counts(&sweep(&directory, &["--retry"]), ["finished", "finished_before"]), [0, 9]);
}

/// Heights of a disc of 690 x 20 cells as an array of NumPy (format 1.0), m.
fn disc(scale: f64) -> Vec<u8> {
    let mut header = "{'descr': '<f8', 'fortran_order': False, 'shape': (690, 20), }".to_owned();
    while !(10 + header.len() + 1).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    let height = |cell: u32| scale * f64::from(cell * 7919 % 101) * 3e-8;
    bytes.extend((0..690 * 20).flat_map(|cell| height(cell).to_le_bytes()));
    bytes
}

#[test]
fn runs_count_as_what_they_read_when_a_surface_is_replaced_meanwhile() {
    let with = |scale: f64| {
        let directory = WorkingDirectory::with_scene(&[(DISC, "file = \"disc.npy\"")]);
        directory.write("disc.npy", disc(scale));
        let keys = "set = [\"output.sample_every = '0.5 s'\"]\norder = \"standard\"";
        let study = Study::new("scene.toml", "full-factorial", keys)
            .load("levels = [\"5 N\", \"6 N\", \"7 N\", \"8 N\", \"9 N\", \"10 N\"]")
            .response("area", "/series/contact_area_mean", "at = \"end\"");
        directory.write("study.toml", study);
        directory
    };
    let clean = [1.0, 2.0].map(|scale| {
        let directory = with(scale);
        sweep(&directory, &["--jobs", "2", "--keep-files"]);
        collect(&directory, &[]);
        directory
    });
    let directory = with(1.0);
    let child = start(directory.command(["sweep", "run", "study.toml", "--jobs", "1", "--keep-files"]));
    assert!(wait_until(|| records(&directory).len() > 1));
    directory.write("new.npy", disc(2.0));
    fs::rename(directory.path("new.npy"), directory.path("disc.npy")).unwrap();
    ended(child).ends(1, &["files that the runs read were changed meanwhile"]);
    // With either surface, what is there is what a study of that alone has.
    let mut there = [0, 0];
    for place in [1, 0] {
        directory.write("disc.npy", disc([1.0, 2.0][place]));
        let collected = collect(&directory, &["--force"]);
        there[place] = collected.json()["finished"].as_u64().unwrap();
        assert!(collected.stderr.contains("left out: the file of disc.surface had another content"), "{collected:?}");
        for (found, expected) in table(&directory).iter().zip(&table(&clean[place])) {
            assert!(found == expected || found.contains(",missing,"), "{found}, expected {expected}");
        }
    }
    assert!(there[0] > 1 && there[1] > 0 && there[0] + there[1] == 6, "{there:?}");
    directory.write("disc.npy", disc(2.0));
    sweep(&directory, &["--keep-files"]);
    collect(&directory, &[]);
    assert_eq!(table(&directory), table(&clean[1]));
    // Names of run files tell what is in them.
    for file in fs::read_dir(directory.path("results/runs")).unwrap().flatten() {
        let name = format!("results/runs/{}", file.file_name().display());
        let same = clean.iter().map(|clean| clean.path(&name)).find(|same| same.exists()).expect(&name);
        let [found, expected] = [file.path(), same].map(|path| RunFile::open(path).content());
        assert_eq!(differences(&found, &expected), [""; 0], "{name}");
    }
    assert!(fs::read_dir(directory.path("results/runs")).unwrap().count() > 6);
}
