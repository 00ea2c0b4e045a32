//! What is wrong with a scene or a study, with the line in which it stands and a mark below.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use console::measure_text_width;
use plateau_io::delimited::{decode, numbered};
use plateau_io::scene::{Origin, Problem};
use plateau_io::{brief, text};

/// Longest line that is shown, characters: of a longer one its beginning.
const LONGEST: usize = 160;

/// Problems, as many as are read, each with its line if it has one.
pub fn of(problems: &[Problem]) -> String {
    let mut files = HashMap::new();
    brief::problems(problems.iter().map(|problem| with_line(problem, &mut files)))
}

fn with_line<'a>(problem: &'a Problem, files: &mut HashMap<&'a Path, Option<String>>) -> String {
    let Origin::Place { file, line, column } = &problem.origin else { return problem.to_string() };
    let text = files.entry(file).or_insert_with(|| fs::read(file).ok().map(|content| decode(&content).into_owned()));
    let shown = text.as_ref().and_then(|text| marked(text, *line, *column));
    shown.map_or_else(|| problem.to_string(), |shown| format!("{problem}\n{shown}"))
}

/// A line with its number, and a mark below the column; both count from 1. None if there is no such place, as when the file has
/// changed meanwhile.
fn marked(text: &str, line: usize, column: usize) -> Option<String> {
    let (_, found) = numbered(text).nth(line.checked_sub(1)?)?;
    if column > found.chars().count().min(LONGEST) + 1 {
        return None;
    }
    // Tabs and control characters would move the mark, or the terminal.
    let shown: String = found.chars().take(LONGEST).map(|each| if each.is_control() { ' ' } else { each }).collect();
    let number = line.to_string();
    let blank = " ".repeat(number.len());
    // Letters of some languages are two columns wide, and what turns the direction of writing is shown by its number.
    let before: String = shown.chars().take(column - 1).collect();
    let mark = " ".repeat(measure_text_width(&text::shown(&before)));
    Some(format!("  {number} | {}\n  {blank} | {mark}^", shown.trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mark_stands_below_the_column() {
        let text = "version = 1\n\tname = \"a\u{7}\"\n";
        assert_eq!(marked(text, 2, 9).as_deref(), Some("  2 |  name = \"a \"\n    |         ^"));
        assert_eq!(marked(text, 1, 12).as_deref(), Some("  1 | version = 1\n    |            ^"));
        assert_eq!(marked("\u{540d} = 1", 1, 5).as_deref(), Some("  1 | \u{540d} = 1\n    |      ^"));
        assert_eq!(marked(text, 3, 1), None);
        assert_eq!(marked(text, 1, 40), None);
        assert_eq!(marked(&"x".repeat(1000), 1, 170), None);
    }
}
