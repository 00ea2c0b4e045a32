use super::*;

fn found(text: &str) -> Found {
    (without_numbers(text), text.to_owned())
}

#[test]
fn a_kind_is_said_once_with_its_runs() {
    let mut warnings = SceneWarnings::default();
    warnings.add(vec![found("disc.prepare: the patch is only 8.7 times its correlation length of 1.2 mm")]);
    warnings.add(Vec::new());
    warnings.add(vec![found("disc.prepare: the patch is only 9.1 times its correlation length of 950 um")]);
    let lines = warnings.lines("runs");
    assert_eq!(
        lines,
        [
            "disc.prepare: the patch is only 8.7 times its correlation length of 1.2 mm; this is the first of them, others differ in numbers \
              (so in 2 of 3 runs)"
        ]
    );
}

#[test]
fn numbers_of_several_runs_are_a_range() {
    let mut warnings = SceneWarnings::default();
    for percent in ["10.2", "9.7", "18.0", "11"] {
        warnings.add(vec![found(&format!("\"area\" has no value: rises by {percent} % in the last 15 s"))]);
    }
    let expected = "\"area\" has no value: rises by 9.7 … 18.0 % in the last 15 s (so in 4 of 4 runs)";
    assert_eq!(warnings.lines("runs"), [expected]);
    // What has a number in its name is no number.
    assert_eq!(with_numbers("pm10_2 at -3.5%, (7)", numbers_of("9 8")), "pm10_2 at 9%, (8)");
}

#[test]
fn of_many_kinds_some_are_said() {
    let mut warnings = SceneWarnings::default();
    warnings.add((b'a'..b'p').map(|letter| found(&String::from(letter as char))).collect());
    let lines = warnings.lines("the run");
    assert_eq!((lines.len(), lines[10].as_str()), (11, "5 more kinds of warnings of the run"));
    // Of one run nobody asks in how many.
    assert_eq!(lines[0], "a");
}
