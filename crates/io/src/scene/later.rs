//! Keys that the format has and this version of the program cannot follow yet.

use super::document::{Entries, Value};
use super::error::Problem;
use super::interpret::Setting;
use super::settings::Settings;

/// Acceleration that the run chooses itself.
const ADAPTIVE: &str = "numerics.time_acceleration";

/// Refuses what would silently not be done.
pub(super) fn refuse(entries: &Entries, problems: &mut Vec<Problem>) {
    if let Some(entry) = entries.get(ADAPTIVE).filter(|entry| entry.value == Value::Table) {
        let advice = "this version cannot choose the acceleration itself: give a number";
        problems.push(Problem::new(&entry.origin, ADAPTIVE, advice));
    }
}

/// Warns of what is not done but changes no result.
pub(super) fn warn(settings: &Settings, warnings: &mut Vec<String>) {
    let path = "output.checkpoint_every";
    if let Some(Setting::Number(_)) = settings.get(path) {
        let message = "this version writes no checkpoints: a run that is interrupted starts again from the beginning";
        warnings.push(Problem::new(&settings.origin(path), path, message).to_string());
    }
}
