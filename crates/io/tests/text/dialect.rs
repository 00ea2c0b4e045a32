//! How the numbers of a file are written: what parts them, their decimal mark, and words for points without a height.

use super::*;

/// The second cell of a column of two beside others, or why it is none.
fn cell(cell: &str, decimal: Decimal) -> Result<f64, String> {
    let table = told(&format!("1;1\n1;{cell}"), Some(decimal), None).map_err(|error| error.to_string())?;
    Ok(table.heights[3] / 1e-6)
}

#[test]
fn a_cell_is_a_number_or_missing() {
    let [point, comma] = [Decimal::Point, Decimal::Comma];
    for (text, decimal, expected) in [
        ("1.5", point, 1.5),
        ("-2e-3", point, -2e-3),
        ("+.5", point, 0.5),
        ("1E5", point, 1e5),
        ("-0", point, 0.0),
        ("1,5", comma, 1.5),
        ("-2,5e-3", comma, -2.5e-3),
        ("7", comma, 7.0),
    ] {
        assert!((cell(text, decimal).unwrap() - expected).abs() <= 1e-15 * expected.abs(), "{text}");
    }
    let words = ["", "NaN", "nan", "BAD", "bad", "***", "*", "--", "n/a", "No Data"];
    for text in words.into_iter().chain(["1.#QNAN", "-1.#IND00", "1.#SNAN", "-nan(ind)", "nan", "1,#QNAN"]) {
        // An empty cell at the end of every line would be no cell.
        assert!([point, comma].iter().all(|decimal| cell(text, *decimal).is_ok_and(f64::is_nan)), "{text}");
    }
    for text in ["inf", "-Infinity", "1e999", "1.#INF", "-1.#INF00"] {
        assert!(cell(text, point).is_err_and(|error| error.contains("is not finite")), "{text}");
    }
}

#[test]
fn what_is_wrong_with_a_cell_is_told() {
    let texts =
        ["-0,25", "1,5e-3", "1.5", "1.234.567", "-1,234.5", "1.234,5", "12,345,678", "1,2,3", "1,", ",5", "1.5.2"];
    let said = texts.into_iter().chain(["um", "0x10", "1 2", "1.#"]).map(|text| {
        let [point, comma] = [Decimal::Point, Decimal::Comma].map(|decimal| match cell(text, decimal) {
            Ok(number) => number.to_string(),
            Err(said) => said,
        });
        format!("{text}\n    with a point: {point}\n    with a comma: {comma}\n")
    });
    insta::assert_snapshot!(said.collect::<String>());
}

#[test]
fn what_can_be_read_in_one_way_is_told() {
    for (text, expected) in [
        ("1,5;2,5\n3;4", "1.5 2.5/3 4"),
        ("1;2\n3;4,25", "1 2/3 4.25"),
        ("0,123;0,456", "0.123 0.456"),
        ("1,234;12345", "1.234 12345"),
        ("1,234;1234,567", "1.234 1234.567"),
        ("1.234;2.345", "1.234 2.345"),
        ("1;2\n3;4", "1 2/3 4"),
        ("1,5\t***\t2", "1.5 - 2"),
        ("1,5 2,5\n3 4", "1.5 2.5/3 4"),
        ("0 1\n0,5 2", "0 1/0.5 2"),
        ("1,5 NaN", "1.5 -"),
        ("1,5, 2,5\n3, 4,25", "1.5 2.5/3 4.25"),
        ("  1,  2, 10\n 10,100,  3", "1 2 10/10 100 3"),
        ("1, 2,-3", "1 2 -3"),
        ("\"1,5\",\"2\"", "1.5 2"),
        ("\"1.5\",\"2\"", "1.5 2"),
        ("1.5,2.5", "1.5 2.5"),
        ("1, 2\n3, 4", "1 2/3 4"),
        ("1,2,3\n4,5,6", "1 2 3/4 5 6"),
        ("1,2\n3,", "1 2/3 -"),
        ("1,5\n2\n3,25", "1.5/2/3.25"),
        ("1 2 3", "1 2 3"),
        ("1,#QNAN 2,5", "- 2.5"),
        ("1.#QNAN;2,5", "- 2.5"),
    ] {
        assert_eq!(um(text).map(|table| shape(&table)).unwrap_or_else(|error| error.to_string()), expected, "{text:?}");
    }
}

#[test]
fn what_can_be_read_in_two_ways_is_refused_unless_told() {
    let twofold = [
        // A group of three digits behind a comma.
        &["7;1,234\n5;-12,345", "7\t1,234", "\"7\",\"1,234\""][..],
        // Commas between the numbers and within them.
        &["-0,0469,0,0192\n1,5,2,25", "1,5,-0,5", "0,5,1,25\n0,75,1,05"],
        &["1,5\n2,7", "1,5", "1,5\n12,345", "1,5, 2,5\n3,5, 4,5"],
        // Digits in groups.
        &["1;1.234,5\n1,5", "1\t1,234.5\n1,5", "5 1.234.567\n1,5"],
    ];
    let said = twofold.concat().into_iter().map(|text| format!("{text:?}\n    {}\n", error(text)));
    insta::assert_snapshot!(said.collect::<String>());
    for (text, numbers) in [("1,5,2,25", 4), ("01,02,03,04", 4), ("1,05,3", 3)] {
        assert_eq!(um(text).unwrap().columns, numbers, "{text:?}");
    }
    let shape_of = |text, decimal| shape(&told(text, Some(decimal), None).unwrap());
    assert_eq!(shape_of("1,5, 2,5\n3,5, 4,5", Decimal::Comma), "1.5 2.5/3.5 4.5");
    assert_eq!(shape_of("1,5\n2,7", Decimal::Comma), "1.5/2.7");
    assert_eq!(shape_of("1,5\n2,7", Decimal::Point), "1 5/2 7");
    assert_eq!(shape_of("7;1,234", Decimal::Comma), "7 1.234");
    // The names of columns say how many there are.
    assert_eq!(shape(&um("x y z\n0,0,1\n1,0,2\n0,1,3\n1,1,4").unwrap()), "1 2/3 4");
}
