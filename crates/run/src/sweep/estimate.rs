//! Length and cost of the runs of a study, before any is made; and the part of a run that `mean = "last tenth"` is a mean over: more than a
//! tenth where that has fewer than ten simulated revolutions.

use std::time::Duration;

use plateau_core::observe::window_mean::LEAST_REVOLUTIONS;
use plateau_core::simulation::{Execution, Simulation};
use plateau_io::scene::{Scene, memory_estimate};
use plateau_io::study::Study;
use plateau_io::study::plan::Plan;
use plateau_io::study::response::Question;
use plateau_io::{number, surface, text};

use super::resolved::{refuse_without_scene, run_in_words};
use super::warnings::{SceneWarnings, of_surfaces};
use super::{SweepError, SweepObserver};
use crate::execution::time_per_step;

/// Runs whose steps are counted.
const COUNTED: usize = 64;
/// Runs whose first steps are timed.
const TIMED: usize = 3;
/// Time for which they are tried.
const TRIAL: Duration = Duration::from_millis(150);

/// Cost of one run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Estimate {
    /// Memory of the largest run, bytes.
    pub memory: u64,
    /// Wall time of a run, mean, s.
    pub mean_time: f64,
    /// Wall time of the longest, s.
    pub longest_time: f64,
    /// Warnings of the surfaces of the runs that were tried.
    pub warnings: SceneWarnings,
}

impl Estimate {
    /// Looks at some of the runs.
    pub fn of(plan: &Plan) -> Result<Self, SweepError> {
        refuse_without_scene(plan)?;
        let (mut per_cell, mut warnings) = (0.0_f64, SceneWarnings::default());
        for number in spread(plan.runs(), TIMED) {
            let scene = scene(plan, number)?;
            let start = std::time::Instant::now();
            let loaded = surface::load(&scene).map_err(SweepError::input)?;
            let making = start.elapsed().as_secs_f64();
            warnings.add(of_surfaces(&scene, &loaded));
            let surfaces = loaded.surfaces;
            let execution = Execution { workers: 1, ..Execution::default() };
            let mut simulation =
                Simulation::with_execution(scene.parameters.clone(), surfaces, execution).map_err(SweepError::input)?;
            let step = time_per_step(&mut simulation, scene.steps, TRIAL).map_err(SweepError::failed)?;
            // Surfaces are a part of the run that does not grow with its steps.
            let steps = scene.steps.max(1) as f64;
            per_cell = per_cell.max((step + making / steps) / scene.parameters.mesh.pin_cells() as f64);
        }
        let (mut memory, mut times) = (0, Vec::new());
        for number in spread(plan.runs(), COUNTED) {
            let scene = scene(plan, number)?;
            memory = memory.max(memory_estimate(&scene));
            times.push(scene.steps as f64 * scene.parameters.mesh.pin_cells() as f64 * per_cell);
        }
        let mean_time = times.iter().sum::<f64>() / times.len().max(1) as f64;
        Ok(Self { memory, mean_time, longest_time: times.iter().copied().fold(0.0, f64::max), warnings })
    }
}

/// The scene of a run.
fn scene(plan: &Plan, number: usize) -> Result<Scene, SweepError> {
    let failed = |error| SweepError::Input(format!("{}:\n{error}", run_in_words(plan, number)));
    plan.scene(&plan.run(number)).map_err(failed)
}

/// Some of so many numbers from 1 on, evenly spread, with the first and the last.
fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let taken = most.min(count);
    (0..taken).map(move |at| if taken == 1 { 1 } else { 1 + at * (count - 1) / (taken - 1) })
}

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
#[path = "../../tests/unit/sweep/estimate.rs"]
mod tests;

#[cfg(test)]
#[path = "../../tests/unit/sweep/run_length.rs"]
mod run_length_tests;
