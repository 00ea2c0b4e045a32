//! The cases at the limits keep their bounds, and the document tells of all of them.

use std::process::Command;

#[test]
fn every_case_keeps_its_bounds_and_is_in_the_document() {
    let output = Command::new(env!("CARGO_BIN_EXE_extremes")).arg("--quick").output().expect("the program");
    let printed = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(output.status.success(), "{printed}");
    let document =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/stability.md")).expect("docs");
    // A case, aligned, is parted from its figures by two blanks; those of many steps have other names in a short run.
    let names = printed.lines().skip(2).filter_map(|line| line.trim().split_once("  ")).map(|(name, _)| name);
    let missing: Vec<&str> =
        names.filter(|name| !name.contains("million steps") && !document.contains(&format!("| {name} |"))).collect();
    assert_eq!(missing, [""; 0], "make the table again: see docs/stability.md");
    let local = printed.lines().filter(|line| line.contains(", local debris  ")).count();
    assert!(local > 40 && printed.lines().count() > 2 * local, "{printed}");
}

#[test]
fn cases_can_be_chosen_and_other_options_are_refused() {
    let none = Command::new(env!("CARGO_BIN_EXE_extremes")).args(["--only", "no such case"]).output().expect("it");
    assert!(none.status.success());
    assert!(String::from_utf8_lossy(&none.stdout).contains("0 passed, 0 failed"));
    assert!(!Command::new(env!("CARGO_BIN_EXE_extremes")).arg("--slow").output().expect("it").status.success());
}
