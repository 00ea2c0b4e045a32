//! How a run begins: new, or with what one that was stopped has left.

use std::path::Path;

use plateau_io::checkpoint::{self, RunState};
use plateau_io::run_file::{Header, RunFile, RunFileError, RunWriter, State};
use plateau_io::temporary::Temporary;
use plateau_io::writer::writer_of;

use crate::arguments::RunArguments;
use crate::failure::Failure;
use crate::job::Job;
use crate::keeper::About;
use crate::{message, resume};

/// What a run begins with.
pub(super) struct Beginning {
    /// None in a process that does not lead.
    pub(super) writer: Option<RunWriter>,
    /// What it goes on from.
    pub(super) state: Option<RunState>,
}

impl Beginning {
    /// Makes the run file, or finds out what to go on from and goes on with it; nothing where all is done already, which is
    /// said. All processes of a job do this together.
    ///
    /// # Errors
    /// [`Failure`] when the file cannot be made, or what is there is of another run.
    pub(super) fn of(
        path: &Path,
        header: &Header,
        about: &About,
        arguments: &RunArguments,
        job: &mut Job,
    ) -> Result<Option<Self>, Failure> {
        let extends = arguments.extend_to.is_some();
        let mut states = if arguments.resumes() { resume::states(path, about, extends)? } else { Vec::new() };
        let finished = match states.first() {
            Some(newest) => newest.finished,
            None => arguments.resume && !arguments.force && is_finished(path, about)?,
        };
        let steps: Vec<u64> = states.iter().map(|state| state.run.steps()).collect();
        job.compare(&format!("{finished} {steps:?}"))?;
        if finished && !extends {
            message::note(format_args!("{} is finished; --extend-to TIME goes on beyond its end", path.display()));
            return Ok(None);
        }
        if arguments.resumes() && states.is_empty() {
            message::note("there is no checkpoint yet: begins from the beginning");
        }
        let (writer, place) = if job.leads() { lead(path, header, arguments, &states)? } else { (None, 0) };
        // The first rank has seen which of the states holds.
        let (place, _) = job.sum(place, 0)?;
        let state = (!states.is_empty()).then(|| states.swap_remove(place));
        Ok(Some(Self { writer, state }))
    }
}

/// The writer of the run file, and which of the states it goes on from.
fn lead(
    path: &Path,
    header: &Header,
    arguments: &RunArguments,
    states: &[RunState],
) -> Result<(Option<RunWriter>, usize), Failure> {
    refuse_if_written(path)?;
    for target in [path].into_iter().chain(checkpoint::paths(path).iter().map(AsRef::as_ref)) {
        Temporary::remove_abandoned(target);
    }
    if !states.is_empty() {
        return resume::writer(path, header, states).map(|(writer, place)| (Some(writer), place));
    }
    // What is there is of another run, and stays if the new one cannot begin.
    let others = checkpoint::set_aside(path).map_err(Failure::run)?;
    let writer = RunWriter::create(path, arguments.force || arguments.resumes(), header).map_err(create_failure)?;
    others.discard();
    Ok((Some(writer), 0))
}

/// Whether the run that is to be gone on with has come to its end and left no checkpoint.
fn is_finished(path: &Path, about: &About) -> Result<bool, Failure> {
    if !path.exists() {
        return Ok(false);
    }
    let there = RunFile::open(path).map_err(Failure::input)?;
    if there.state() != State::Finished {
        return Ok(false);
    }
    resume::compare_scenes(path, &there.attribute("scene").unwrap_or_default(), about, false).map(|()| true)
}

/// Refuses to replace, or to go on with, a file that another run is writing.
fn refuse_if_written(path: &Path) -> Result<(), Failure> {
    let Some(process) = writer_of(path) else { return Ok(()) };
    Err(Failure::input(format_args!(
        "{} is being written by process {process}; stop that first, or write elsewhere with -o FILE",
        path.display()
    )))
}

/// Whose fault it is that a run file cannot be made.
fn create_failure(error: RunFileError) -> Failure {
    match error {
        RunFileError::SetUp { .. } | RunFileError::Anew { .. } | RunFileError::Write { .. } => Failure::run(error),
        _ => Failure::input(error),
    }
}
