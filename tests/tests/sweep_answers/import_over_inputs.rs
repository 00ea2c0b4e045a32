//! `plateau sweep import` never writes over what a study is made of, nor over what a link leads to.

use std::fs;
use std::os::unix::fs::symlink;

use plateau_tests::program::WorkingDirectory;

use super::{ask, refused};

const POINTS: &str = "load\n1\n2\n3\n";

/// A study of a rig with a table of its points, whose results are in a folder.
fn rig(directory: &WorkingDirectory, file: &str, folder: &str) {
    directory.write(
        "study.toml",
        format!(
            "version = 1\ndesign = \"csv\"\nfile = \"{file}\"\ndirectory = \"{folder}\"\n[[factor]]\nname = \"load\"\n\
             [[response]]\nname = \"wear\"\nimported = true\n"
        ),
    );
    directory.write(file, POINTS);
    directory.write("measured.csv", "load,wear\n1,10\n2,20\n3,30\n");
}

#[test]
fn the_table_of_the_points_is_not_replaced() {
    let directory = WorkingDirectory::new();
    rig(&directory, "imported.csv", ".");
    let said = refused(&directory, "import", &["measured.csv"]);
    assert!(said.contains("is an input of the study") && said.contains("another directory"), "{said}");
    assert_eq!(fs::read_to_string(directory.path("imported.csv")).unwrap(), POINTS);

    // A link to it is no better.
    rig(&directory, "points.csv", "results");
    fs::create_dir(directory.path("results")).unwrap();
    symlink("../points.csv", directory.path("results/imported.csv")).unwrap();
    refused(&directory, "import", &["measured.csv"]);
    assert_eq!(fs::read_to_string(directory.path("points.csv")).unwrap(), POINTS);
}

#[test]
fn a_link_to_the_table_of_another_study_is_replaced_and_not_followed() {
    let directory = WorkingDirectory::new();
    rig(&directory, "points.csv", "other");
    ask(&directory, "import", &["measured.csv"]);
    let before = fs::read_to_string(directory.path("other/imported.csv")).unwrap();
    rig(&directory, "points.csv", "results");
    fs::create_dir(directory.path("results")).unwrap();
    symlink("../other/imported.csv", directory.path("results/imported.csv")).unwrap();
    directory.write("measured.csv", "load,wear\n1,11\n");
    ask(&directory, "import", &["measured.csv", "--force"]);
    assert_eq!(fs::read_to_string(directory.path("other/imported.csv")).unwrap(), before);
    assert!(!directory.path("results/imported.csv").is_symlink());
}
