use super::*;

#[test]
fn the_key_that_was_meant_is_named() {
    let unknown = "unknown field `factors`, expected one of `version`, `factor`, `response`";
    let said = |message: &str| message.replace("field", "key");
    assert_eq!(with_advice(unknown), format!("{}; did you mean \"factor\"?", said(unknown)));
    let two = "unknown field `seed`, expected `keys` or `seeds`";
    assert_eq!(with_advice(two), format!("{}; did you mean \"seeds\"?", said(two)));
    for other in ["unknown field `foo`, expected `keys` or `seeds`", "missing field `design`"] {
        assert_eq!(with_advice(other), said(other));
    }
    let one = "invalid type: map, expected a sequence";
    assert_eq!(with_advice(one), "this is one table, expected a list of them: write [[factor]], [[response]]");
    let text = "invalid type: string \"5 N\", expected a sequence";
    let told = "invalid type: string \"5 N\", expected a list in brackets, such as [\"5 N\", \"20 N\"]";
    assert_eq!(with_advice(text), told);
    let number = "invalid type: floating point `0.5`, expected an array of length 2";
    let told = "invalid type: floating point `0.5`, expected two values in brackets, such as [\"5 N\", \"20 N\"]";
    assert_eq!(with_advice(number), told);
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
