use super::*;

#[test]
fn a_number_tells_its_mark() {
    for (cells, mark) in [
        (&["1,5", "-0,25e-3", "7,5 N", ",5"][..], Some(Decimal::Comma)),
        (&["1.5", "-0.25e-3", "7.5 N", ".5"], Some(Decimal::Point)),
        (&["1.234,5", "1,2,3", "a, b", ",", "7", "12.03.2026", "a.5", ""], None),
    ] {
        cells.iter().for_each(|cell| assert_eq!(Decimal::of(cell), mark, "{cell}"));
    }
}

#[test]
fn cells_are_parted_by_the_strongest_separator() {
    let cells = |line: &str, terminated| {
        Separator::of(line).cells(line, terminated).map(str::to_owned).collect::<Vec<_>>().join("|")
    };
    assert_eq!(cells(" 1  2\u{a0}3 ", false), "1|2|3");
    assert_eq!(cells("1, 2 ,,4", false), "1|2||4");
    assert_eq!(cells("1;2,5; ", false), "1|2,5|");
    assert_eq!(cells("1;2,5; ", true), "1|2,5");
    assert_eq!(cells("\t1\t\t3", false), "|1||3");
    assert_eq!(cells("\"1.5\",\"2\"", false), "1.5|2");
    assert_eq!(cells("\"1,5\", \"2,5\",\"\"", false), "1,5|2,5|");
}

#[test]
fn quotation_marks_are_those_of_rfc_4180() {
    let texts = |line: &str| {
        let texts = Separator::Character(',').parts(line, false).map(unquoted).collect::<Vec<_>>();
        texts.into_iter().map(|text| text.map_or_else(|| "?".to_owned(), Cow::into_owned)).collect::<Vec<_>>()
    };
    assert_eq!(texts(r#"a "b",2"#), [r#"a "b""#, "2"]);
    assert_eq!(texts(r#"5",7"#), [r#"5""#, "7"]);
    assert_eq!(texts(r#""a, ""b"", c", "" ,"""","x"#), [r#"a, "b", c"#, "", "\"", "?"]);
    assert_eq!(texts(r#""a" b,1"#), ["?", "1"]);
}

#[test]
fn lines_end_as_on_any_system() {
    for text in ["1\n\n2\n", "1\r\n\r\n2\r\n", "1\r\r2\r", "1\r\r\n\r\r\n2\r\r\n"] {
        assert_eq!(lines(text).collect::<Vec<_>>(), [(1, "1"), (3, "2")], "{text:?}");
    }
}

#[test]
fn a_first_line_for_spreadsheets_is_no_line_of_the_table() {
    for (text, mark) in [("sep=;\r\n1;2", ';'), ("\"SEP=,\"\n1;2", ','), ("sep=\t\n1;2", '\t')] {
        assert_eq!((stated_separator(text), lines(text).collect::<Vec<_>>()), (Some(mark), vec![(2, "1;2")]));
    }
    for text in ["sep=\n1", "sep=5 um\n1", "separator=;\n1", "1\nsep=;", "é", ""] {
        assert_eq!(stated_separator(text), None, "{text}");
    }
}

#[test]
fn blocks_begin_below_blank_lines_and_with_headers() {
    let kind = |text: &str| match text.chars().next() {
        Some('#') => Kind::Comment,
        Some('h') => Kind::Header,
        _ => Kind::Row,
    };
    for (text, expected) in [
        ("h\n\n# a\n\n1\n2\n# b\n3\n\n# end\n\nh\n", vec![]),
        ("1\n\n2\n3\nh\nh\n4\n", vec![(3, "below a blank line"), (5, "with a header")]),
        ("1\n\n# a\n\nh\n2\n\n\n3", vec![(3, "below a blank line"), (9, "below a blank line")]),
        ("", vec![]),
    ] {
        let found: Vec<_> = starts(lines(text), kind).map(|start| (start.line, start.sign)).collect();
        assert_eq!(found, expected, "{text}");
    }
}
