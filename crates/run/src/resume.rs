//! Continuation of a run: the newest checkpoint that holds and whose run file has what it says; or without any, a new beginning, for which
//! the samples of before are kept.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use plateau_core::model::mesh::Mesh;
use plateau_io::run_file::checkpoint::{self, RunState};
use plateau_io::run_file::{Earlier, Header, RunFile, RunFileError, RunWriter};
use plateau_io::scene::differences;
use plateau_io::scene::schema::{self, Role};
use plateau_io::text::{self, shown_title};

use crate::checkpointer::RunIdentity;
use crate::error::{InputError, RunError};
use crate::options::Observer;

/// Names that are tried.
const MOST: usize = 1000;

/// A run file that has a second name, which goes again unless it is to stay.
pub struct Kept {
    place: PathBuf,
    /// Path that it was moved from, on file systems where a file has one name only.
    moved_from: Option<PathBuf>,
    stays: bool,
}

impl Kept {
    /// Keeps a run file of so many samples as `RUN.before-resume`. Where a file of an earlier beginning of the same run has that name,
    /// the one with more samples is kept; what else has it stays, and another name is taken.
    pub fn of(path: &Path, samples: usize) -> io::Result<Self> {
        for count in 1..=MOST {
            let place = place(path, count);
            match samples_of_same(&place, path) {
                // The name is not new: a file of before holds as much.
                Some(there) if there >= samples => return Ok(Self { place, moved_from: None, stays: true }),
                // All of them are the first of those that are kept now.
                Some(_) => fs::remove_file(&place)?,
                None => {}
            }
            match fs::hard_link(path, &place) {
                Ok(()) => return Ok(Self { place, moved_from: None, stays: false }),
                Err(_) if fs::symlink_metadata(&place).is_ok() => {}
                // Some file systems have no hard links.
                Err(_) => {
                    fs::rename(path, &place)?;
                    return Ok(Self { place, moved_from: Some(path.to_owned()), stays: false });
                }
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }

    /// Lets it stay; where it is.
    pub fn stay(mut self) -> PathBuf {
        self.stays = true;
        self.place.clone()
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        if self.stays {
            return;
        }
        // Nobody is left to tell.
        let _ = match &self.moved_from {
            Some(path) => fs::rename(&self.place, path),
            None => fs::remove_file(&self.place),
        };
    }
}

/// `run.h5.before-resume`, then `run.h5.before-resume-2` and so on.
fn place(path: &Path, count: usize) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".before-resume");
    if count > 1 {
        name.push(format!("-{count}"));
    }
    path.with_file_name(name)
}

/// Samples in a file of the same scene, surfaces and program, which are the same as far as they go; none of another file.
fn samples_of_same(place: &Path, run: &Path) -> Option<usize> {
    if !fs::symlink_metadata(place).is_ok_and(|there| there.is_file()) {
        return None;
    }
    let [there, run] = [RunFile::open(place).ok()?, RunFile::open(run).ok()?];
    let alike = |name: &str| there.attribute(name) == run.attribute(name);
    ["scene", "program", "source_revision", "inputs"].into_iter().all(alike).then(|| there.time().len())
}

/// The states to go on from, the newest first; none if there is no checkpoint.
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
        let trouble = trouble.join("; ");
        let message = format!("{trouble}; without --resume, --force begins again from the beginning");
        return Err(InputError::Refused(message));
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
    Err(refusal(run_file, format_args!("files that it reads have changed: {}", text::list(changed, ", "))))
}

/// Refuses a run file of another scene.
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
        Err(refusal(run_file, format_args!("the scene differs: {}", text::list(keys, ", "))))
    }
}

fn refusal(run_file: &Path, difference: impl std::fmt::Display) -> InputError {
    let path = run_file.display();
    InputError::Refused(format!("{path} cannot be resumed: {difference}; undo that, or begin again without --resume"))
}

/// Goes on with the run file of the first of the states that it has what they say of; its writer and which state it is.
///
/// The file is made anew, so the state gets the image of that one and is written once more before it takes the place of the old
/// one; with the image of the old one, too, for nobody knows which of both a loss of power leaves.
pub fn writer(
    path: &Path,
    header: &Header,
    states: &mut [RunState],
    observer: &mut dyn Observer,
) -> Result<(RunWriter, usize), RunError> {
    if !path.exists() {
        // Else every checkpoint would say so.
        return Err(InputError::not_resumable(path, "is gone, though its checkpoint is there").into());
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
    Err(InputError::Refused(format!("{}; begin again without --resume", refusals.join("; "))).into())
}
