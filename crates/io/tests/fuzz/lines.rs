//! Changes of text that leave most of it what it is: lines, and values behind `=`, between commas, between colons.

use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Values at and beyond the limits of what readers expect, two blanks apart.
const ODD: &str = r#"
    "1e38 m"  "1e-320 m"  "1e308 m"  "-1 N"  "0 s"  "1e300 s"  "1e-300 s"  "1e400 N"  "1 m/s/s/s/s"  "1 "  " m"
    "nan m"  "9e99 1/Pa"  "-273.15 degC"  "1e9 degC"  ""  "auto"  "end"  "last tenth"  "a\nb"  "\u001b[2J"
    "../../../../dev/zero"  "/"  0  1  -1  2  7  1000  4294967296  9223372036854775807  18446744073709551615
    99999999999999999999  -0.0  1e400  5e-324  nan  -inf  true  false  []  [[]]  [1, 1, 1, 1]  ["0 s", "1e30 s"]  {}
    { seed = 1 }  1979-05-27
"#;

fn odd_value() -> impl Strategy<Value = &'static str> {
    select(ODD.trim().lines().flat_map(|line| line.trim().split("  ")).collect::<Vec<_>>())
}

/// What numbers are scaled by.
const FACTORS: [f64; 14] = [0.0, -1.0, 0.5, 2.0, 3.0, 10.0, 0.1, 1e-3, 1e3, 1e-9, 1e9, 1e-30, 1e30, 1e300];

/// Lines that begin something else.
const LINES: [&str; 12] = [
    "[mesh]",
    "[[factor]]",
    "[[response]]",
    "[thermal]",
    "version = 1",
    "a = 1",
    "\"\" = 1",
    "=",
    ",,,,",
    ";",
    "# \u{feff}",
    "]",
];

/// One change of some lines.
#[derive(Debug, Clone)]
pub(super) enum Change {
    /// Another value, of a line and of one of its parts.
    Value(Index, Index, &'static str),
    Remove(Index),
    Repeat(Index, u8),
    Swap(Index, Index),
    Insert(Index, &'static str),
    /// The number of a value times this.
    Scale(Index, Index, f64),
    /// Brackets in brackets.
    Nest(Index, Index, u16),
    /// A value of so many characters.
    Long(Index, Index, u16),
}

impl Change {
    pub(super) fn apply(&self, lines: &mut Vec<String>) {
        if lines.is_empty() {
            return;
        }
        let count = lines.len();
        match self {
            Self::Value(line, part, value) => replace(&mut lines[line.index(count)], *part, value),
            Self::Remove(line) => drop(lines.remove(line.index(count))),
            Self::Repeat(line, times) => {
                let line = line.index(count);
                let again = vec![lines[line].clone(); usize::from(*times)];
                lines.splice(line..line, again);
            }
            Self::Swap(one, other) => lines.swap(one.index(count), other.index(count)),
            Self::Insert(line, text) => lines.insert(line.index(count), (*text).to_owned()),
            Self::Scale(line, part, factor) => scale(&mut lines[line.index(count)], *part, *factor),
            Self::Nest(line, part, depth) => {
                let depth = usize::from(*depth);
                let value = ["[".repeat(depth), "]".repeat(depth)].concat();
                replace(&mut lines[line.index(count)], *part, &value);
            }
            Self::Long(line, part, length) => {
                let value = format!("\"{}\"", "x".repeat(usize::from(*length)));
                replace(&mut lines[line.index(count)], *part, &value);
            }
        }
    }
}

/// Puts a value in the place of one of a line: behind `=`, or between two separators.
fn replace(line: &mut String, part: Index, value: &str) {
    if let Some((key, _)) = line.split_once('=') {
        *line = format!("{key}= {value}");
        return;
    }
    let separator = if line.contains(';') { ';' } else { ',' };
    let mut parts: Vec<&str> = line.split(separator).collect();
    let at = part.index(parts.len());
    parts[at] = value.trim_matches('"');
    *line = parts.join(&separator.to_string());
}

/// Scales the first number behind `=`, or one of a line of a table.
fn scale(line: &mut String, part: Index, factor: f64) {
    let separator = if line.contains(';') { ';' } else { ',' };
    let parts: Vec<usize> = [0].into_iter().chain(line.match_indices(separator).map(|(at, _)| at + 1)).collect();
    let from = line.find('=').map_or_else(|| parts[part.index(parts.len())], |at| at + 1);
    let is_number = |letter: char| letter.is_ascii_digit() || ".eE+-".contains(letter);
    let Some(start) = line[from..].find(|letter: char| letter.is_ascii_digit()).map(|at| from + at) else { return };
    let end = line[start..].find(|letter| !is_number(letter)).map_or(line.len(), |at| start + at);
    if let Ok(number) = line[start..end].parse::<f64>() {
        let scaled = number * factor;
        let whole = !line[start..end].contains(['.', 'e', 'E']) && scaled.abs() < 1e15;
        let text = if whole { format!("{scaled:.0}") } else { format!("{scaled:e}") };
        line.replace_range(start..end, &text);
    }
}

pub(super) fn changes() -> impl Strategy<Value = Vec<Change>> {
    let index = any::<Index>;
    let change = prop_oneof![
        8 => (index(), index(), odd_value()).prop_map(|(line, part, value)| Change::Value(line, part, value)),
        8 => (index(), index(), select(FACTORS.to_vec()))
            .prop_map(|(line, part, factor)| Change::Scale(line, part, factor)),
        1 => index().prop_map(Change::Remove),
        1 => (index(), any::<u8>()).prop_map(|(line, times)| Change::Repeat(line, times)),
        1 => (index(), index()).prop_map(|(one, other)| Change::Swap(one, other)),
        1 => (index(), select(LINES.to_vec())).prop_map(|(line, text)| Change::Insert(line, text)),
        1 => (index(), index(), any::<u16>()).prop_map(|(line, part, depth)| Change::Nest(line, part, depth)),
        1 => (index(), index(), any::<u16>()).prop_map(|(line, part, length)| Change::Long(line, part, length)),
    ];
    prop::collection::vec(change, 1..4)
}

/// Some of these texts, changed line by line or byte by byte.
pub(super) fn changed(texts: Vec<String>) -> impl Strategy<Value = Vec<u8>> {
    let changes = prop_oneof![
        3 => changes().prop_map(|changes| (changes, Vec::new())),
        1 => super::bytes::changes().prop_map(|changes| (Vec::new(), changes)),
    ];
    (any::<Index>(), changes).prop_map(move |(text, (of_lines, of_bytes))| {
        let mut lines: Vec<String> = texts[text.index(texts.len())].lines().map(str::to_owned).collect();
        of_lines.iter().for_each(|change| change.apply(&mut lines));
        let mut content = (lines.join("\n") + "\n").into_bytes();
        of_bytes.iter().for_each(|change| change.apply(&mut content));
        content
    })
}
