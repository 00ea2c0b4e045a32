//! Every command of the user guide works as it stands.

use std::fs;
use std::os::unix::fs::symlink;
use std::process::Command;

use plateau_tests::program::{WorkingDirectory, program, repository, run};
use plateau_tests::run_file::RunFile;

/// Commands that the guide already shows and the program does not have yet.
const COMING: &[&str] = &["plot", "report", "watch", "export"];

/// The blocks of a document that are in this language.
fn blocks(document: &str, language: &str) -> Vec<String> {
    let text = fs::read_to_string(repository().join("docs").join(document)).expect("a document");
    let fence = format!("\n```{language}\n");
    let blocks: Vec<_> =
        text.split(&fence).skip(1).map(|rest| rest.split("\n```").next().unwrap_or(rest).to_owned()).collect();
    assert!(!blocks.is_empty(), "{document} has no block of {language}");
    blocks
}

/// Names of the commands that the program's own help lists.
fn commands() -> Vec<String> {
    let help = WorkingDirectory::new().plateau(["--help"]).quiet_success();
    let (_, list) = help.split_once("Commands:\n").expect("a list of commands");
    let names = list.lines().take_while(|line| !line.is_empty()).filter_map(|line| line.split_whitespace().next());
    names.map(str::to_owned).collect()
}

/// The block without the lines whose command is still to come; any other unknown command stays, and will fail.
fn without_coming(block: &str, commands: &[String]) -> String {
    let coming = |line: &str| {
        let command = line.strip_prefix("./plateau ").and_then(|rest| rest.split_whitespace().next());
        command.is_some_and(|name| COMING.contains(&name) && !commands.iter().any(|known| known == name))
    };
    block.lines().filter(|line| !coming(line)).map(|line| format!("{line}\n")).collect()
}

/// Runs the shell blocks of a document, one after the other, in a folder that looks like the repository; gives it.
fn walk_through(document: &str) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    symlink(repository().join("data"), directory.path("data")).unwrap();
    symlink(program(), directory.path("plateau")).unwrap();
    let commands = commands();
    for block in blocks(document, "sh") {
        let mut shell = Command::new("sh");
        shell.current_dir(directory.path(".")).args(["-e", "-c", &without_coming(&block, &commands)]);
        let outcome = run(shell);
        assert_eq!(outcome.status, Some(0), "{document}:\n{block}\n{}", outcome.stderr);
        assert!(!outcome.stderr.contains("warning"), "{document}:\n{block}\n{}", outcome.stderr);
    }
    directory
}

#[test]
fn the_first_run_works_as_it_is_told() {
    let names = walk_through("first-run.md").names();
    for file in ["quick.h5", "heavier.h5", "mine.h5", "afm.png", "my-disc.h5"] {
        assert!(names.iter().any(|name| name == file), "{file} in {names:?}");
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

#[test]
fn a_command_that_is_not_there_is_found() {
    let known = ["run".to_owned()];
    assert_eq!(
        without_coming("./plateau run a\n./plateau plot b\n./plateau plod c\nx", &known),
        "./plateau run a\n./plateau plod c\nx\n"
    );
}
