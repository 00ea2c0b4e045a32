//! Where a run file comes from, and the scene that it was made of.

use plateau_io::run_file::RunFile;

use super::html;

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

#[cfg(test)]
mod tests {
    use super::inputs;

    #[test]
    fn files_are_listed_with_their_digests() {
        let json = r#"[{"path":"a.toml","sha256":"12"},{"path":"b.sdf","sha256":"34"}]"#;
        assert_eq!(inputs(json), "a.toml  SHA-256 12\nb.sdf  SHA-256 34");
        assert_eq!(inputs("[1]"), "[1]");
        assert_eq!(inputs("{"), "{");
    }
}
