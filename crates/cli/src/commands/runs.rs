//! Run files that a command line names, and what deserves to be said of them.

use std::path::Path;

use plateau_io::number;
use plateau_io::run_file::{RunFile, State};

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

/// Indices of the maps that were recorded nearest to some times (s), in their order, each once.
pub fn nearest(run: &RunFile, times: &[f64]) -> Vec<usize> {
    let recorded = run.map_time();
    let distance = |index: &usize, time: f64| (recorded[*index] - time).abs();
    let nearest =
        |time: &f64| (0..recorded.len()).min_by(|one, other| distance(one, *time).total_cmp(&distance(other, *time)));
    let mut indices: Vec<usize> = times.iter().filter_map(nearest).collect();
    indices.sort_unstable();
    indices.dedup();
    indices
}

/// The time of a map, in words.
pub fn moment(run: &RunFile, index: usize) -> String {
    let seconds = run.map_time().get(index).copied().unwrap_or(f64::NAN);
    match seconds {
        short if short > 0.0 && short < 0.1 => format!("{} ms", number::rounded(1e3 * short, 4)),
        long if long >= 2e4 => format!("{} h", number::rounded(long / 3600.0, 4)),
        seconds => format!("{} s", number::rounded(seconds, 4)),
    }
}
