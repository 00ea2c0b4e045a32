//! What a run goes on from: the newest checkpoint that holds and whose run file has what it says.

use std::path::Path;

use plateau_io::checkpoint::{self, RunState};
use plateau_io::run_file::{Earlier, Header, RunFileError, RunWriter};
use plateau_io::scene::differences;
use plateau_io::scene::schema::{self, Role};

use crate::failure::Failure;
use crate::keeper::About;
use crate::message;

/// The states to go on from, the newest first; none if there is no checkpoint.
///
/// # Errors
/// [`Failure::Input`] when there are some, but none of them holds or they are of another run.
pub fn states(run_file: &Path, about: &About, extends: bool) -> Result<Vec<RunState>, Failure> {
    let (mut states, mut trouble) = (Vec::new(), Vec::new());
    for path in checkpoint::paths(run_file) {
        match checkpoint::read::<RunState>(&path) {
            Ok(state) => states.extend(state),
            Err(error) => {
                message::warning(&error);
                trouble.push(error.to_string());
            }
        }
    }
    if states.is_empty() && !trouble.is_empty() {
        return Err(Failure::input(format_args!(
            "{}; without --resume, --force begins again from the beginning",
            trouble.join("; ")
        )));
    }
    let mut states = states.into_iter();
    let Some(newest) = states.next() else { return Ok(Vec::new()) };
    compare(run_file, &newest, about, extends)?;
    // The one before may be of the end that was extended since.
    let before = states.filter(|state| compare(run_file, state, about, extends).is_ok());
    Ok([newest].into_iter().chain(before).collect())
}

/// Refuses a state of another run.
fn compare(run_file: &Path, state: &RunState, about: &About, extends: bool) -> Result<(), Failure> {
    if state.program != about.program {
        let what = format_args!("it was begun by {}, this is {}", state.program, about.program);
        return Err(refusal(run_file, what));
    }
    let engine = state.run.engine();
    if engine != about.engine {
        let what = format_args!("it was begun with --engine {engine}, this is {}", about.engine);
        return Err(refusal(run_file, what));
    }
    compare_scenes(run_file, &state.scene, about, extends)?;
    let changed: Vec<String> = about
        .inputs
        .iter()
        .zip(&state.inputs)
        .filter(|((_, now), (_, then))| now != then)
        .map(|((path, _), _)| path.display().to_string())
        .collect();
    if changed.is_empty() && about.inputs.len() == state.inputs.len() {
        return Ok(());
    }
    Err(refusal(run_file, format_args!("files that it reads have changed: {}", changed.join(", "))))
}

/// Refuses a run file of another scene.
///
/// # Errors
/// [`Failure::Input`], which names the keys that differ.
pub fn compare_scenes(run_file: &Path, scene: &str, about: &About, extends: bool) -> Result<(), Failure> {
    let now = about.scene.parse().unwrap_or_default();
    let free = |key: &str| match schema::role(key) {
        Role::Nothing => true,
        Role::Length | Role::MapTimes => extends,
        _ => false,
    };
    let keys: Vec<String> = differences(scene, &now)
        .into_iter()
        .filter(|difference| !free(&difference.key))
        .map(|difference| {
            let value = |value: Option<String>| value.unwrap_or_else(|| "nothing".into());
            format!("{} was {}, is {}", difference.key, value(difference.first), value(difference.second))
        })
        .collect();
    if keys.is_empty() {
        Ok(())
    } else {
        Err(refusal(run_file, format_args!("the scene differs: {}", keys.join(", "))))
    }
}

fn refusal(run_file: &Path, what: impl std::fmt::Display) -> Failure {
    let run_file = run_file.display();
    Failure::input(format_args!("{run_file} cannot be resumed: {what}; undo that, or begin again without --resume"))
}

/// Goes on with the run file of the first of the states that it has what they say of; its writer and which state it is.
///
/// # Errors
/// [`Failure::Input`] when it has it of none.
pub fn writer(path: &Path, header: &Header, states: &[RunState]) -> Result<(RunWriter, usize), Failure> {
    let mut refusals = Vec::new();
    for (place, state) in states.iter().enumerate() {
        let earlier = Earlier {
            samples: state.samples,
            snapshots: state.snapshots,
            wall_time: std::time::Duration::try_from_secs_f64(state.wall_time).unwrap_or_default(),
        };
        match RunWriter::resume(path, header, earlier) {
            Ok(writer) => return Ok((writer, place)),
            Err(error @ RunFileError::Earlier { .. }) => {
                message::warning(format_args!("{error}; the checkpoint of step {} is passed over", state.run.steps()));
                refusals.push(error.to_string());
            }
            Err(error) => return Err(not_made(error)),
        }
    }
    Err(Failure::input(format_args!("{}; begin again without --resume", refusals.join("; "))))
}

/// Whose fault it is that a run file cannot be made, new or anew.
pub fn not_made(error: RunFileError) -> Failure {
    match error {
        RunFileError::SetUp { .. } | RunFileError::Anew { .. } | RunFileError::Write { .. } => Failure::run(error),
        _ => Failure::input(error),
    }
}
