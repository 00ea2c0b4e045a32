//! The tables in docs are made from the same source as the program: the schema of scenes and the list of quantities.
//!
//! Where a table differs the test fails; `UPDATE_DOCS=1 cargo test --release -p plateau-tests --test end_to_end documentation`
//! writes it anew.

mod scene_schema;
mod units;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use plateau_core::observe::event::EVENT_QUANTITIES;
use plateau_core::observe::extra::OF_BRAKES;
use plateau_core::observe::{EXTRAS, Map, QUANTITIES, Quantity, TOTALS, quantities};
use plateau_io::scene::schema::{self, Key, Kind, Need, Range};

use scene_schema::{example_of, table_meaning};

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

/// The texts between back ticks.
fn code(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

#[test]
fn the_rules_of_the_model_are_where_the_document_says() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let read = |path: &str| std::fs::read_to_string(repository.join(path)).unwrap_or_else(|_| panic!("{path}"));
    let document = read("docs/model.md");
    let steps = read("crates/core/src/model/step.rs");
    let mut rules = 0;
    for line in document.lines().filter_map(|line| line.strip_prefix("`step.rs`: ")) {
        let (functions, _) = line.split_once(". ").unwrap_or((line, ""));
        for function in code(functions) {
            assert!(steps.contains(&format!("pub fn {function}(")), "step.rs has no function {function}");
            rules += 1;
        }
    }
    assert!(rules >= 8, "{rules} functions are named");
}

#[test]
fn the_source_files_that_documents_name_exist() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let places = [
        "",
        "tests/tests/",
        "crates/",
        "crates/core/src/",
        "crates/core/src/engine/",
        "crates/core/src/engine/kernel/",
        "crates/core/tests/",
        "crates/core/src/model/",
        "crates/cli/src/",
        "crates/io/src/scene/",
        "crates/io/src/surface/",
    ];
    let evidence = ["accuracy", "performance", "reliability", "stability"].map(|name| format!("evidence/{name}.md"));
    for document in ["model.md", "developing.md"].map(String::from).into_iter().chain(evidence) {
        let text = std::fs::read_to_string(repository.join("docs").join(&document)).expect("a document");
        let files: Vec<&str> = code(&text).filter(|code| code.ends_with(".rs") && !code.contains(' ')).collect();
        for file in files {
            let is_there = places.iter().any(|place| repository.join(place).join(file).is_file());
            assert!(is_there, "docs/{document}: there is no {file}");
        }
    }
}

#[test]
fn the_parts_of_the_engine_that_the_table_of_a_step_names_exist() {
    let core = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/core/src");
    let text = std::fs::read_to_string(core.join("lib.rs")).expect("the source");
    let rows = text.lines().filter_map(|line| line.strip_prefix("//! | ")?.strip_suffix(" |")?.rsplit(" | ").next());
    // Cells with links are those of the plain model, which rustdoc looks at.
    let names: Vec<&str> = rows.filter(|cell| !cell.contains("](")).flat_map(code).collect();
    assert!(names.contains(&"kernel::deposit"), "{names:?}");
    for name in names {
        let modules: Vec<&str> = name.trim_start_matches("engine::").split("::").collect();
        let (modules, item) = modules
            .split_at(modules.iter().position(|part| part.starts_with(char::is_uppercase)).unwrap_or(modules.len()));
        let source = std::fs::read_to_string(core.join("engine").join(modules.join("/")).with_extension("rs"));
        let source = source.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(item.iter().all(|part| source.contains(&format!(" {part}"))), "{name}");
    }
}

fn kind(key: &Key) -> String {
    let value = plain(key);
    if key.may_be_none() { format!("{value} or `\"none\"`") } else { value }
}

/// Values of a key: of quantities and rows an example.
fn plain(key: &Key) -> String {
    let example = || format!("`{}`", example_of(key).expect("an example"));
    match key.kind {
        Kind::Quantity { .. } | Kind::Times | Kind::Rows | Kind::Factor => example(),
        Kind::Lengths { single: true, .. } => format!("{} or 2 of them", example()),
        Kind::Lengths { .. } => example(),
        Kind::LengthUnit => format!("{} or a length", example()),
        Kind::Number(range) => format!("number{}", limits(range)),
        Kind::NumberOr(range, word) => format!("number{}, or `\"{word}\"`", limits(range)),
        Kind::Integer(least) => format!("integer, at least {least}"),
        Kind::Bool => "`true`, `false`".into(),
        Kind::True => "`true`".into(),
        Kind::Choice(words) => words.iter().map(|word| format!("`\"{word}\"`")).collect::<Vec<_>>().join(", "),
        Kind::CountOr(word) => format!("integer, at least 1, or `\"{word}\"`"),
        Kind::Text => "text".into(),
        Kind::InputFile => "path".into(),
        Kind::Maps => format!("list of {}", Map::CHOICES.map(|map| format!("`\"{}\"`", map.name())).join(", ")),
    }
}

