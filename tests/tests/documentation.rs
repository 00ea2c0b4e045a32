//! The tables in docs are made from the same source as the program: the schema of scenes and the list of quantities.
//!
//! Where a table differs the test fails; `UPDATE_DOCS=1 cargo test --release -p plateau-tests --test documentation`
//! writes it anew.

use std::fmt::Write as _;
use std::path::Path;

use plateau_core::observe::{QUANTITIES, Quantity, ROUGHNESS_QUANTITIES};
use plateau_io::scene::schema::{self, Key, Kind, Need};

/// The text between the two marks of a table in a document is this, or is made so.
fn expect_table(document: &str, name: &str, table: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(document);
    let text = std::fs::read_to_string(&path).expect("a document");
    let (begin, end) = (format!("<!-- {name}: made by tests -->\n"), format!("<!-- end of {name} -->"));
    let (before, rest) = text.split_once(&begin).expect("the mark at the begin of the table");
    let (found, after) = rest.split_once(&end).expect("the mark at the end of the table");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, format!("{before}{begin}{table}{end}{after}")).expect("a document that can be written");
    } else {
        assert!(found == table, "{document}: the table of {name} is out of date; UPDATE_DOCS=1 writes it anew");
    }
}

fn kind(key: &Key) -> String {
    match key.kind {
        Kind::Quantity { unit, .. } => format!("quantity, such as `\"1 {unit}\"`"),
        Kind::Lengths { single, count, unit, .. } => {
            let list =
                format!("list of {count} quantities, such as `[{}]`", vec![format!("\"1 {unit}\""); count].join(", "));
            if single { format!("quantity, such as `\"1 {unit}\"`, or {list}") } else { list }
        }
        Kind::LengthUnit => "unit of length, such as `\"um\"`, or quantity".into(),
        Kind::Number(_) => "number".into(),
        Kind::NumberOr(_, word) => format!("number, or `\"{word}\"`"),
        Kind::Integer(least) => format!("integer, at least {least}"),
        Kind::Bool => "`true`, `false`".into(),
        Kind::True => "`true`".into(),
        Kind::Choice(words) => words.iter().map(|word| format!("`\"{word}\"`")).collect::<Vec<_>>().join(", "),
        Kind::CountOr(word) => format!("integer, at least 1, or `\"{word}\"`"),
        Kind::Text => "text".into(),
        Kind::InputFile => "path".into(),
        Kind::Times => "list of times, such as `[\"0 s\", \"10 s\"]`".into(),
        Kind::Maps => "list of names of maps".into(),
    }
}

fn need(key: &Key) -> String {
    match key.need {
        Need::Required => "required".into(),
        Need::OneOf => "one of several".into(),
        Need::Default(value) => format!("`{value}`"),
        Need::SameAs(table) => format!("as in `[{table}]`"),
        Need::Computed(what) => what.into(),
        Need::Optional => "–".into(),
    }
}

#[test]
fn every_key_of_a_scene_is_documented() {
    let mut table = String::from("| key | value | default | meaning |\n|---|---|---|---|\n");
    for key in schema::keys() {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "| `{}` | {} | {} | {} |", key.path(), kind(key), need(key), key.meaning);
    }
    expect_table("scenes.md", "keys", &table);
}

fn series(quantities: &[Quantity]) -> String {
    let mut table = String::from("| series | unit | meaning |\n|---|---|---|\n");
    for quantity in quantities {
        let _ = writeln!(table, "| `{}` | {} | {} |", quantity.name, quantity.unit, quantity.long_name);
    }
    table
}

#[test]
fn every_series_is_documented() {
    expect_table("run-file.md", "series", &series(QUANTITIES));
    expect_table("run-file.md", "roughness series", &series(ROUGHNESS_QUANTITIES));
}
