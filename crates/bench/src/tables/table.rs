//! Tables for people, as text and as Markdown, and the numbers in them.

use crate::document::Spread;

/// A table; every row has as many cells as the header.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// Names of the columns.
    pub header: Vec<String>,
    /// Cells; all columns but the first hold numbers and are set to the right.
    pub rows: Vec<Vec<String>>,
    /// Lines below the table.
    pub notes: Vec<String>,
}

impl Table {
    /// A table without rows.
    pub fn new(title: impl Into<String>, header: &[&str]) -> Self {
        let header = header.iter().map(|name| (*name).to_owned()).collect();
        Self { title: title.into(), header, rows: Vec::new(), notes: Vec::new() }
    }

    /// Aligned text.
    pub fn text(&self) -> String {
        let widths = self.widths();
        let line = |cells: &[String]| {
            let cells = cells.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
                let (cell, width) = (cell.as_str(), *width);
                if column == 0 { format!("{cell:width$}") } else { format!("{cell:>width$}") }
            });
            format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
        };
        let rows: String = std::iter::once(&self.header).chain(&self.rows).map(|row| line(row)).collect();
        let notes: String = self.notes.iter().map(|note| format!("  {note}\n")).collect();
        format!("{}\n{rows}{notes}", self.title)
    }

    /// Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule: String = (0..self.header.len()).map(|column| if column == 0 { "|---" } else { "|---:" }).collect();
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        let notes: String = self.notes.iter().map(|note| format!("\n{note}\n")).collect();
        format!("**{}**\n\n{}{rule}|\n{rows}{notes}", self.title, line(&self.header))
    }

    fn widths(&self) -> Vec<usize> {
        let lines = || std::iter::once(&self.header).chain(&self.rows);
        let width = |column: usize| lines().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
        (0..self.header.len()).map(|column| width(column).unwrap_or(0)).collect()
    }
}

/// Least and largest.
pub fn range(spread: Spread) -> String {
    format!("{} – {}", number(spread.minimum), number(spread.maximum))
}

/// At least three digits.
pub fn number(value: f64) -> String {
    let digits = if value >= 100.0 {
        0
    } else if value >= 10.0 {
        1
    } else {
        2
    };
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_table_in_two_forms() {
        let mut table = Table::new("Time", &["what", "µs"]);
        table.rows.push(vec!["a step".into(), "8.0".into()]);
        table.notes.push("On one core.".into());
        assert_eq!(table.text(), "Time\n  what     µs\n  a step  8.0\n  On one core.\n");
        assert_eq!(table.markdown(), "**Time**\n\n| what | µs |\n|---|---:|\n| a step | 8.0 |\n\nOn one core.\n");
    }

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!([1234.5, 123.4, 12.34, 1.234, 0.1234].map(number), ["1234", "123", "12.3", "1.23", "0.12"]);
    }
}