fn limits(range: Range) -> String {
    match range {
        Range::ANY => String::new(),
        Range::FRACTION => ", 0 to 1".into(),
        _ => format!(", {range}"),
    }
}

/// Values of a key, and what holds without it.
fn value(key: &Key) -> String {
    match (key.need, absent(key)) {
        // The default is an example, too.
        (Need::Default(_), Some(default)) if matches!(key.kind, Kind::Quantity { .. } | Kind::Times) => default,
        (_, Some(absent)) => format!("{}; {absent}", kind(key)),
        (_, None) => kind(key),
    }
}

/// What holds without a key, unless something is then left out.
fn absent(key: &Key) -> Option<String> {
    let told = match key.need {
        Need::Required => "required".into(),
        Need::OneOf => {
            let group = key.group().expect("a group of the key");
            let names = group.members.iter().map(|(name, _)| *name).filter(|name| *name != key.name);
            let mut others: Vec<_> = names.map(|name| format!("`{name}`")).collect();
            others.extend(group.unless.map(|table| format!("`[{table}]`")));
            let begin = if group.required { "this or " } else { "not beside " };
            format!("{begin}{}", others.join(" or "))
        }
        Need::Default(value) => format!("default `{value}`"),
        Need::SameAs(table) => format!("default as in `[{table}]`"),
        Need::Computed(what) => format!("default {what}"),
        Need::RequiredUnless(choose, default) => {
            let (_, key) = choose.key.rsplit_once('.').expect("a key of a table");
            format!("required, default `{default}` with `{key} = \"{}\"`", choose.value)
        }
        Need::OfWay(unless) => {
            let but = unless.map(|choose| {
                let (_, key) = choose.key.rsplit_once('.').expect("a key of a table");
                format!(", but for `{key} = \"{}\"`", choose.value)
            });
            format!("[required](#mesh){}", but.unwrap_or_default())
        }
        Need::Optional => return None,
    };
    Some(told)
}

/// Tables that have the same keys, but for those that the last alone has.
const ALIKE: &[&[&str]] = &[
    &["materials.disc_primary", "materials.disc_secondary"],
    &["materials.pin_primary", "materials.pin_secondary"],
    &["disc.surface", "pin.surface"],
    &["disc.prepare", "pin.prepare"],
];

fn capitalised(text: &str) -> String {
    let first = text.chars().next().expect("a text").to_uppercase();
    first.chain(text.chars().skip(1)).collect()
}

fn keys_of(section: &str) -> Vec<&'static Key> {
    schema::keys().iter().filter(|key| key.section == section).collect()
}

/// Heading, purpose and keys of tables that have the same keys.
fn section(tables: &[&str]) -> String {
    let (first, last) = (tables[0], tables[tables.len() - 1]);
    let names: Vec<_> = tables.iter().map(|table| format!("`[{table}]`")).collect();
    let mut text = if first.is_empty() {
        "### At the top, before the first table\n".to_owned()
    } else {
        let purpose = |table: &str| table_meaning(table).expect("what the table is for");
        let purposes: Vec<_> = match tables {
            [table] => vec![format!("{}.\n", capitalised(purpose(table)))],
            _ => tables.iter().zip(&names).map(|(table, name)| format!("- {name}: {}\n", purpose(table))).collect(),
        };
        format!("### {}\n\n{}", names.join(", "), purposes.concat())
    };
    text.push_str("\n| key | value | meaning |\n|---|---|---|\n");
    let shared = keys_of(first);
    for (at, key) in keys_of(last).into_iter().enumerate() {
        let (like, only) = match shared.get(at) {
            Some(like) => (*like, String::new()),
            None => (key, format!("only in `[{last}]`: ")),
        };
        for table in tables.iter().filter(|_| at < shared.len()) {
            let other = keys_of(table)[at];
            assert_eq!((other.name, other.kind, other.meaning), (like.name, like.kind, like.meaning), "{table}");
        }
        // Writing to a String cannot fail.
        let meaning = format!("{only}{}", like.meaning).replace('|', "\\|");
        let _ = writeln!(text, "| `{}` | {} | {meaning} |", like.name, value(like));
    }
    for table in tables {
        if let Some(Need::SameAs(like)) = keys_of(table).first().map(|key| key.need) {
            let _ = writeln!(text, "\nWhat `[{table}]` does not give is as in `[{like}]`.");
        }
    }
    text.push('\n');
    text
}

