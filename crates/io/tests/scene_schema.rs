//! The JSON Schema of scenes and the parser agree.

use std::fs;
use std::path::{Path, PathBuf};

use jsonschema::Validator;
use plateau_io::scene;
use plateau_io::scene::schema::{self, Key, Kind, Need};
use proptest::prelude::*;
use serde_json::Value;

fn validator() -> Validator {
    jsonschema::draft7::new(&schema::json_schema()).expect("a schema")
}

/// A text in TOML as the value that a validator sees; `None` if it is not TOML, whose integers have 64 bits.
fn document(text: &str) -> Option<Value> {
    serde_json::to_value(text.parse::<toml::Table>().ok()?).ok()
}

fn scenes(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<_> = entries.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    scenes.sort();
    assert!(!scenes.is_empty());
    scenes
}

#[test]
fn the_schema_is_a_schema_of_draft_7() {
    jsonschema::draft7::meta::validate(&schema::json_schema()).unwrap();
}

#[test]
fn every_good_scene_is_valid() {
    let validator = validator();
    let vectors = ["flat", "rough", "track"].map(|name| format!("../../tests/vectors/{name}"));
    let folders = ["tests/scenes/good", "tests/scenes/good/parts", "../../data/scenes"].map(str::to_owned);
    for path in folders.iter().chain(&vectors).flat_map(|folder| scenes(folder)) {
        let document = document(&fs::read_to_string(&path).unwrap()).unwrap();
        if let Err(error) = validator.validate(&document) {
            panic!("{}: {error} at {}", path.display(), error.instance_path());
        }
    }
}

/// Bad scenes that are no mistake of one file's form: what numbers say together, what the machine or this version cannot
/// do, and what only the scenes that they extend tell.
const FORM_IS_GOOD: &[&str] = &[
    "black-is-white",
    "companion-alone",
    "extends-a-folder",
    "extends-a-newer",
    "extends-in-a-circle",
    "extends-in-a-circle-too",
    "extends-itself",
    "extends-what-is-not-there",
    "fibre-wider-than-long",
    "image-without-pixel",
    "later-acceleration",
    "mesh-larger-than-memory",
    "pin-wider-than-ring",
    "power-law-incomplete",
    "radii-exchanged",
    "steps-beyond-counting",
    "texture-missing",
];

#[test]
fn every_scene_of_bad_form_is_not_valid() {
    let validator = validator();
    for path in scenes("tests/scenes/bad") {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let document = fs::read(&path).ok().and_then(|bytes| document(&String::from_utf8(bytes).ok()?));
        let valid = document.is_some_and(|document| validator.is_valid(&document));
        assert_eq!(valid, FORM_IS_GOOD.contains(&name.as_str()), "{name}");
    }
}

#[test]
fn every_piece_of_a_scene_in_the_documentation_is_valid() {
    let validator = validator();
    let mut count = 0;
    for path in fs::read_dir("../../docs").unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file()) {
        for block in fs::read_to_string(&path).unwrap().split("\n```toml\n").skip(1) {
            let piece = block.split("\n```").next().unwrap();
            if piece.contains("[[factor]]") {
                // A study.
                continue;
            }
            let start = if piece.contains("extends") { "" } else { "extends = \"scene.toml\"\n" };
            let document = document(&format!("{start}{piece}")).unwrap_or_else(|| panic!("{piece}"));
            if let Err(error) = validator.validate(&document) {
                panic!("{}: {error} at {} in\n{piece}", path.display(), error.instance_path());
            }
            count += 1;
        }
    }
    assert!(count > 3, "{count} pieces");
}

/// Whether the parser and the schema accept this value (in TOML) of a key, whatever it needs beside it.
fn accepted(validator: &Validator, path: &str, value: &str) -> (bool, bool) {
    // Another key that is wrong keeps the parser from looking at what several keys say together.
    let wrong = if path == "contact.load_tolerance" { "mesh.rows=0" } else { "contact.load_tolerance=7" };
    let sets = [format!("{path}={value}"), wrong.to_owned()];
    let error = scene::load(Path::new("tests/scenes/good/minimal.toml"), &sets).expect_err("a wrong key");
    let (about, alone) = (format!(": {path}: "), "has a meaning only beside");
    let problems = error.problems().iter().map(ToString::to_string);
    let refused = problems.into_iter().any(|problem| problem.contains(&about) && !problem.contains(alone));
    let document = document(&format!("extends = \"minimal.toml\"\n{path} = {value}")).expect(value);
    (!refused, validator.is_valid(&document))
}

/// Keys that `--set` may change one by one. An acceleration that the run chooses is refused as a whole by this version.
fn keys() -> impl Iterator<Item = &'static Key> {
    schema::keys().iter().filter(|key| key.name != "extends" && !key.name.starts_with("time_acceleration."))
}

