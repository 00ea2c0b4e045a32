//! How a run begins: new, or with what one that was stopped has left.

use std::path::Path;

use plateau_io::checkpoint::{self, RunState};
use plateau_io::claim::{Claim, ClaimError};
use plateau_io::process::writer_of;
use plateau_io::run_file::{Damage, Header, RunFile, RunWriter, State, verify};
use plateau_io::temporary::Temporary;

use crate::arguments::RunArguments;
use crate::failure::Failure;
use crate::job::Job;
use crate::keeper::About;
use crate::{message, number, resume};

/// What a run begins with.
pub(super) struct Beginning {
    /// To be held until nothing more is written. None in a process that does not lead.
    pub(super) claim: Option<Claim>,
    /// None in a process that does not lead.
    pub(super) writer: Option<RunWriter>,
    /// What it goes on from.
    pub(super) state: Option<RunState>,
}

impl Beginning {
    /// Claims the run file, then makes it, or finds out what to go on from and goes on with it; nothing where all is done
    /// already, which is said. All processes of a job do this together.
    ///
    /// # Errors
    /// [`Failure`] when the file cannot be made, or what is there is of another run.
    pub(super) fn of(
        path: &Path,
        header: &Header,
        about: &About,
        arguments: &RunArguments,
        end: f64,
        job: &mut Job,
    ) -> Result<Option<Self>, Failure> {
        let claim = if job.leads() { Some(Claim::of(path).map_err(not_claimed)?) } else { None };
        // No process looks at what is there before that is done.
        job.sum(0, 0)?;
        if job.leads() {
            refuse_if_written(path)?;
            checkpoint::refuse_foreign(path, arguments.force).map_err(Failure::input)?;
            for target in [path].into_iter().chain(checkpoint::paths(path).iter().map(AsRef::as_ref)) {
                Temporary::remove_abandoned(target);
            }
        }
        let extends = arguments.extend_to.is_some();
        let mut states = if arguments.resumes() { resume::states(path, about, extends)? } else { Vec::new() };
        let there = if arguments.resumes() { look(path, about, arguments)? } else { None };
        let is_finished = there.as_ref().is_some_and(|there| there.state == State::Finished);
        let finished = match states.first() {
            // What a checkpoint says counts only for the file that it was left beside.
            Some(newest) if newest.finished => match &there {
                None if !arguments.force => {
                    return Err(refused(path, "is gone, though its checkpoint says that the run is finished"));
                }
                Some(there) if is_finished && there.holds == [newest.samples, newest.snapshots] => {
                    !extends || has_come_to(path, newest, end)?
                }
                _ => false,
            },
            Some(_) => false,
            None if is_finished && extends => {
                return Err(refused(path, "is finished and has no checkpoint to go on from"));
            }
            None => is_finished,
        };
        let steps: Vec<u64> = states.iter().map(|state| state.run.steps()).collect();
        job.compare(&format!("{finished} {steps:?}"))?;
        if finished {
            if job.leads() {
                check_that_it_is_whole(path)?;
            }
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
        Ok(Some(Self { claim, writer, state }))
    }
}

/// The writer of the run file, and which of the states it goes on from.
fn lead(
    path: &Path,
    header: &Header,
    arguments: &RunArguments,
    states: &[RunState],
) -> Result<(Option<RunWriter>, usize), Failure> {
    if !states.is_empty() {
        return resume::writer(path, header, states).map(|(writer, place)| (Some(writer), place));
    }
    // What is there is of another run, and stays if the new one cannot begin.
    let others = checkpoint::set_aside(path).map_err(|error| {
        let path = path.display();
        Failure::input(format_args!("cannot replace the checkpoints of {path}: {error}; write elsewhere with -o FILE"))
    })?;
    let writer = RunWriter::create(path, arguments.force || arguments.resumes(), header).map_err(resume::not_made)?;
    others.discard();
    Ok((Some(writer), 0))
}

/// Whether a finished run that is to go on to a time has come to just that.
fn has_come_to(path: &Path, state: &RunState, end: f64) -> Result<bool, Failure> {
    let time = state.run.time();
    // The last step may go beyond the time that is asked for.
    let step = time / state.run.steps().max(1) as f64;
    if time > end + 1.5 * step {
        let (path, time) = (path.display(), number::short(time));
        return Err(Failure::input(format_args!(
            "--extend-to: {path} has come to {time} s already; give a later time"
        )));
    }
    Ok(time > end - 0.5 * step)
}

fn refused(path: &Path, what: &str) -> Failure {
    Failure::input(format_args!("{} {what}; without --resume, --force begins again", path.display()))
}

/// The file that is to be gone on with.
struct There {
    state: State,
    /// Samples, and moments of which there are maps.
    holds: [usize; 2],
}

/// Looks at the file that is to be gone on with, if there is one; it must be of this run, unless it may be replaced.
fn look(path: &Path, about: &About, arguments: &RunArguments) -> Result<Option<There>, Failure> {
    if !path.exists() {
        return Ok(None);
    }
    let there = match RunFile::open(path) {
        Err(_) if arguments.force => return Ok(None),
        there => {
            there.map_err(|error| Failure::input(format_args!("{error}; without --resume, --force begins again")))?
        }
    };
    let scene = there.attribute("scene").unwrap_or_default();
    match resume::compare_scenes(path, &scene, about, arguments.extend_to.is_some()) {
        Err(_) if arguments.force => Ok(None),
        compared => {
            compared.map(|()| Some(There { state: there.state(), holds: [there.time().len(), there.map_time().len()] }))
        }
    }
}

/// Nothing more will be done about a finished file: it must hold what was written.
fn check_that_it_is_whole(path: &Path) -> Result<(), Failure> {
    let verification = verify(path).map_err(Failure::input)?;
    let Some(Damage { place, problem }) = verification.damage.first() else { return Ok(()) };
    Err(refused(path, &format!("is finished, and damaged: {place}: {problem}")))
}

/// Whose fault it is that a run file is not claimed.
pub(super) fn not_claimed(error: ClaimError) -> Failure {
    if error.lacks_space() { Failure::run(error) } else { Failure::input(error) }
}

/// Refuses a file that another program is writing, or an earlier version of this one, which made no locks.
fn refuse_if_written(path: &Path) -> Result<(), Failure> {
    let Some(process) = writer_of(path) else { return Ok(()) };
    Err(Failure::input(format_args!(
        "{} is being written by process {process}; stop that first, or write elsewhere with -o FILE",
        path.display()
    )))
}