#[test]
fn every_key_of_a_scene_is_documented() {
    let mut sections: Vec<&str> = schema::keys().iter().map(|key| key.section).collect();
    sections.dedup();
    let mut text = String::new();
    for name in sections {
        match ALIKE.iter().find(|alike| alike.contains(&name)) {
            Some(alike) if alike[0] == name => text.push_str(&section(alike)),
            Some(_) => {}
            None => text.push_str(&section(&[name])),
        }
    }
    expect_table("scenes.md", "keys", &text);
}

fn series(quantities: &[Quantity]) -> String {
    let mut table = String::from("| series | unit | meaning |\n|---|---|---|\n");
    for quantity in quantities {
        let _ = writeln!(table, "| `{}` | {} | {} |", quantity.name, quantity.unit, quantity.long_name);
    }
    table
}

#[test]
fn what_is_reported_of_events_is_documented() {
    let mut table = String::from("| dataset | unit | meaning |\n|---|---|---|\n");
    for quantity in EVENT_QUANTITIES {
        let _ = writeln!(table, "| `event/{}` | {} | {} |", quantity.name, quantity.unit, quantity.long_name);
    }
    expect_table("run-file.md", "events", &table);
}

#[test]
fn every_series_is_documented() {
    expect_table("run-file.md", "series", &series(QUANTITIES));
    let of_brakes: Vec<_> = OF_BRAKES.iter().flat_map(|extra| extra.quantities).copied().collect();
    expect_table("run-file.md", "brake series", &series(&of_brakes));
    for extra in EXTRAS.iter().filter(|extra| !OF_BRAKES.contains(extra)) {
        expect_table("run-file.md", &format!("{} series", extra.name.replace('_', " ")), &series(extra.quantities));
    }
}

#[test]
fn amounts_that_a_reader_could_take_for_a_brake_are_said_to_be_of_the_pin() {
    let series = quantities(EXTRAS).map(|quantity| (quantity.name, quantity.unit, quantity.long_name));
    let of_events = EVENT_QUANTITIES.iter().map(|quantity| (quantity.name, quantity.unit, quantity.long_name));
    let mut count = 0;
    for (name, unit, long_name) in series.chain(of_events) {
        let is_amount = ["kg", "J", "N"].contains(&unit)
            || ["worn", "emitted", "particle_number", "lost"].iter().any(|part| name.contains(part));
        if is_amount {
            let is_said = ["simulated pin", "whole brake"].iter().any(|whose| long_name.contains(whose));
            assert!(is_said, "{name}: {long_name}");
            count += 1;
        }
    }
    assert!(count >= 18, "{count} amounts");
}

#[test]
fn python_knows_the_same_totals() {
    let text = include_str!("../../python/plateau/run_accessor.py");
    let (_, list) = text.split_once("TOTALS = frozenset(").expect("the totals in Python");
    let (list, _) = list.split_once(".split()").expect("the end of their list");
    let of_python: std::collections::BTreeSet<_> =
        list.split(['"', ' ', '\n']).filter(|name| !name.is_empty()).collect();
    assert_eq!(of_python, TOTALS.iter().copied().collect());
    for total in TOTALS {
        assert!(quantities(EXTRAS).any(|quantity| quantity.name == *total), "{total} is no series");
    }
}

/// Markdown files of the repository, by their path from its root.
fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folders = ["docs", "docs/evidence"].map(|folder| std::fs::read_dir(root.join(folder)).expect(folder));
    let paths = folders.into_iter().flatten().map(|entry| entry.expect("an entry").path());
    let documents = paths.filter(|path| path.extension().is_some_and(|end| end == "md"));
    documents.chain([root.join("README.md")]).collect()
}

/// The name by which a link finds a heading: as GitHub makes it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase();
    let kept = kept.chars().filter(|letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_'));
    kept.map(|letter| if letter == ' ' { '-' } else { letter }).collect()
}

#[test]
fn every_link_between_documents_leads_somewhere() {
    let mut count = 0;
    for path in documents() {
        let text = std::fs::read_to_string(&path).expect("a document");
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if link.contains("://") {
                continue;
            }
            let (file, heading) = link.split_once('#').map_or((link, None), |(file, heading)| (file, Some(heading)));
            let target = if file.is_empty() { path.clone() } else { path.with_file_name(file) };
            assert!(target.exists(), "{}: {link} is not there", path.display());
            if let Some(heading) = heading {
                let text = std::fs::read_to_string(&target).expect("a document");
                let there = text.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#'));
                assert!(
                    there.into_iter().any(|line| anchor(line) == heading),
                    "{}: {link}: no such heading",
                    path.display()
                );
            }
            count += 1;
        }
    }
    assert!(count > 30, "{count} links");
}
