//! Length of the runs of a study, and the part of a run that `mean = "last tenth"` is a mean over: more than a tenth where that has fewer
//! than ten simulated revolutions.

use plateau_core::observe::window_mean::LEAST_REVOLUTIONS;
use plateau_io::scene::Scene;
use plateau_io::study::Study;
use plateau_io::study::response::Question;
use plateau_io::{number, text};

use super::observer::SweepObserver;

/// Length of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunLength {
    /// Its duration, s.
    pub duration: f64,
    /// Its simulated revolutions; none where it chooses its time acceleration as it goes.
    pub revolutions: Option<f64>,
}

impl RunLength {
    /// That of a scene: a step takes the pin on by a column of the disc.
    pub fn of(scene: &Scene) -> Self {
        let revolutions = scene.steps as f64 / scene.parameters.mesh.disc_columns() as f64;
        Self { duration: scene.duration, revolutions: scene.adaptive.is_none().then_some(revolutions) }
    }

    /// Over what part of the run a mean over its last tenth is taken, at the end of it.
    pub fn part(&self) -> f64 {
        self.revolutions.map_or(0.1, |turns| (LEAST_REVOLUTIONS / turns).clamp(0.1, 1.0))
    }
}

/// A time in words.
pub(super) fn seconds(time: f64) -> String {
    format!("{} s", number::rounded(time, 6))
}

/// Says of responses that ask for the last tenth over what they are a mean, where that is more.
pub fn note_short_tenths(study: &Study, lengths: &[RunLength], observer: &dyn SweepObserver) {
    let asks = study.responses.iter().filter(|response| response.question == Question::MeanOfLastTenth);
    let names: Vec<String> = asks.map(|response| format!("\"{}\"", response.name)).collect();
    if let (false, Some(what)) = (names.is_empty(), longer(lengths)) {
        let responses = if names.len() == 1 { "response" } else { "responses" };
        observer.note(&format_args!("note: {}: {responses} {}: {what}", study.path.display(), text::list(names, ", ")));
    }
}

/// In words, of the run with the fewest simulated revolutions.
fn longer(lengths: &[RunLength]) -> Option<String> {
    let longer = lengths.iter().filter(|length| length.part() > 0.1 * (1.0 + 1e-9));
    let (count, most) = (longer.clone().count(), longer.max_by(|one, other| one.part().total_cmp(&other.part()))?);
    let turns = most.revolutions.unwrap_or_default();
    let (part, whole) = (seconds(most.part() * most.duration), seconds(most.duration));
    let over = if most.part() < 1.0 { format!("the last {part} of {whole}") } else { format!("all of the {whole}") };
    Some(format!(
        "a tenth of a run has fewer than {LEAST_REVOLUTIONS} simulated revolutions in {count} of {}, so the mean is over more: with \
         {} revolutions in all it is over {over}; for a mean over a tenth take longer runs, or a smaller time_acceleration",
        number::count(lengths.len(), "run"),
        number::rounded(turns, 2)
    ))
}

#[cfg(test)]
#[path = "../../tests/unit/sweep/run_length.rs"]
mod tests;
