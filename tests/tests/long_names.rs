//! Names and tables that are longer than anybody needs: refused or cut, and never out of all proportion.

use std::time::{Duration, Instant};

use plateau_tests::program::{WorkingDirectory, quick_scene_with};
use plateau_tests::run_file::set_text;
use plateau_tests::studies::Study;

/// More than any of these calls takes; before, each took minutes or ended in a panic.
const PATIENCE: Duration = Duration::from_secs(20);

fn study(name: &str, level: &str, response: &str, title: &str) -> String {
    Study::lab("full-factorial")
        .factor(name, "plateaus.debris", &format!("levels = [\"local\", \"{level}\"]"))
        .imported(response)
        .text()
        .replacen("Lab", title, 1)
}

#[test]
fn long_names_and_titles_are_refused_where_they_are_given() {
    let directory = WorkingDirectory::new();
    let (fits, long) = ("n".repeat(200), "n".repeat(70_000));
    let cases = [
        (study(&long, "track", "y", "t"), "factor.name"),
        (study("f", &long, "y", "t"), "factor.levels"),
        (study("f", "track", &long, "t"), "response.name"),
        (study("f", "track", "y", &long), "title"),
    ];
    for (text, key) in cases {
        directory.write("study.toml", text);
        let said = format!("{key}: \"{}…\" has 70000 letters, expected at most 200; shorten it", &long[..60]);
        directory.plateau(["sweep", "plan", "study.toml"]).ends(2, &[&said]);
    }
    directory.write("study.toml", study(&fits, "track", &fits[1..], &fits));
    directory.plateau(["sweep", "plan", "study.toml"]).ends(0, &[]);
    directory.write("scene.toml", quick_scene_with(&[("Quick look", &long)]));
    directory.plateau(["check", "scene.toml"]).ends(2, &["title: ", "70000 letters"]);
}

#[test]
fn the_title_of_a_strangers_run_is_cut_where_it_is_shown() {
    let directory = WorkingDirectory::new();
    let scene = quick_scene_with(&[("duration = \"60 s\"", "duration = \"1 s\"")]);
    directory.write("scene.toml", scene);
    directory.plateau(["run", "scene.toml", "-o", "run.h5"]).quiet_success();
    set_text(directory.path("run.h5"), "title", &"T".repeat(60_000));
    for arguments in [&["summary", "run.h5"][..], &["surface", "run.h5"], &["watch", "run.h5", "--once"]] {
        let start = Instant::now();
        let outcome = directory.plateau(arguments).ends(0, &[]);
        assert!(start.elapsed() < PATIENCE, "{arguments:?}: {:?}", start.elapsed());
        assert!(outcome.stdout.len() < 20_000, "{arguments:?}: {}", outcome.stdout.len());
    }
}

#[test]
fn tables_of_many_columns_take_no_longer_than_to_read_them() {
    let directory = WorkingDirectory::new();
    let columns: String = (0..200_000).map(|column| format!(",c{column}")).collect();
    let cells = ",1".repeat(200_000);
    directory.write("wide.csv", format!("f,y{columns}\nlocal,1{cells}\n"));
    directory.write("twice.csv", format!("f,y{columns},c7\nlocal,1{cells},1\n"));
    for (study_file, table) in [("design.toml", "wide.csv"), ("twice.toml", "twice.csv")] {
        let design = study("f", "track", "y", "t").replace("full-factorial\"", &format!("csv\"\nfile = \"{table}\""));
        directory.write(study_file, design);
    }
    let start = Instant::now();
    for (arguments, said) in [
        (&["sweep", "plan", "twice.toml"][..], "column \"c7\" is there twice"),
        (&["sweep", "plan", "design.toml"], "column \"c0\" is not a factor of the study"),
    ] {
        let refused = directory.plateau(arguments).ends(2, &[said]);
        assert!(refused.stderr.len() < 1000, "{arguments:?}: {}", refused.stderr.len());
    }
    assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
}
