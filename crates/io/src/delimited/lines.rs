//! The lines of a text.

/// The lines of a text, each with its number, counted from 1. Line ends are those of any system.
pub fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> + Clone {
    let line_end = if text.contains('\n') { '\n' } else { '\r' };
    text.strip_suffix(line_end)
        .unwrap_or(text)
        .split(line_end)
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim_end_matches('\r')))
}

/// The lines of a text that are not blank, without a first line `sep=;`, which is for spreadsheets.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> + Clone {
    let first = usize::from(stated_separator(text).is_some());
    numbered(text).skip(first).filter(|(_, line)| !line.trim().is_empty())
}

/// What parts columns where the first line says so, as spreadsheets take it: `sep=;`.
pub(crate) fn stated_separator(text: &str) -> Option<char> {
    let (_, first) = numbered(text).next()?;
    let (name, mark) = first.trim_matches([' ', '"']).split_at_checked(4)?;
    [';', ',', '\t'].into_iter().find(|own| name.eq_ignore_ascii_case("sep=") && mark.chars().eq([*own]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_as_on_any_system() {
        for text in ["1\n\n2\n", "1\r\n\r\n2\r\n", "1\r\r2\r", "1\r\r\n\r\r\n2\r\r\n"] {
            assert_eq!(lines(text).collect::<Vec<_>>(), [(1, "1"), (3, "2")], "{text:?}");
        }
    }

    #[test]
    fn a_first_line_for_spreadsheets_is_no_line_of_the_table() {
        for (text, mark) in [("sep=;\r\n1;2", ';'), ("\"SEP=,\"\n1;2", ','), ("sep=\t\n1;2", '\t')] {
            assert_eq!((stated_separator(text), lines(text).collect::<Vec<_>>()), (Some(mark), vec![(2, "1;2")]));
        }
        for text in ["sep=\n1", "sep=5 um\n1", "separator=;\n1", "1\nsep=;", "é", ""] {
            assert_eq!(stated_separator(text), None, "{text}");
        }
    }
}
