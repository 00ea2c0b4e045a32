use super::*;

#[test]
fn very_long_cells_are_aligned_too() {
    let rows = [vec!["x".repeat(70_000), "1".to_owned()], vec!["y".to_owned(), "2".to_owned()]];
    let text = columns("Sizes", &["name", "size"], &rows);
    assert!(text.lines().skip(1).all(|line| line.len() == 2 + 70_000 + 2 + 4), "{}", text.len());
    assert_eq!(table("Sizes", &[("x".repeat(70_000), "1".to_owned())]).len(), 6 + 2 + 70_000 + 4);
}

#[test]
fn columns_are_aligned() {
    let rows =
        [vec!["a".to_owned(), "1 µm".to_owned(), "9".to_owned()], vec!["long".into(), "20".into(), String::new()]];
    assert_eq!(
        columns("Sizes", &["name", "size", "n"], &rows),
        "Sizes\n  name  size  n\n  a     1 µm  9\n  long    20\n"
    );
}

#[test]
fn what_a_spreadsheet_would_compute_is_text() {
    assert_eq!(csv_table([["=1+1", "-1.5", "@a"]]), "'=1+1,-1.5,'@a\n");
}

#[test]
fn cells_are_quoted_where_they_need_it() {
    assert_eq!(csv_table([["plain", "a, \"b\""], ["", "two\nlines"]]), "plain,\"a, \"\"b\"\"\"\n,\"two\nlines\"\n");
}
