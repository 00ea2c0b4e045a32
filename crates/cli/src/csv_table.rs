//! Tables as comma-separated values.

use plateau_io::text::cell;

/// Lines of cells, those that need it in quotation marks, and those that a spreadsheet would compute marked as text.
pub fn csv_table<Line>(lines: impl IntoIterator<Item = Line>) -> String
where
    Line: IntoIterator,
    Line::Item: AsRef<str>,
{
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    for line in lines {
        // Writing to memory cannot fail.
        let _ = writer.write_record(line.into_iter().map(|text| cell(text.as_ref()).into_owned()));
    }
    String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::csv_table;

    #[test]
    fn what_a_spreadsheet_would_compute_is_text() {
        assert_eq!(csv_table([["=1+1", "-1.5", "@a"]]), "'=1+1,-1.5,'@a\n");
    }

    #[test]
    fn cells_are_quoted_where_they_need_it() {
        assert_eq!(csv_table([["plain", "a, \"b\""], ["", "two\nlines"]]), "plain,\"a, \"\"b\"\"\"\n,\"two\nlines\"\n");
    }
}
