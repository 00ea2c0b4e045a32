//! Every command of the user guide works as it stands.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::PathBuf;
use std::process::Command;

use plateau_tests::program::{WorkingDirectory, program, repository, run};
use plateau_tests::run_file::RunFile;

/// The blocks of a document that are in this language.
fn blocks(document: &str, language: &str) -> Vec<String> {
    let text = fs::read_to_string(repository().join("docs").join(document)).expect("a document");
    let fence = format!("\n```{language}\n");
    let blocks: Vec<_> =
        text.split(&fence).skip(1).map(|rest| rest.split("\n```").next().unwrap_or(rest).to_owned()).collect();
    assert!(!blocks.is_empty(), "{document} has no block of {language}");
    blocks
}

/// Runs the shell blocks of a document, one after the other, in a folder that looks like the repository, or where the one before
/// has gone; gives the folder, and what the commands said.
fn walk_and_listen(document: &str) -> (WorkingDirectory, String) {
    let (directory, mut said) = (WorkingDirectory::new(), String::new());
    let (mut place, left) = (directory.path("."), directory.path(".left"));
    symlink(repository().join("data"), directory.path("data")).unwrap();
    symlink(program(), directory.path("plateau")).unwrap();
    for block in blocks(document, "sh") {
        let mut shell = Command::new("sh");
        shell.current_dir(&place).args(["-e", "-c", &format!("{block}\npwd > '{}'", left.display())]);
        let outcome = run(shell);
        assert_eq!(outcome.status, Some(0), "{document}:\n{block}\n{}", outcome.stderr);
        assert!(!outcome.stderr.contains("warning"), "{document}:\n{block}\n{}", outcome.stderr);
        said.push_str(&outcome.stdout);
        said.push_str(&outcome.stderr);
        place = PathBuf::from(fs::read_to_string(&left).expect("a folder").trim_end());
    }
    (directory, said)
}

fn walk_through(document: &str) -> WorkingDirectory {
    walk_and_listen(document).0
}

/// Walks through a tutorial: its commands make these files, and say every line that it shows as what one sees. A line that
/// ends with "…" is the beginning of one. All files are in the folder `own`.
fn expect_tutorial(document: &str, files: &[&str]) -> WorkingDirectory {
    let (directory, said) = walk_and_listen(document);
    for file in files {
        assert!(directory.path("own").join(file).exists(), "{document}: {file}");
    }
    expect_nothing_beside_own(&directory);
    for shown in blocks(document, "console").iter().flat_map(|block| block.lines()) {
        let is_said = match shown.strip_suffix(" …") {
            Some(begin) => said.lines().any(|line| line.starts_with(begin)),
            None => said.lines().any(|line| line == shown),
        };
        assert!(is_said, "{document}: no command says\n{shown}\nbut\n{said}");
    }
    directory
}

/// The commands have left a clone as it was, but for the folder that git ignores.
fn expect_nothing_beside_own(directory: &WorkingDirectory) {
    let ignored = fs::read_to_string(repository().join(".gitignore")).expect("a list of what git ignores");
    assert!(ignored.lines().any(|line| line == "/own/"));
    let mut names = directory.names();
    names.retain(|name| name != ".left");
    assert_eq!(names, ["data", "own", "plateau"]);
}

#[test]
fn the_first_run_works_as_it_is_told() {
    let directory = walk_through("first-run.md");
    for file in ["first.h5", "heavier.h5", "mine.h5", "rough-disc.png", "my-disc.h5", "rig.h5"] {
        assert!(directory.path("own").join(file).exists(), "{file}");
    }
    expect_nothing_beside_own(&directory);
}

#[test]
fn the_tutorial_about_a_surface_leads_to_its_ring() {
    expect_tutorial("tutorial-surface.md", &["disc.png", "ring.png", "measured.h5", "finer.h5", "extended-3.h5"]);
}

#[test]
fn the_tutorial_about_a_drive_leads_to_its_answer() {
    expect_tutorial("tutorial-drive.md", &["city-events.csv", "drives/emission.png", "drives/temperature.png"]);
}

#[test]
fn the_tutorial_about_clusters_loses_nothing_that_is_killed() {
    let directory = expect_tutorial("tutorial-cluster.md", &["loads.sbatch", "loads/results.h5"]);
    let results = fs::read_to_string(directory.path("own/loads/results.csv")).expect("results");
    assert_eq!(results.lines().skip(1).filter(|line| line.contains(",finished,")).count(), 24);
}

#[test]
fn the_pages_about_results_work() {
    let expected = [
        ("figures.md", &["quick/topography.png", "quick/topography.pdf", "compared/heights.png"][..]),
        ("report.md", &["quick.html", "report.html"]),
        ("export.md", &["quick.csv", "quick-pin-0001.csv", "quick.npz", "quick-vtk/disc.pvd"]),
    ];
    for (document, files) in expected {
        let directory = walk_through(document);
        for file in files {
            assert!(directory.path(file).exists(), "{document}: {file} in {:?}", directory.names());
        }
    }
}

#[test]
fn every_recipe_works() {
    let directory = walk_through("recipes.md");
    let names = directory.names();
    for file in ["measured.png", "fibres.png", "fibres.h5", "disc-13.h5", "load-2.5.h5", "job.h5", "stopped.h5", "man"]
    {
        assert!(names.iter().any(|name| name == file), "{file} in {names:?}");
    }
    // Expected: model.md. Without formation no cell becomes a secondary plateau; without resin none is worn.
    let last = |file: &str, series: &str| {
        let values = RunFile::open(directory.path(file)).floats(&format!("series/{series}"));
        *values.last().expect("a sample")
    };
    assert_eq!(last("wear-only.h5", "disc_secondary"), 0.0);
    assert_eq!((last("plain.h5", "worn_resin"), last("plain.h5", "pin_none")), (0.0, 0.0));
    assert!(last("worn-disc.h5", "worn_disc") > 0.0);
    assert_eq!(RunFile::open(directory.path("stopped.h5")).text("state"), "interrupted");
}
