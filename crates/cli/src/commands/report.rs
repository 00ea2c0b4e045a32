//! `plateau report`: one HTML page about runs.

use plateau_io::run_file::{ReadError, RunFile, State};

use crate::arguments::ReportArguments;
use crate::failure::Failure;
use crate::figure::run::{self, MOST_RUNS, Options};
use crate::report::Pictures;
use crate::table::{print, table};
use crate::{message, number, output, report};

/// Makes a page of run files.
pub fn report(arguments: &ReportArguments) -> Result<(), Failure> {
    let ReportArguments { runs: paths, output: page, force } = arguments;
    if paths.len() > MOST_RUNS {
        let found = paths.len();
        return Err(Failure::input(format_args!("a report is about {MOST_RUNS} runs at most, these are {found}")));
    }
    output::check(page, *force, paths)?;
    let runs = paths.iter().map(|path| RunFile::open(path)).collect::<Result<Vec<_>, ReadError>>();
    let runs = runs.map_err(Failure::input)?;
    for run in runs.iter().filter(|run| run.state() != State::Finished) {
        message::warning(format_args!("{} is not finished: its state is {}", run.path().display(), run.state().name()));
    }
    let figures = run::figures(&runs, &Options::default()).map_err(Failure::input)?;
    let html = report::page(&runs, &Pictures::draw(&figures)?).map_err(Failure::input)?;
    output::write(page, html.as_bytes(), *force)?;
    tell(arguments, &runs, figures.figures.len(), html.len())
}

/// Says what is on the page.
fn tell(arguments: &ReportArguments, runs: &[RunFile], figures: usize, bytes: usize) -> Result<(), Failure> {
    let count = |of: fn(&RunFile) -> usize| runs.iter().map(of).sum::<usize>().to_string();
    let rows = [
        ("page", format!("{} ({})", arguments.output.display(), number::bytes(bytes as u64))),
        ("runs", runs.len().to_string()),
        ("figures", figures.to_string()),
        ("series", count(|run| run.series().len())),
        ("samples", count(|run| run.time().len())),
        ("times of maps", count(|run| run.map_time().len())),
    ];
    print(&table("Report", &rows))
}
