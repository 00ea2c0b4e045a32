//! The reference: a run of the same scene, made here or read from a run file.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use plateau_core::model::parameters::Integrator;
use plateau_core::observe::{Map, MapValues};
use plateau_io::run_file::{InputFile, ReadError, RunFile, State};
use plateau_io::scene::schema::{self, Role};
use plateau_io::scene::{Difference, Scene, differences};

use super::comparison::{End, Heights, Outcome};
use super::error::ReferenceError;
use super::history::History;
use super::ladder::integrator_name;

/// What every other run is held against.
#[derive(Debug, Clone)]
pub struct Reference {
    /// Its time acceleration.
    pub time_acceleration: f64,
    /// What is kept of it.
    pub outcome: Outcome,
    /// Where it comes from.
    pub provenance: Provenance,
}

/// How far a reference is from the model itself, `time_acceleration` = 1: an estimate from the first windows, the opening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnError {
    /// Error of the mean contact areas of the opening against the model, relative, root mean square.
    pub opening: f64,
    /// How many times as large as in the opening errors are over the whole run.
    pub growth: f64,
    /// Where the opening ends, s; 0 where the reference is the model.
    pub end: f64,
    /// Whether it is known to come later: on smooth discs, on which no run that chooses its acceleration has one.
    pub comes_late: bool,
}

impl OwnError {
    /// Of the model itself.
    pub const NONE: Self = Self { opening: 0.0, growth: 1.0, end: 0.0, comes_late: false };

    /// Error of the mean contact areas over the whole run, about.
    pub fn contact_area(&self) -> f64 {
        self.opening * self.growth
    }

    /// The same with the growth that the error of the scene's own run shows, against the reference: `opening` in the opening
    /// and `whole` over the whole run. Errors are not taken to shrink; where one of the two is not known there is no growth.
    #[must_use]
    pub fn growing(self, opening: f64, whole: f64) -> Self {
        let growth = whole / opening;
        Self { growth: if growth.is_finite() { growth.max(1.0) } else { 1.0 }, ..self }
    }
}

/// Where a reference comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Provenance {
    /// The run file; none for a run made here.
    pub file: Option<InputFile>,
    /// Program and version that made it.
    pub program: String,
    /// Revision of the program's source.
    pub source_revision: String,
    /// Machine.
    pub host: String,
    /// Workers.
    pub workers: u64,
    /// When it was started.
    pub start_time: String,
}

/// A reference of a run file, and how far its samples are apart.
#[derive(Debug)]
pub struct ReadReference {
    /// The reference.
    pub reference: Reference,
    /// Its integrator, which may be another than the scene's.
    pub integrator: Integrator,
    /// Longest time between two samples, s.
    pub sample_every: f64,
    /// What it did not record.
    pub missing: Vec<String>,
}

/// Series that a reference must have.
const NEEDED: [&str; 2] = ["contact_area_integral", "filled_fraction"];
/// How many different keys a message names.
const MOST_KEYS: usize = 5;

/// Reads the reference of a scene; `inputs` are the surface files that the scene reads, with their digests.
///
/// # Errors
/// [`ReferenceError`] when it is no finished run with samples of this scene.
pub fn read(path: &Path, scene: &Scene, inputs: &[(PathBuf, String)]) -> Result<ReadReference, ReferenceError> {
    let run = RunFile::open(path)?;
    if run.state() != State::Finished {
        return Err(ReferenceError::NotFinished { path: path.to_owned(), state: run.state().name() });
    }
    refuse_another_scene(&run, scene, inputs)?;
    let numerics = |key: &str| run.scene().get("numerics").and_then(|numerics| numerics.get(key));
    let time_acceleration =
        numerics("time_acceleration").and_then(|value| value.as_float().or(value.as_integer().map(|m| m as f64)));
    let Some(time_acceleration) = time_acceleration else {
        return Err(ReferenceError::NoTimeAcceleration { path: path.to_owned() });
    };
    let integrator = numerics("integrator").and_then(|value| value.as_str());
    let integrator = [Integrator::Explicit, Integrator::Exponential]
        .into_iter()
        .find(|known| integrator == Some(integrator_name(*known)))
        .unwrap_or(scene.parameters.integrator);
    let mut parameters = scene.parameters.clone();
    parameters.time_acceleration = time_acceleration;
    let end = run.time().last().copied().unwrap_or(0.0);
    // A run ends at its duration or up to a step later.
    if (end - scene.duration).abs() > 1.01 * parameters.step_time() {
        return Err(ReferenceError::OtherEnd { path: path.to_owned(), end, expected: scene.duration });
    }
    let mut missing = Vec::new();
    let outcome = outcome(&run, parameters.steps_of(scene.duration), &mut missing)?;
    let sample_every = [0.0].iter().chain(run.time()).zip(run.time()).map(|(one, next)| next - one).fold(0.0, f64::max);
    let file = InputFile::read(path).map_err(|error| ReferenceError::File { path: path.to_owned(), error })?;
    let text = |name: &str| run.attribute(name).unwrap_or_default();
    let provenance = Provenance {
        file: Some(file),
        program: text("program"),
        source_revision: text("source_revision"),
        host: text("host"),
        workers: run.number("workers").unwrap_or(0.0) as u64,
        start_time: text("start_time"),
    };
    let reference = Reference { time_acceleration, outcome, provenance };
    Ok(ReadReference { reference, integrator, sample_every, missing })
}

