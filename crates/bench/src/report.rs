//! Results as tables: printed, or in their places in a document.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use clap::Args;

use crate::document::{Benchmark, Document};
use crate::error::BenchError;
use crate::tables::tables;

/// Options of `report`.
#[derive(Debug, Args)]
pub struct ReportOptions {
    /// Results, as --json writes them, one file for each benchmark
    #[arg(required = true, value_name = "JSON")]
    pub results: Vec<PathBuf>,
    /// Put the tables into a document, between its marks, instead of printing them
    #[arg(long, value_name = "MARKDOWN")]
    pub into: Option<PathBuf>,
}

/// Prints the tables of results, and writes these to a JSON file if there is to be one.
pub fn give_out(document: &Document, json: Option<&Path>) -> Result<(), BenchError> {
    if let Some(path) = json {
        document.write(path)?;
    }
    print(&tables(document).iter().map(|table| table.text() + "\n").collect::<String>())
}

/// Prints text on standard output; a reader who went away is no error.
fn print(text: &str) -> Result<(), BenchError> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(source) if source.kind() != io::ErrorKind::BrokenPipe => {
            Err(BenchError::File { path: "standard output".into(), source })
        }
        _ => Ok(()),
    }
}

/// Prints the tables, or puts them into a document between the marks of their benchmark; the text around is kept.
pub fn report(options: &ReportOptions) -> Result<(), BenchError> {
    let mut reports: Vec<(Benchmark, String)> = Vec::new();
    for path in &options.results {
        let document = Document::read(path)?;
        let benchmark = document.benchmark;
        if reports.iter().any(|(known, _)| *known == benchmark) {
            return Err(BenchError::Twice { path: path.clone(), benchmark: benchmark.name() });
        }
        let markdown = tables(&document).iter().map(|table| table.markdown()).collect::<Vec<_>>().join("\n");
        reports.push((benchmark, markdown));
    }
    reports.sort_by_key(|(benchmark, _)| Benchmark::ALL.iter().position(|other| other == benchmark));

    let Some(path) = &options.into else {
        return print(&reports.into_iter().map(|(_, markdown)| markdown).collect::<Vec<_>>().join("\n"));
    };
    let mut text = fs::read_to_string(path).map_err(BenchError::file(path))?;
    for (benchmark, markdown) in reports {
        let [begin, end] = marks(benchmark);
        text = replace_between(&text, &begin, &end, &markdown).ok_or_else(|| BenchError::NoPlace {
            path: path.clone(),
            begin,
            end,
        })?;
    }
    fs::write(path, text).map_err(BenchError::file(path))
}

/// The lines between which the tables of a benchmark are.
fn marks(benchmark: Benchmark) -> [String; 2] {
    let name = benchmark.name();
    [format!("<!-- {name}: made by plateau-bench report -->"), format!("<!-- end of {name} -->")]
}

fn replace_between(text: &str, begin: &str, end: &str, new: &str) -> Option<String> {
    let (before, rest) = text.split_once(begin)?;
    let (_, after) = rest.split_once(end)?;
    Some(format!("{before}{begin}\n\n{new}\n{end}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_between_the_marks_changes() {
        let text = "By hand.\n<b>\nold\n<e>\nMore.\n";
        let new = replace_between(text, "<b>", "<e>", "table\n").unwrap();
        assert_eq!(new, "By hand.\n<b>\n\ntable\n\n<e>\nMore.\n");
        assert_eq!(replace_between(&new, "<b>", "<e>", "table\n").unwrap(), new);
        assert_eq!(replace_between("<e> <b>", "<b>", "<e>", "table"), None);
    }
}
