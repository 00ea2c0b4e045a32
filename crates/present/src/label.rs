//! What runs are called, in figures and on the page of a report.

use std::path::Path;

use plateau_io::run_file::RunFile;
use plateau_io::text::{is_plain, shown_title};

/// The title of every run's scene; where titles are equal with the name of the file behind it, where these are, too, with
/// its path.
pub fn labels(runs: &[RunFile]) -> Vec<String> {
    let named: Vec<_> = runs.iter().map(|run| (run.title(), run.path())).collect();
    told_apart(&named)
}

/// Titles and paths as labels.
fn told_apart(runs: &[(&str, &Path)]) -> Vec<String> {
    let candidates: Vec<[String; 3]> = runs.iter().map(|(title, path)| candidates(title, path)).collect();
    let is_only = |label: &String| candidates.iter().filter(|others| others.contains(label)).count() == 1;
    let label = |own: &[String; 3]| own.iter().find(|label| is_only(label)).unwrap_or(&own[2]).clone();
    candidates.iter().map(label).collect()
}

/// What a run may be called, from short to long.
fn candidates(title: &str, path: &Path) -> [String; 3] {
    let (title, path) = (on_one_line(&shown_title(title.trim())), path.with_extension(""));
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let names = [name, path.to_string_lossy()].map(|name| on_one_line(&name));
    match names {
        [name, path] if title.is_empty() => [name.clone(), name, path],
        [name, path] => [title.clone(), format!("{title} ({name})"), format!("{title} ({path})")],
    }
}

/// A text without characters that would move, hide or turn what follows them.
pub fn on_one_line(text: &str) -> String {
    text.chars().map(|letter| if is_plain(letter) { letter } else { ' ' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(runs: &[(&str, &str)]) -> Vec<String> {
        told_apart(&runs.iter().map(|(title, path)| (*title, Path::new(*path))).collect::<Vec<_>>())
    }

    #[test]
    fn runs_are_called_by_as_little_as_tells_them_apart() {
        assert_eq!(labels(&[("Quick look", "a.h5")]), ["Quick look"]);
        assert_eq!(labels(&[("Quick", "a.h5"), ("Slow", "b/a.h5")]), ["Quick", "Slow"]);
        assert_eq!(
            labels(&[("Quick", "a.h5"), ("Slow", "b.h5"), ("Quick", "c.h5")]),
            ["Quick (a)", "Slow", "Quick (c)"]
        );
        assert_eq!(labels(&[("Quick", "one/a.h5"), ("Quick", "two/a.h5")]), ["Quick (one/a)", "Quick (two/a)"]);
        assert_eq!(labels(&[(" ", "one/a.h5"), ("", "b.h5")]), ["a", "b"]);
        // The same run twice has no names that differ.
        assert_eq!(labels(&[("Quick", "a.h5"), ("Quick", "a.h5")]), ["Quick (a)", "Quick (a)"]);
    }

    #[test]
    fn long_titles_are_cut() {
        assert_eq!(labels(&[(&"x".repeat(1 << 20), "a.h5")]), [format!("{}…", "x".repeat(200))]);
    }

    #[test]
    fn control_characters_do_not_reach_a_terminal() {
        assert_eq!(labels(&[("two\nlines\u{1b}[31m", "a.h5")]), ["two lines [31m"]);
    }
}
