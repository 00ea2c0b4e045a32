//! Run files that a command line names, and what deserves to be said of them.

use std::path::{Path, PathBuf};

use plateau_io::number;
use plateau_io::run_file::{RunFile, State};
use plateau_present::figure::run::{self, Figures, MOST_RUNS, Options, moment};

use crate::failure::Failure;
use crate::message;

/// Opens a run file; warns when it is not finished.
///
/// # Errors
/// [`Failure::Input`] when it cannot be read.
pub fn open_run(path: &Path) -> Result<RunFile, Failure> {
    let run = RunFile::open(path).map_err(Failure::input)?;
    warn_of_unfinished(&run);
    Ok(run)
}

/// Warns of a run that is not finished.
pub fn warn_of_unfinished(run: &RunFile) {
    let samples = number::count(run.time().len(), "sample");
    let state = match run.state() {
        State::Finished => return,
        State::Running => "running (or it was killed)".to_owned(),
        state => state.name().to_owned(),
    };
    message::warning(format_args!("{} is not finished: its state is {state}, with {samples}", run.path().display()));
}

/// Part of the last time that a time may be beyond the maps without a word: maps are of the step that comes to their time.
const BEYOND: f64 = 1e-3;

/// Warns where a map is asked for, by a time in s, before the first or after the last one of a run.
pub fn warn_of_times(run: &RunFile, at: &[f64]) {
    let times = run.map_time();
    let [Some(first), Some(last)] = [times.first(), times.last()] else { return };
    for time in at {
        let (place, index) = match () {
            () if *time < first - BEYOND * last => ("before the first", 0),
            () if *time > last + BEYOND * last => ("after the last", times.len() - 1),
            () => continue,
        };
        let (path, time) = (run.path().display(), number::rounded(*time, 4));
        message::warning(format_args!(
            "{path}: {time} s is {place} recorded map, that of {} is shown",
            moment(run, index)
        ));
    }
}

/// Opens run files that are shown together; warns of those that are not finished or named twice.
///
/// # Errors
/// [`Failure::Input`] when there are too many of them, or one cannot be read.
pub fn open_runs(paths: &[PathBuf]) -> Result<Vec<RunFile>, Failure> {
    let count = paths.len();
    if count > MOST_RUNS {
        return Err(Failure::input(format!(
            "{count} runs: expected at most {MOST_RUNS}, more make no legible figure; name fewer"
        )));
    }
    let runs = paths.iter().map(|path| open_run(path)).collect::<Result<Vec<_>, _>>()?;
    let real: Vec<_> = paths.iter().map(|path| path.canonicalize().ok()).collect();
    for (index, path) in paths.iter().enumerate() {
        if real[index].is_some() && real[..index].contains(&real[index]) {
            message::warning(format_args!("{} is named more than once", path.display()));
        }
    }
    Ok(runs)
}

/// The figures of runs; says what was left out of them.
///
/// # Errors
/// [`Failure::Input`] when a file turns out to be damaged.
pub fn figures(runs: &[RunFile], options: &Options) -> Result<Figures, Failure> {
    runs.iter().for_each(|run| warn_of_times(run, &options.at));
    let figures = run::figures(runs, options).map_err(Failure::input)?;
    for reason in &figures.left_out {
        message::note(reason);
    }
    Ok(figures)
}

/// A path in the working directory, named like a run file with another ending: where a command writes unless told.
pub fn named_like(run: &Path, ending: &str) -> PathBuf {
    let mut name = run.file_stem().unwrap_or(run.as_os_str()).to_owned();
    name.push(ending);
    name.into()
}

/// The runs and the files that they have read: none of them is replaced by what is made of the runs.
pub(super) fn inputs_of(runs: &[RunFile]) -> Vec<PathBuf> {
    let read = runs.iter().flat_map(RunFile::inputs).map(|input| PathBuf::from(input.path));
    runs.iter().map(|run| run.path().to_owned()).chain(read).collect()
}
