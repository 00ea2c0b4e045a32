//! What a run goes on from: the newest checkpoint that holds and whose run file has what it says.

use std::path::Path;

use plateau_core::model::mesh::Mesh;
use plateau_io::brief;
use plateau_io::checkpoint::{self, RunState};
use plateau_io::run_file::{Earlier, Header, RunFileError, RunWriter};
use plateau_io::scene::differences;
use plateau_io::scene::schema::{self, Role};
use plateau_io::text::shown_title;

use crate::checkpointer::RunIdentity;
use crate::error::{InputError, RunError};
use crate::observer::Observer;

/// The states to go on from, the newest first; none if there is no checkpoint.
///
/// # Errors
/// [`InputError`] when there are some, but none of them holds or they are of another run.
pub fn states(
    run_file: &Path,
    mesh: &Mesh,
    identity: &RunIdentity,
    extends: bool,
    observer: &mut dyn Observer,
) -> Result<Vec<RunState>, InputError> {
    let (mut states, mut trouble) = (Vec::new(), Vec::new());
    for path in checkpoint::paths(run_file) {
        match checkpoint::read::<RunState>(&path, Some(checkpoint::ample_size(mesh))) {
            Ok(state) => states.extend(state),
            Err(error) => {
                observer.warning(&error);
                trouble.push(error.to_string());
            }
        }
    }
    if states.is_empty() && !trouble.is_empty() {
        return Err(InputError::NoCheckpoint(trouble));
    }
    let mut states = states.into_iter();
    let Some(newest) = states.next() else { return Ok(Vec::new()) };
    compare(run_file, &newest, identity, extends)?;
    // The one before may be of the end that was extended since.
    let before = states.filter(|state| compare(run_file, state, identity, extends).is_ok());
    Ok([newest].into_iter().chain(before).collect())
}

/// Refuses a state of another run.
fn compare(run_file: &Path, state: &RunState, identity: &RunIdentity, extends: bool) -> Result<(), InputError> {
    if state.program != identity.program {
        let what = format_args!("it was begun by {}, this is {}", state.program, identity.program);
        return Err(refusal(run_file, what));
    }
    let engine = state.simulation.run.engine();
    if engine != identity.engine {
        let what = format_args!("it was begun with --engine {engine}, this is {}", identity.engine);
        return Err(refusal(run_file, what));
    }
    compare_scenes(run_file, &state.scene, identity, extends)?;
    let changed: Vec<String> = identity
        .inputs
        .iter()
        .zip(&state.inputs)
        .filter(|((_, now), (_, then))| now != then)
        .map(|((path, _), _)| path.display().to_string())
        .collect();
    if changed.is_empty() && identity.inputs.len() == state.inputs.len() {
        return Ok(());
    }
    Err(refusal(run_file, format_args!("files that it reads have changed: {}", brief::list(changed, ", "))))
}

/// Refuses a run file of another scene.
///
/// # Errors
/// [`InputError`], which names the keys that differ.
pub fn compare_scenes(run_file: &Path, scene: &str, identity: &RunIdentity, extends: bool) -> Result<(), InputError> {
    let now = identity.scene.parse().unwrap_or_default();
    let free = |key: &str| match schema::role(key) {
        Role::Nothing => true,
        Role::Length | Role::MapTimes => extends,
        _ => false,
    };
    let keys: Vec<String> = differences(scene, &now)
        .into_iter()
        .filter(|difference| !free(&difference.key))
        .map(|difference| {
            let value =
                |value: Option<String>| value.map_or_else(|| "nothing".into(), |it| shown_title(&it).into_owned());
            format!("{} was {}, is {}", difference.key, value(difference.first), value(difference.second))
        })
        .collect();
    if keys.is_empty() {
        Ok(())
    } else {
        Err(refusal(run_file, format_args!("the scene differs: {}", brief::list(keys, ", "))))
    }
}

fn refusal(run_file: &Path, difference: impl std::fmt::Display) -> InputError {
    InputError::OtherRun { path: run_file.to_owned(), difference: difference.to_string() }
}

/// Goes on with the run file of the first of the states that it has what they say of; its writer and which state it is.
///
/// The file is made anew, so the state gets the image of that one and is written once more before it takes the place of the old
/// one; with the image of the old one, too, for nobody knows which of both a loss of power leaves.
///
/// # Errors
/// [`InputError`] when it has it of none, [`RunError::Failed`] when the file cannot be written anew.
pub fn writer(
    path: &Path,
    header: &Header,
    states: &mut [RunState],
    observer: &mut dyn Observer,
) -> Result<(RunWriter, usize), RunError> {
    if !path.exists() {
        // Else every checkpoint would say so.
        return Err(InputError::NotResumable {
            path: path.to_owned(),
            what: "is gone, though its checkpoint is there".into(),
        }
        .into());
    }
    let mut refusals = Vec::new();
    for (place, state) in states.iter_mut().enumerate() {
        let earlier = Earlier {
            samples: state.samples,
            snapshots: state.snapshots,
            wall_time: std::time::Duration::try_from_secs_f64(state.wall_time).unwrap_or_default(),
        };
        state.images.retain(|image| image.is_of(path));
        let images = state.images.clone();
        let keep = |image| {
            state.images.push(image);
            if let Err(error) = checkpoint::write(path, state) {
                observer.warning(&format_args!("cannot write a checkpoint: {error}; the one before still holds"));
            }
        };
        match RunWriter::resume(path, header, earlier, &images, keep) {
            Ok(writer) => return Ok((writer, place)),
            Err(error @ RunFileError::Earlier { .. }) => {
                let step = state.simulation.run.steps();
                observer.warning(&format_args!("{error}; the checkpoint of step {step} is passed over"));
                refusals.push(error.to_string());
            }
            Err(error) => return Err(error.into()),
        }
    }
    Err(InputError::NoneFits(refusals).into())
}
