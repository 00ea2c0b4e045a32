use super::*;

#[test]
fn what_moves_the_cursor_or_turns_letters_is_written_out() {
    let text = "a\u{1b}[2Jb\r\u{9b}31m\u{202e}c\u{7f}\nd\té µ";
    assert_eq!(shown(text), "a\\u{1b}[2Jb\\r\\u{9b}31m\\u{202e}c\\u{7f}\nd\té µ");
    assert_eq!(shown_on_one_line("d\ne\tf"), "d\\ne\\tf");
    assert!(matches!(shown("plain, ö, 中\n"), Cow::Borrowed(_)));
    assert_eq!(odd_character("a\nb").as_deref(), Some("a line break"));
    assert_eq!(odd_character("a\u{1b}").as_deref(), Some("the control character U+001B"));
    assert_eq!(odd_character("µm, \"a\" <b>"), None);
}

#[test]
fn long_names_are_told_by_their_beginning() {
    assert_eq!(too_long(&"ä".repeat(200)), None);
    let said = too_long(&"ä".repeat(201)).unwrap();
    assert_eq!(said, format!("\"{}…\" has 201 letters, expected at most 200; shorten it", "ä".repeat(60)));
    assert_eq!((short("a"), shown_title(&"x".repeat(300)).chars().count()), (Cow::Borrowed("a"), 201));
    assert_eq!(shown_message(&"x".repeat(10_000_000)).chars().count(), 8001);
}

#[test]
fn only_what_a_spreadsheet_would_compute_is_marked() {
    for formula in [
        "=1+1",
        "+1+1",
        "-2+3+cmd|' /C calc'!A0",
        "@SUM(A1)",
        "-x",
        "=",
        "-1 a(b)",
        "\t=1",
        "-inf(1)",
        "-inf",
        "+nan",
        "-2 -3",
        "-2 *3",
        "-2 3",
        "-",
    ] {
        assert_eq!(cell(formula), format!("'{formula}"));
    }
    for text in ["=1+1", "'=1+1", "''-x", "'a", "'", "-5 mm", "'-5 mm", ""] {
        assert_eq!(text_of_cell(&cell(text)), text);
    }
    for plain in ["-1.5", "+3", "-1e-300", "-20 degC", "-5 %", "-5 °C", "-5 1/K", "a=b", "", "1-2"] {
        assert_eq!(cell(plain), plain);
    }
}

#[test]
fn as_many_are_told_as_have_room() {
    assert_eq!(list([""; 0], ", "), "");
    assert_eq!(list(["a", "b"], ", "), "a, b");
    assert_eq!(list(1..=20, " "), "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20");
    assert_eq!(list(1..=23, ","), "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,and 3 more");
    let long = "ä".repeat(1500);
    assert_eq!(list([&long, &long, &long], "; "), format!("{long}; {long}; and 1 more"));
    assert_eq!(list(["x".repeat(10_000_000)], ", "), format!("{}…", "x".repeat(4000)));
}

#[test]
fn problems_that_were_not_looked_for_are_not_counted() {
    assert_eq!(problems(["one", "two"]), "one\ntwo");
    assert!(problems(0..99).ends_with("\n19\nand 79 more"));
    assert!(problems(0..100).ends_with("\n19\nand 80 more, at least"));
}
