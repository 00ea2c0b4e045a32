//! Tables as comma-separated values.

/// Lines of cells, those that need it in quotation marks.
pub fn csv_table<Line>(lines: impl IntoIterator<Item = Line>) -> String
where
    Line: IntoIterator,
    Line::Item: AsRef<[u8]>,
{
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    for line in lines {
        // Writing to memory cannot fail.
        let _ = writer.write_record(line);
    }
    String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::csv_table;

    #[test]
    fn cells_are_quoted_where_they_need_it() {
        assert_eq!(csv_table([["plain", "a, \"b\""], ["", "two\nlines"]]), "plain,\"a, \"\"b\"\"\"\n,\"two\nlines\"\n");
    }
}
