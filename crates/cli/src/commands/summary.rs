//! `plateau summary`: what the Python package asks of a run file that this program computes.

use plateau_core::observe::window_mean::WindowMean;
use plateau_io::number;
use serde::Serialize;

use crate::arguments::SummaryArguments;
use crate::failure::Failure;
use crate::summary::{acceleration, running_in, running_in_time};
use crate::table::print_json;

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
    let run = super::runs::open_run(&arguments.run)?;
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