fn outcome(run: &RunFile, steps: u64, missing: &mut Vec<String>) -> Result<Outcome, ReferenceError> {
    let shown = run.path().display();
    let mut needed = Vec::new();
    for name in NEEDED {
        match run.values(name)? {
            Some(values) => needed.push(values),
            None => return Err(ReferenceError::NoSeries { path: run.path().to_owned(), name }),
        }
    }
    let mut history = History::start();
    for (index, time) in run.time().iter().enumerate() {
        history.record(*time, needed[0][index], needed[1][index]);
    }
    let series = |name: &str| run.values(name).map(Option::unwrap_or_default);
    let last = |name: &str| series(name).map(|values: Vec<f64>| values.last().copied().unwrap_or(f64::NAN));
    let end = End {
        filled: last("filled_fraction")?,
        worn: last("worn_pin")? + last("worn_resin")? + last("worn_disc")?,
        emitted: last("emitted")?,
        disc_secondary: last("disc_secondary")?,
        pin_secondary: last("pin_secondary")?,
        load_residual: series("load_residual")?.into_iter().fold(f64::NAN, f64::max),
        balance_residual: last("balance_residual")?,
    };
    let heights = Heights { disc: last_map(run, Map::DiscHeight)?, pin: last_map(run, Map::PinHeight)? };
    for (heights, body) in [(&heights.disc, "disc"), (&heights.pin, "pin")] {
        if heights.is_none() {
            missing.push(format!("the reference {shown} has no map of the {body}'s heights at its end: not compared"));
        }
    }
    // A file that a run did not write may hold no number.
    let wall_time = run.number("wall_time").filter(|time| time.is_finite());
    Ok(Outcome { steps, wall_time, history, end, heights })
}

/// A map of heights at the end of a run, if there is one.
fn last_map(run: &RunFile, map: Map) -> Result<Option<Vec<f64>>, ReadError> {
    let (Some(time), Some(end), Some(index)) =
        (run.map_time().last(), run.time().last(), run.map_time().len().checked_sub(1))
    else {
        return Ok(None);
    };
    if time != end {
        return Ok(None);
    }
    let values = run.map(map, index)?;
    Ok(values.and_then(|values| match values {
        MapValues::Float(heights) => Some(heights),
        MapValues::Status(_) => None,
    }))
}

/// Refuses a run whose scene differs in more than numerics and output.
fn refuse_another_scene(run: &RunFile, scene: &Scene, inputs: &[(PathBuf, String)]) -> Result<(), ReferenceError> {
    let read = run.inputs();
    let digest_there = |path: &str| read.iter().find(|input| input.path == path).map(|input| input.sha256.as_str());
    let digest_here =
        |path: &str| inputs.iter().find(|(input, _)| input.as_os_str() == path).map(|(_, sha256)| sha256.as_str());
    let plain = |value: &Option<String>| value.as_deref().unwrap_or_default().trim_matches(['"', '\'']).to_owned();
    let mut different: Vec<Difference> = differences(&scene.resolved, run.scene());
    // A file may have another place and the same content.
    different.retain(|Difference { key, first, second }| {
        let same_content = schema::is_input(key)
            && digest_here(&plain(first)).is_some_and(|digest| digest_there(&plain(second)) == Some(digest));
        // How long runs are is compared by their ends.
        schema::role(key) == Role::Physics && !same_content
    });
    let mut message = String::new();
    for Difference { key, first, second } in different.iter().take(MOST_KEYS) {
        let shown = |value: &Option<String>| value.clone().unwrap_or_else(|| "not given".to_owned());
        // Writing to a String cannot fail.
        let _ = write!(message, "\n  {key}: {} there, {} here", shown(second), shown(first));
    }
    if different.len() > MOST_KEYS {
        let _ = write!(message, "\n  and {} other keys", different.len() - MOST_KEYS);
    }
    for (path, sha256) in inputs {
        let changed = digest_there(&path.to_string_lossy()).is_some_and(|there| there != sha256);
        if changed {
            let _ = write!(message, "\n  the content of {} has changed since", path.display());
        }
    }
    if message.is_empty() {
        return Ok(());
    }
    Err(ReferenceError::OtherScene { path: run.path().to_owned(), differences: message })
}

#[cfg(test)]
mod tests {
    use super::OwnError;

    #[test]
    fn the_own_error_grows_as_the_error_of_the_scene_does() {
        let own = OwnError { opening: 2e-5, growth: 1.0, end: 5.0, comes_late: false };
        // The scene's error is 0.01 % in the opening and 0.2 % in the end: 20 times as large, and so is the reference's.
        assert!((own.growing(1e-4, 2e-3).contact_area() - 4e-4).abs() < 1e-18);
        for (opening, whole) in [(2e-3, 1e-3), (0.0, 1e-3), (0.0, 0.0), (1e-4, f64::NAN)] {
            assert_eq!(own.growing(opening, whole), own, "{opening}, {whole}");
        }
        assert_eq!(OwnError::NONE.growing(1e-4, 2e-3).contact_area(), 0.0);
    }
}
