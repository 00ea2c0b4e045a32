//! The decimal mark of a text.

/// What stands between the whole number and its fraction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Decimal {
    /// 0.5
    #[default]
    Point,
    /// 0,5
    Comma,
}

impl Decimal {
    /// The mark of a number, which may have a unit behind it; none of what is no number, has no fraction, or has digits in groups.
    pub(crate) fn of(cell: &str) -> Option<Self> {
        let is_whole = |text: &str| text.trim_start_matches(['+', '-']).bytes().all(|byte| byte.is_ascii_digit());
        let is_fraction =
            |text: &str| text.starts_with(|first: char| first.is_ascii_digit()) && !text.contains([',', '.']);
        let at = cell.find([',', '.'])?;
        let is_number = is_whole(&cell[..at]) && is_fraction(&cell[at + 1..]);
        is_number.then(|| if cell[at..].starts_with(',') { Self::Comma } else { Self::Point })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_tells_its_mark() {
        for (cells, mark) in [
            (&["1,5", "-0,25e-3", "7,5 N", ",5"][..], Some(Decimal::Comma)),
            (&["1.5", "-0.25e-3", "7.5 N", ".5"], Some(Decimal::Point)),
            (&["1.234,5", "1,2,3", "a, b", ",", "7", "12.03.2026", "a.5", ""], None),
        ] {
            cells.iter().for_each(|cell| assert_eq!(Decimal::of(cell), mark, "{cell}"));
        }
    }
}
