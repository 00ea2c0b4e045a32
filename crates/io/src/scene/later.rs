//! Keys that the format has and this version of the program cannot follow yet.

use super::error::Problem;
use super::interpret::Setting;
use super::settings::Settings;

/// Warns of what is not done but changes no result.
pub(super) fn warn(settings: &Settings, warnings: &mut Vec<String>) {
    let path = "output.checkpoint_every";
    if let Some(Setting::Number(_)) = settings.get(path) {
        let message = "this version writes no checkpoints: a run that is interrupted starts again from the beginning";
        warnings.push(Problem::new(&settings.origin(path), path, message).to_string());
    }
}
