//! Where another table begins: below a blank line, or with a line of a header, where rows stand above and below.

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Says what stands below: names, a unit, a pitch.
    Header,
    /// A row of the table.
    Row,
    /// Says nothing of the table.
    Comment,
}

/// The first line of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Start<'a> {
    pub(crate) line: usize,
    pub(crate) text: &'a str,
    /// What tells that it is one.
    pub(crate) sign: &'static str,
}

/// The first lines of the blocks of a text below its first block. Of its lines the blank ones are left out.
pub(crate) fn starts<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
    kind: impl Fn(&str) -> Kind,
) -> impl Iterator<Item = Start<'a>> {
    let (mut has_rows, mut last, mut start) = (false, 0, None);
    lines.filter_map(move |(line, text)| {
        let kind = kind(text);
        let sign = match kind {
            _ if line > last + 1 => Some("below a blank line"),
            Kind::Header => Some("with a header"),
            Kind::Row | Kind::Comment => None,
        };
        last = line;
        if let Some(sign) = sign.filter(|_| has_rows && start.is_none()) {
            start = Some(Start { line, text, sign });
        }
        if kind != Kind::Row {
            return None;
        }
        has_rows = true;
        start.take()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::delimited::lines;

    #[test]
    fn blocks_begin_below_blank_lines_and_with_headers() {
        let kind = |text: &str| match text.chars().next() {
            Some('#') => Kind::Comment,
            Some('h') => Kind::Header,
            _ => Kind::Row,
        };
        for (text, expected) in [
            ("h\n\n# a\n\n1\n2\n# b\n3\n\n# end\n\nh\n", vec![]),
            ("1\n\n2\n3\nh\nh\n4\n", vec![(3, "below a blank line"), (5, "with a header")]),
            ("1\n\n# a\n\nh\n2\n\n\n3", vec![(3, "below a blank line"), (9, "below a blank line")]),
            ("", vec![]),
        ] {
            let found: Vec<_> = starts(lines(text), kind).map(|start| (start.line, start.sign)).collect();
            assert_eq!(found, expected, "{text}");
        }
    }
}
