use super::*;

#[test]
fn the_key_that_was_meant_is_named() {
    let messages = [
        "unknown field `factors`, expected one of `version`, `factor`, `response`",
        "unknown field `seed`, expected `keys` or `seeds`",
        "unknown field `foo`, expected `keys` or `seeds`",
        "missing field `design`",
        "invalid type: map, expected a sequence",
        "invalid type: string \"5 N\", expected a sequence",
        "invalid type: floating point `0.5`, expected an array of length 2",
    ];
    insta::assert_snapshot!(messages.map(with_advice).join("\n"));
}

#[test]
fn blanks_at_ends_and_marks_are_told() {
    assert_eq!(unseen("load on the pin"), None);
    for name in [" load", "load\u{a0}"] {
        assert!(unseen(name).unwrap().contains("a blank at an end"), "{name:?}");
    }
    let long = unseen(&format!("{} ", "x".repeat(70_000))).unwrap();
    assert!(long.contains("x…\" has a blank at an end") && long.len() < 200, "{long}");
    assert!(unseen("lo\u{feff}ad").unwrap().starts_with("\"lo\\u{feff}ad\" has the character U+FEFF"));
}
