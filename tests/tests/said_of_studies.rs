//! What is said where a study asks for what cannot be: numbers without rows of zeros, names with signs, and what to do next.

use plateau_tests::program::{Outcome, WorkingDirectory, scene};
use plateau_tests::studies::Study;

/// A study of an imported response.
fn lab() -> Study {
    Study::lab("central-composite").load("range = [\"5 N\", \"15 N\"]").fibres("range = [0.2, 0.4]")
}

/// A study of two loads with one response; the base scene is that of a quick run of two seconds.
fn loads(dataset: &str, question: &str) -> Study {
    let set = "set = [\"operation.duration = \\\"2 s\\\"\"]";
    let study = Study::new(&scene("quick.toml"), "full-factorial", set).response("y", dataset, question);
    study.load("levels = [\"5 N\", \"10 N\"]")
}

/// Asks for a study, of which nothing is left where it is refused.
fn ask(study: impl AsRef<[u8]>, command: &str) -> Outcome {
    let directory = WorkingDirectory::with("study.toml", study);
    let outcome = directory.plateau(["sweep", command, "study.toml"]);
    assert!(outcome.status == Some(0) || directory.names() == ["study.toml"], "{:?}", directory.names());
    outcome
}

/// What was said of several studies, each below the change that was made to it.
struct Said(String);

impl Said {
    fn add(&mut self, what: &str, outcome: &Outcome, status: i32) {
        assert_eq!(outcome.status, Some(status), "{what}: {outcome:?}");
        self.0 += &format!("# {what}\n{}", outcome.stderr.replace(&scene(""), ""));
    }

    /// What `sweep plan` and `sweep run` say alike.
    fn add_of_both(&mut self, what: &str, study: &str, status: i32) {
        let [planned, ran] = ["plan", "run"].map(|command| ask(study, command));
        assert_eq!((ran.status, &ran.stderr), (planned.status, &planned.stderr), "{what}");
        self.add(what, &planned, status);
    }
}

#[test]
fn what_to_do_without_results_depends_on_where_they_come_from() {
    let collected = ask(lab(), "collect").ends(0, &[]);
    assert!(collected.stdout.contains("plateau sweep import takes in their responses"), "{collected:?}");
}

#[test]
fn numbers_beyond_all_measure_are_told_as_such() {
    let directory = WorkingDirectory::new();
    let quick = scene("quick.toml");
    for set in ["mesh.inner_radius=1e300 m", "output.maps_at=[\"1e300 s\"]"] {
        let outcome = directory.plateau(["check", &quick, "--set", set]);
        assert!(outcome.stderr.contains("1e300") && !outcome.stderr.contains("000000000"), "{outcome:?}");
    }
}

#[test]
fn what_a_study_can_hardly_mean_is_told_at_its_place() {
    let mut said = Said(String::new());
    for (from, to) in [
        ("[[factor]]", "[[factors]]"),
        ("\"load\"", "\" load\""),
        ("\"y\"", "\"y\u{feff}\""),
        ("range = [0.2, 0.4]", "levels = [0.2, \"wet \"]"),
    ] {
        said.add(&to.escape_default().to_string(), &ask(lab().text().replace(from, to), "plan"), 2);
    }
    let area = || loads("/series/contact_area", "at = \"end\"").text();
    for (found, given) in [("\"10 N\"]", "10]"), ("\"10 N\"]", "\"10 Nm\"]"), ("quick.toml", "quik.toml")] {
        said.add_of_both(given, &area().replace(found, given), 2);
    }
    // A series that no run records, before the first run.
    for (dataset, question) in [
        ("/series/disc_sq", "at = \"end\""),
        ("/series/friction_coefficient", "mean = \"last tenth\""),
        ("/event/worn", "event = \"last\""),
    ] {
        said.add_of_both(dataset, &loads(dataset, question).text(), 2);
    }
    // Where some runs have it the others give no value.
    let switched =
        loads("/series/disc_sq", "at = \"end\"").factor("told", "output.roughness", "levels = [false, true]");
    said.add("/series/disc_sq in some runs", &ask(switched, "run"), 0);
    let late = || loads("/series/contact_area", "at = \"3 s\"");
    said.add_of_both("at = \"3 s\"", &late().text(), 0);
    let longer = late().factor("time", "operation.duration", "levels = [\"2 s\", \"4 s\"]").text();
    said.add("at = \"3 s\" of some runs", &ask(longer.replace("\nset = ", "\n# "), "plan"), 0);
    let repeated = area() + "[replicates]\nseeds = [1, 2, 3]\n";
    said.add("seeds of no key", &ask(repeated, "plan"), 2);
    insta::assert_snapshot!(said.0);
}

#[test]
fn a_plan_of_very_many_runs_says_that_it_has_not_looked_at_all() {
    let study = |points: usize| {
        let study = Study::new(&scene("quick.toml"), "sobol", &format!("points = {points}"));
        ask(study.load("range = [\"5 N\", \"15 N\"]").fibres("range = [0.2, 0.4]"), "plan")
    };
    study(20_001).ends(0, &["20 001 runs are more than 20 000, so that their scenes are not looked at here"]);
    assert!(!study(8).stderr.contains("not looked at"));
}

#[test]
fn measurements_are_repeated_without_a_seed() {
    let planned = ask(lab().text() + "[replicates]\nseeds = [1, 2, 3]\n", "plan").ends(0, &[]);
    assert!(planned.stdout.contains("9 points × 3 replicates = 27"), "{planned:?}");
}
