//! Where run files come from, the scenes that they were made of, and in which keys those differ.

use std::collections::{BTreeMap, BTreeSet};

use plateau_io::run_file::RunFile;
use plateau_io::scene::values;

use super::html;
use super::outcome::UNKNOWN;

/// A folded part of the page about one run.
pub fn fold(label: &str, run: &RunFile) -> String {
    let scene = run.attribute("scene").unwrap_or_default();
    format!(
        "<details><summary>{}</summary>\n{}<h4>Resolved scene</h4>\n\
         <pre tabindex=\"0\" aria-label=\"Resolved scene\">{}</pre>\n</details>\n",
        html::escape(label),
        html::terms(&terms(run)),
        html::escape(&scene)
    )
}

/// What the root attributes of the file tell, as far as they are there.
fn terms(run: &RunFile) -> Vec<(&'static str, String)> {
    let attributes = [
        ("Program", "program"),
        ("Source revision", "source_revision"),
        ("Host", "host"),
        ("Instruction set", "instruction_set"),
        ("Start", "start_time"),
        ("End", "end_time"),
        ("Seeds", "seeds"),
        ("Files read", "inputs"),
        ("Surfaces", "surfaces"),
        ("Conventions", "conventions"),
        ("Model", "references"),
    ];
    let terms = attributes.into_iter().filter_map(|(name, attribute)| {
        let text = run.attribute(attribute)?;
        Some((name, if attribute == "inputs" { inputs(&text) } else { text }))
    });
    std::iter::once(("Run file", run.path().display().to_string())).chain(terms).collect()
}

/// The JSON list of files as one line for each; as it is if it is no such list.
fn inputs(json: &str) -> String {
    let line = |input: &serde_json::Value| {
        Some(format!("{}  SHA-256 {}", input.get("path")?.as_str()?, input.get("sha256")?.as_str()?))
    };
    let lines = serde_json::from_str::<Vec<serde_json::Value>>(json).ok();
    let lines = lines.and_then(|inputs| inputs.iter().map(line).collect::<Option<Vec<_>>>());
    lines.map_or_else(|| json.to_owned(), |lines| lines.join("\n"))
}

/// A row for every key that does not have the same value in all scenes: the key, and its value in each.
pub fn differences(scenes: &[&toml::Table]) -> Vec<Vec<String>> {
    let scenes: Vec<_> = scenes.iter().map(|scene| values(scene)).collect();
    let all: BTreeSet<_> = scenes.iter().flat_map(BTreeMap::keys).collect();
    let differs = |key: &String| scenes.iter().any(|scene| scene.get(key) != scenes[0].get(key));
    let row = |key: &String| {
        let texts = scenes.iter().map(|scene| match scene.get(key) {
            Some(toml::Value::String(text)) => text.clone(),
            value => value.map_or_else(|| UNKNOWN.into(), toml::Value::to_string),
        });
        std::iter::once(key.clone()).chain(texts).collect()
    };
    all.into_iter().filter(|key| differs(key)).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_listed_with_their_digests() {
        let json = r#"[{"path":"a.toml","sha256":"12"},{"path":"b.sdf","sha256":"34"}]"#;
        assert_eq!(inputs(json), "a.toml  SHA-256 12\nb.sdf  SHA-256 34");
        assert_eq!(inputs("[1]"), "[1]");
        assert_eq!(inputs("{"), "{");
    }

    #[test]
    fn keys_that_differ_are_found_at_any_depth() {
        let parse = |text: &str| text.parse::<toml::Table>().unwrap();
        let one = parse("title = 'a'\n[disc.surface]\nsynthetic = { seed = 1, patch = '8 mm' }\nmirror = false");
        let other = parse("title = 'a'\n[disc.surface]\nsynthetic = { seed = 2 }\nmirror = false");
        let expected = [["disc.surface.synthetic.patch", "8 mm", "–"], ["disc.surface.synthetic.seed", "1", "2"]];
        assert_eq!(differences(&[&one, &other]), expected);
        assert!(differences(&[&one, &one]).is_empty());
        assert!(differences(&[]).is_empty());
    }
}
