use super::*;

#[test]
fn marks_alone_are_coloured() {
    let message = "study.toml:2:5: x^\n  2 | a = 2^\n    |     ^\nend";
    let red = Style::new().red().force_styling(true);
    let expected = "study.toml:2:5: x^\n  2 | a = 2^\n    |     \u{1b}[31m^\u{1b}[0m\nend";
    assert_eq!(with_coloured_marks(message, &red), expected);
    assert_eq!(with_coloured_marks(message, &Style::new().red().force_styling(false)), message);
}
