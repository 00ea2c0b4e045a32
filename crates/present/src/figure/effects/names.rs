//! Names of files that are made of the names of responses.

/// Longest name, in letters: with what is added to it, and in any letters, it is one that file systems take.
const LONGEST: usize = 40;

/// A name for each response, fit for a file and different from all others: `contact area` becomes `contact-area`.
pub fn file_names<'a>(responses: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for response in responses {
        let plain = plain(response);
        let numbered = (2..).map(|number| format!("{plain}-{number}"));
        let name = std::iter::once(plain.clone()).chain(numbered).find(|name| !names.contains(name));
        names.push(name.unwrap_or(plain));
    }
    names
}

/// Small letters and digits, with a hyphen for everything between them.
fn plain(name: &str) -> String {
    let letters: String = name.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { ' ' }).collect();
    let plain = letters.split_whitespace().collect::<Vec<_>>().join("-");
    let plain: String = plain.chars().take(LONGEST).collect();
    if plain.is_empty() { "response".to_owned() } else { plain.trim_end_matches('-').to_owned() }
}

#[cfg(test)]
mod tests {
    use super::file_names;

    #[test]
    fn names_are_fit_for_files_and_differ() {
        let responses = ["Contact area", "contact_area", "../a/b", "µ (mean)", "<script>", "?"];
        let expected = ["contact-area", "contact-area-2", "a-b", "µ-mean", "script", "response"];
        assert_eq!(file_names(responses.into_iter()), expected);
        assert_eq!(file_names(["x y ".repeat(99).as_str()].into_iter())[0].len(), 39);
    }
}
