//! Run files that a command line names, what deserves to be said of them, and `plateau summary`: what the Python package asks of one that this
//! program computes.

use std::path::Path;

use plateau_core::observe::window_mean::WindowMean;
use plateau_io::number;
use plateau_io::run_file::{RunFile, State};
use serde::Serialize;

use crate::arguments::SummaryArguments;
use crate::failure::Failure;
use crate::message;
use crate::summary::{acceleration, running_in, running_in_time};
use crate::table::print_json;

/// Opens a run file; warns when it is not finished.
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

/// The contact area at the end of a run, and what the run says of itself, in words.
#[derive(Debug, Serialize)]
struct Document {
    state: &'static str,
    contact_area_last_tenth: Option<WindowMean>,
    running_in: String,
    running_in_time: String,
    time_acceleration: Option<String>,
}

/// Prints it as JSON.
pub fn summary(arguments: &SummaryArguments) -> Result<(), Failure> {
    let run = open_run(&arguments.run)?;
    let found = run.contact_area().map_err(Failure::input)?;
    let document = Document {
        state: run.state().name(),
        contact_area_last_tenth: found.last_tenth,
        running_in: running_in(&found.drift),
        running_in_time: running_in_time(&found.running_in),
        time_acceleration: run
            .chosen_acceleration()
            .map(|chosen| acceleration(&chosen))
            .or(run.given_acceleration().map(|given| format!("m = {}", number::short(given)))),
    };
    print_json(&document)
}