/// A value that a key may have.
fn good_value(key: &Key) -> String {
    match key.kind {
        // Not from the schema under test but as written by hand here.
        Kind::Quantity { unit, .. } => format!("\"1.5e1 {unit}\""),
        Kind::Lengths { count, .. } => format!("[{}]", vec!["\"2 um\""; count].join(", ")),
        Kind::LengthUnit => "\"nm\"".into(),
        Kind::Number(range) | Kind::NumberOr(range, _) => {
            let inside = [0.5, 2.5].into_iter().find(|number| range.contains(*number));
            inside.expect("a number in the range").to_string()
        }
        Kind::Integer(_) | Kind::CountOr(_) => "1".into(),
        Kind::Bool | Kind::True => "true".into(),
        Kind::Choice(words) => format!("\"{}\"", words[0]),
        Kind::Text | Kind::InputFile => "\"a text\"".into(),
        Kind::Times => "[\"0 s\", \"2 min\"]".into(),
        Kind::Maps => "[\"pressure\", \"pin_status\"]".into(),
    }
}

#[test]
fn both_accept_a_good_value_of_every_key_and_refuse_wrong_types() {
    let validator = validator();
    for key in keys() {
        let path = key.path();
        assert_eq!(accepted(&validator, &path, &good_value(key)), (true, true), "{path} = {}", good_value(key));
        for wrong in ["1979-05-27", "[true]", "[[1]]", "\"\"", "\" \"", "-7"] {
            let expected = wrong == "-7" && accepts_minus_7(key);
            assert_eq!(accepted(&validator, &path, wrong), (expected, expected), "{path} = {wrong}");
        }
    }
}

fn accepts_minus_7(key: &Key) -> bool {
    matches!(key.kind, Kind::Number(range) if range.contains(-7.0))
}

#[test]
fn both_refuse_keys_that_are_not_there() {
    let validator = validator();
    for path in ["mesh.row", "pin.prepare.syntetic", "disc.surface.synthetic.sed", "pin.base.flat", "titel", "meshes"] {
        assert_eq!(accepted(&validator, path, "1"), (false, false), "{path}");
    }
}

#[test]
fn examples_and_defaults_of_the_schema_are_accepted_by_both() {
    let validator = validator();
    for key in keys() {
        let default = match key.need {
            Need::Default(default) => Some(default.to_owned()),
            _ => None,
        };
        for value in key.example().into_iter().chain(default) {
            assert_eq!(accepted(&validator, &key.path(), &value), (true, true), "{} = {value}", key.path());
        }
    }
}

/// Values of every kind, in TOML. Whole numbers are integers: JSON does not tell 8.0 from 8. There is no minus zero.
fn value() -> impl Strategy<Value = String> {
    let number = prop_oneof![
        (-3_i64..20).prop_map(|integer| integer.to_string()),
        (-30_i64..300)
            .prop_filter("a fraction", |tenths| tenths % 10 != 0)
            .prop_map(|t| format!("{:?}", t as f64 / 10.0)),
    ];
    let unit = prop::sample::select(vec![
        "m",
        "mm",
        "um",
        "µm",
        "N",
        "kN",
        "Pa",
        "GPa",
        "s",
        "min",
        "m/s",
        "km/h",
        "rpm",
        "rad/s",
        "Hz",
        "1/Pa",
        "m^2/N",
        "mm^3/(N m)",
        "m^2",
        "um^2",
        "kg",
        "",
        "x",
        "deg",
    ]);
    let words: Vec<&str> = schema::keys()
        .iter()
        .flat_map(|key| match key.kind {
            Kind::Choice(words) => words.to_vec(),
            Kind::NumberOr(_, word) | Kind::CountOr(word) => vec![word],
            _ => vec!["pressure", "disc_height"],
        })
        .collect();
    let quantity = (number.clone(), prop::sample::select(vec!["", " ", "e-3 ", "e2 "]), unit);
    let text = prop_oneof![
        quantity.prop_map(|(number, space, unit)| format!("\"{number}{space}{unit}\"")),
        prop::sample::select(words).prop_map(|word| format!("\"{word}\"")),
    ];
    let plain = prop_oneof![number, text, Just("true".to_owned()), Just("false".to_owned())];
    let list = prop::collection::vec(plain.clone(), 0..4).prop_map(|values| format!("[{}]", values.join(", ")));
    prop_oneof![3 => plain, 1 => list]
}

proptest! {
    #[test]
    fn schema_and_parser_agree_on_every_key(value in value()) {
        let validator = VALIDATOR.with(Clone::clone);
        for key in keys() {
            let (parser, schema) = accepted(&validator, &key.path(), &value);
            prop_assert_eq!(parser, schema, "{} = {}: parser, schema", key.path(), value);
        }
    }
}

thread_local! {
    static VALIDATOR: std::rc::Rc<Validator> = std::rc::Rc::new(validator());
}
