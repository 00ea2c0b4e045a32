//! `plateau report`: one HTML page about runs.

use std::path::Path;

use plateau_io::number;
use plateau_io::run_file::RunFile;
use plateau_present::figure::run::Options;
use plateau_present::label;
use plateau_present::report::{self, Pictures};

use crate::arguments::ReportArguments;
use crate::failure::Failure;
use crate::table::{print, table};
use crate::{called, output, version};

/// Makes a page of run files.
pub fn report(arguments: &ReportArguments) -> Result<(), Failure> {
    let ReportArguments { runs: paths, output, force } = arguments;
    let page = &output.clone().unwrap_or_else(|| match paths.as_slice() {
        [path] => super::named_like(path, ".html"),
        _ => "report.html".into(),
    });
    refuse_other_format(page)?;
    let runs = super::open_runs(paths)?;
    output::check(page, *force, &super::runs::inputs_of(&runs))
        .map_err(|failure| failure.but("-o FILE names another one"))?;
    let figures = super::figures(&runs, &Options::default())?;
    let html = report::page(&runs, &Pictures::draw(&figures).map_err(Failure::run)?, &version::program())
        .map_err(Failure::input)?;
    output::write(page, html.as_bytes(), *force)?;
    tell(page, &runs, figures.figures.len(), html.len())
}

/// Endings of what other commands make, or a browser.
const NO_PAGES: [&str; 4] = ["pdf", "png", "svg", "csv"];

/// Refuses a name that says that the page is what it is not.
fn refuse_other_format(page: &Path) -> Result<(), Failure> {
    if !NO_PAGES.contains(&output::ending(page).as_str()) {
        return Ok(());
    }
    Err(Failure::input(format!(
        "-o {}: a report is a page in HTML, expected a name such as {}; a browser prints it as PDF, `{} plot` makes single figures",
        page.display(),
        page.with_extension("html").display(),
        called::program()
    )))
}

/// Says what is on the page.
fn tell(page: &Path, runs: &[RunFile], figures: usize, bytes: usize) -> Result<(), Failure> {
    let of_run = |(run, label): (&RunFile, String)| {
        let samples = number::count(run.time().len(), "sample");
        let maps = number::count(run.map_time().len(), "time");
        (label, format!("{}, {samples} of {} series, maps at {maps}", run.state().name(), run.series().len()))
    };
    let rows: Vec<_> = runs.iter().zip(label::labels(runs)).map(of_run).collect();
    let (figures, size) = (number::count(figures, "figure"), number::bytes(bytes as u64));
    print(&table(&format!("wrote {}: {figures} ({size})", page.display()), &rows))
}
