//! Keys that the format has and this version of the program cannot follow yet.

use super::document::{Entries, Value};
use super::error::Problem;
use super::interpret::Setting;
use super::settings::Settings;

/// Path, whether a value asks for what is not there yet, what to do.
type Later = (&'static str, fn(&Value) -> bool, &'static str);

const LATER: &[Later] = &[
    (
        "numerics.time_acceleration",
        |value| *value == Value::Table,
        "this version cannot choose the acceleration itself: give a number",
    ),
    (
        "pin.base.image",
        |_| true,
        "this version does not read images: give file with a map in HDF5, synthetic, or uniform",
    ),
    ("disc.surface.synthetic.skewness", |_| true, ONLY_GAUSSIAN),
    ("disc.surface.synthetic.kurtosis", |_| true, ONLY_GAUSSIAN),
    ("pin.surface.synthetic.skewness", |_| true, ONLY_GAUSSIAN),
    ("pin.surface.synthetic.kurtosis", |_| true, ONLY_GAUSSIAN),
];
const ONLY_GAUSSIAN: &str =
    "this version makes Gaussian heights only: leave the key out, or give file with heights of your own";

/// Refuses what would silently not be done.
pub(super) fn refuse(entries: &Entries, problems: &mut Vec<Problem>) {
    for (path, asks, advice) in LATER {
        if let Some(entry) = entries.get(*path)
            && asks(&entry.value)
        {
            problems.push(Problem::new(&entry.origin, path, *advice));
        }
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
