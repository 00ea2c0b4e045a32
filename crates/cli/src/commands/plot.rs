//! `plateau plot`: the figures of runs.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_io::run_file::RunFile;

use crate::arguments::{FigureFormat, PlotArguments};
use crate::failure::Failure;
use crate::figure::run::{self, Figure, MOST_RUNS, Options};
use crate::message;
use crate::output;
use crate::table::print;

/// Draws the figures of runs, each into a file of its own.
pub fn plot(arguments: &PlotArguments) -> Result<(), Failure> {
    let PlotArguments { runs: paths, output, format, polar, force } = arguments;
    if paths.len() > MOST_RUNS {
        let count = paths.len();
        return Err(Failure::input(format_args!(
            "{count} runs: expected at most {MOST_RUNS}, more make no legible figure"
        )));
    }
    let runs = paths.iter().map(|path| RunFile::open(path)).collect::<Result<Vec<_>, _>>().map_err(Failure::input)?;
    let figures = run::figures(&runs, &Options { polar: *polar }).map_err(Failure::input)?;
    for reason in &figures.left_out {
        message::note(reason);
    }
    let directory = output.clone().unwrap_or_else(|| usual_directory(paths));
    make_directory(&directory)?;
    let place = |figure: &Figure| directory.join(format!("{}.{}", figure.name, format.ending()));
    // Before the first is written: either all are, or none.
    figures.figures.iter().try_for_each(|figure| output::check(&place(figure), *force, paths))?;
    for figure in &figures.figures {
        let content = match format {
            FigureFormat::Png => figure.png(),
            FigureFormat::Svg => figure.svg().map(String::into_bytes),
            FigureFormat::Pdf => figure.pdf(),
        };
        let path = place(figure);
        output::write(&path, &content.map_err(Failure::run)?, *force)?;
        print(&format!("wrote {}: {}\n", path.display(), figure.title))?;
    }
    Ok(())
}

/// The folder where figures go unless one is named: called like the run file, or `figures` for several.
fn usual_directory(paths: &[PathBuf]) -> PathBuf {
    match paths {
        [path] => path.file_stem().map_or_else(|| "figures".into(), PathBuf::from),
        _ => "figures".into(),
    }
}

pub(super) fn make_directory(directory: &Path) -> Result<(), Failure> {
    let shown = directory.display();
    fs::create_dir_all(directory).map_err(|error| {
        Failure::input(format_args!("cannot make the folder {shown}: {error}; name another one with -o"))
    })
}
