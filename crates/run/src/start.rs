//! The start of a run, or its continuation from what one that was stopped has left: from the newest checkpoint that holds and whose run
//! file has what it says; or without any, a new beginning, for which the samples of before are kept.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use plateau_io::claim::Claim;
use plateau_io::number;
use plateau_io::process::{Writer, writer_of};
use plateau_io::run_file::checkpoint::{self, RunState};
use plateau_io::run_file::{
    Damage, Earlier, Header, ReadError, RunFile, RunFileError, RunWriter, State, keep, names_beside, verify,
};
use plateau_io::scene::differences;
use plateau_io::scene::schema::{self, Role};
use plateau_io::temporary::Temporary;
use plateau_io::text::{self, shown_title};

use crate::error::{InputError, RunError};
use crate::job::Job;
use crate::options::{Observer, RunOptions, StartMode};
use crate::recorder::RunIdentity;

/// Request to begin a run, or to go on with it.
pub struct Request<'a> {
    /// The run file.
    pub path: &'a Path,
    pub header: &'a Header,
    pub identity: &'a RunIdentity,
    /// Tells whether it begins or goes on, and what may be replaced.
    pub options: &'a RunOptions,
    /// Physical time at the end of its last step, s.
    pub end: f64,
}

/// Start of a run.
pub struct Start {
    /// To be held until nothing more is written. None in a process that does not lead.
    pub claim: Option<Claim>,
    /// None in a process that does not lead.
    pub writer: Option<RunWriter>,
    /// State from which it continues.
    pub state: Option<RunState>,
}

impl Request<'_> {
    /// Claims the run file, then makes it, or finds out what to go on from and goes on with it; nothing where all is done
    /// already, which is said. All processes of a job do this together.
    pub fn start(&self, job: &mut Job, observer: &dyn Observer) -> Result<Option<Start>, RunError> {
        let Self { path, options, .. } = *self;
        let claim = if job.leads() { Some(Claim::of(path)?) } else { None };
        // No process looks at what is there before that is done.
        job.sum(0, 0)?;
        if job.leads() {
            self.clear_away()?;
        }
        let resumes = options.mode.resumes();
        let mut states = if resumes { self.states(observer)? } else { Vec::new() };
        let there = if resumes { self.look(&states, claim.as_ref(), observer)? } else { None };
        let finished = self.is_finished(states.first(), there.as_ref())?;
        let steps: Vec<u64> = states.iter().map(|state| state.simulation.run.steps()).collect();
        job.compare(&format!("{finished} {steps:?}"))?;
        if finished {
            if job.leads() {
                self.check_that_it_is_whole()?;
            }
            observer.note(&format_args!("{} is finished; --extend-to TIME goes on beyond its end", path.display()));
            return Ok(None);
        }
        if resumes && states.is_empty() {
            observer.note(&"there is no checkpoint yet: begins from the beginning");
        }
        let samples = there.map_or(0, |there| there.holds[0]);
        let (writer, place) = if job.leads() { self.lead(&mut states, samples, observer)? } else { (None, 0) };
        // The first rank has seen which of the states holds.
        let (place, _) = job.sum(place, 0)?;
        let state = (!states.is_empty()).then(|| states.swap_remove(place));
        Ok(Some(Start { claim, writer, state }))
    }

    /// Tells whether the run may come to a later end than it had.
    fn extends(&self) -> bool {
        self.options.mode == StartMode::Extend
    }

    /// Refuses a file that another program is writing, or an earlier version of this one, which made no locks, and what has
    /// the name of a checkpoint; removes what a killed run left half-written.
    fn clear_away(&self) -> Result<(), InputError> {
        let path = self.path;
        if let Writer::Process(process) = writer_of(path) {
            let path = path.display();
            return Err(InputError::Refused(format!(
                "{path} is being written by process {process}; stop that first, or write elsewhere with -o FILE"
            )));
        }
        checkpoint::refuse_foreign(path, self.options.replace)?;
        for target in [path].into_iter().chain(checkpoint::paths(path).iter().map(AsRef::as_ref)) {
            Temporary::remove_abandoned(target);
        }
        Ok(())
    }

    /// Tells whether all steps of the run are done, by its newest checkpoint and its file.
    fn is_finished(&self, newest: Option<&RunState>, there: Option<&There>) -> Result<bool, InputError> {
        let is_finished = there.is_some_and(|there| there.state == State::Finished);
        match newest {
            // What a checkpoint says counts only for the file that it was left beside.
            Some(newest) if newest.finished => match there {
                None if !self.options.replace => {
                    Err(self.refused("is gone, though its checkpoint says that the run is finished"))
                }
                Some(there) if is_finished && there.holds == [newest.samples, newest.snapshots] => {
                    Ok(!self.extends() || self.has_come_to_end(newest)?)
                }
                _ => Ok(false),
            },
            Some(_) => Ok(false),
            None if is_finished && self.extends() => {
                Err(self.refused("is finished and has no checkpoint to go on from"))
            }
            None => Ok(is_finished),
        }
    }

    /// Tells whether a finished run that is to go on to a time has come to just that.
    fn has_come_to_end(&self, state: &RunState) -> Result<bool, InputError> {
        let time = state.simulation.reached;
        // The last step may go beyond the time that is asked for.
        let step = time / state.simulation.run.steps().max(1) as f64;
        if time > self.end + 1.5 * step {
            let (path, time) = (self.path.display(), number::short(time));
            let message = format!("--extend-to: {path} has come to {time} s already; give a later time");
            return Err(InputError::Refused(message));
        }
        Ok(time > self.end - 0.5 * step)
    }

    /// The writer of the run file, and which of the states it goes on from.
    ///
    /// Where there are none, `samples` that are there are of a run that was ended before its first checkpoint: they stay, beside the
    /// file that is begun anew.
    fn lead(
        &self,
        states: &mut [RunState],
        samples: usize,
        observer: &dyn Observer,
    ) -> Result<(Option<RunWriter>, usize), RunError> {
        let Self { path, header, options, .. } = *self;
        if !states.is_empty() {
            return self.writer(states, observer).map(|(writer, place)| (Some(writer), place));
        }
        // What is there is of another run, and stays if the new one cannot begin.
        let shown = path.display();
        let others = checkpoint::set_aside(path).map_err(|error| {
            let message = format!("cannot replace the checkpoints of {shown}: {error}; write elsewhere with -o FILE");
            InputError::Aside(message, error)
        })?;
        let kept = match samples {
            0 => None,
            samples => Some(Kept::of(path, samples).map_err(|error| {
                let message = format!(
                    "cannot keep the samples of {shown} beside it: {error}; move that file away, or write elsewhere with -o FILE"
                );
                InputError::Aside(message, error)
            })?),
        };
        let writer = RunWriter::create(path, options.replace || options.mode.resumes(), header)?;
        others.discard();
        if let Some(place) = kept.map(Kept::stay) {
            let samples = number::count(samples, "sample");
            observer.note(&format_args!("{samples} of before stay in {}", place.display()));
        }
        Ok((Some(writer), 0))
    }

    /// Looks at the file that is to be gone on with, if there is one; it must be of this run, unless it may be replaced.
    fn look(
        &self,
        states: &[RunState],
        claim: Option<&Claim>,
        observer: &dyn Observer,
    ) -> Result<Option<There>, InputError> {
        let Self { path, options, .. } = *self;
        if !path.exists() {
            return Ok(None);
        }
        let there = match RunFile::open(path) {
            Ok(there) => there,
            // A checkpoint knows what it was.
            Err(_) if states.iter().flat_map(|state| &state.images).any(|image| image.is_of(path)) => {
                return Ok(Some(There { state: State::Running, holds: [0, 0] }));
            }
            Err(_) if options.replace => return Ok(None),
            Err(ReadError::Damaged { .. } | ReadError::NotHdf5 { .. } | ReadError::Foreign { .. })
                if states.is_empty() && claim.is_none_or(|claim| claim.before().is_some()) =>
            {
                if claim.is_some() {
                    let kept = keep(path)?;
                    observer.note(&format_args!(
                        "{} cannot be read: its run was stopped, as by a loss of power, before its first checkpoint; it is kept as {}",
                        path.display(),
                        kept.display()
                    ));
                }
                return Ok(None);
            }
            Err(error) => {
                return Err(InputError::Refused(format!("{error}; without --resume, --force begins again")));
            }
        };
        let scene = there.attribute("scene").unwrap_or_default();
        match self.compare_scenes(&scene) {
            Err(_) if options.replace => Ok(None),
            compared => compared
                .map(|()| Some(There { state: there.state(), holds: [there.time().len(), there.map_time().len()] })),
        }
    }

    /// Nothing more will be done about a finished file: it must hold what was written.
    fn check_that_it_is_whole(&self) -> Result<(), InputError> {
        let verification = verify(self.path)?;
        let Some(Damage { place, problem }) = verification.damage.first() else { return Ok(()) };
        Err(self.refused(&format!("is finished, and damaged: {place}: {problem}")))
    }

    /// Refuses a run file that is not one to go on with, for its problem.
    fn refused(&self, what: &str) -> InputError {
        InputError::Refused(format!("{} {what}; without --resume, --force begins again", self.path.display()))
    }

    /// The states to go on from, the newest first; none if there is no checkpoint.
    fn states(&self, observer: &dyn Observer) -> Result<Vec<RunState>, InputError> {
        let (mut states, mut trouble) = (Vec::new(), Vec::new());
        for path in checkpoint::paths(self.path) {
            match checkpoint::read::<RunState>(&path, Some(checkpoint::ample_size(&self.header.mesh))) {
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
        self.compare(&newest)?;
        // The one before may be of the end that was extended since.
        let before = states.filter(|state| self.compare(state).is_ok());
        Ok([newest].into_iter().chain(before).collect())
    }

    /// Refuses a state of another run.
    fn compare(&self, state: &RunState) -> Result<(), InputError> {
        let identity = self.identity;
        if state.program != identity.program {
            let what = format_args!("it was begun by {}, this is {}", state.program, identity.program);
            return Err(self.refused_to_resume(what));
        }
        let engine = state.simulation.run.engine();
        if engine != identity.engine {
            let what = format_args!("it was begun with --engine {engine}, this is {}", identity.engine);
            return Err(self.refused_to_resume(what));
        }
        self.compare_scenes(&state.scene)?;
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
        Err(self.refused_to_resume(format_args!("files that it reads have changed: {}", text::list(changed, ", "))))
    }

    /// Refuses a run file of another scene.
    fn compare_scenes(&self, scene: &str) -> Result<(), InputError> {
        let now = self.identity.scene.parse().unwrap_or_default();
        let free = |key: &str| match schema::role(key) {
            Role::Nothing => true,
            Role::Length | Role::MapTimes => self.extends(),
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
            return Ok(());
        }
        Err(self.refused_to_resume(format_args!("the scene differs: {}", text::list(keys, ", "))))
    }

    fn refused_to_resume(&self, difference: impl std::fmt::Display) -> InputError {
        let path = self.path.display();
        InputError::Refused(format!(
            "{path} cannot be resumed: {difference}; undo that, or begin again without --resume"
        ))
    }

    /// Goes on with the run file of the first of the states that it has what they say of; its writer and which state it is.
    ///
    /// The file is made anew, so the state gets the image of that one and is written once more before it takes the place of the old
    /// one; with the image of the old one, too, for nobody knows which of both a loss of power leaves.
    fn writer(&self, states: &mut [RunState], observer: &dyn Observer) -> Result<(RunWriter, usize), RunError> {
        let Self { path, header, .. } = *self;
        if !path.exists() {
            // Else every checkpoint would say so.
            return Err(self.refused("is gone, though its checkpoint is there").into());
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
}

/// The file that is to be gone on with.
struct There {
    state: State,
    /// Samples, and moments of which there are maps.
    holds: [usize; 2],
}

/// Names that are tried.
const MOST: usize = 1000;

/// A run file that has a second name, which goes again unless it is to stay.
struct Kept {
    place: PathBuf,
    /// Path that it was moved from, on file systems where a file has one name only.
    moved_from: Option<PathBuf>,
    stays: bool,
}

impl Kept {
    /// Keeps a run file of so many samples as `RUN.before-resume`. Where a file of an earlier beginning of the same run has that name,
    /// the one with more samples is kept; what else has it stays, and another name is taken.
    fn of(path: &Path, samples: usize) -> io::Result<Self> {
        for place in names_beside(path, "before-resume").take(MOST) {
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
    fn stay(mut self) -> PathBuf {
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

/// Samples in a file of the same scene, surfaces and program, which are the same as far as they go; none of another file.
fn samples_of_same(place: &Path, run: &Path) -> Option<usize> {
    if !fs::symlink_metadata(place).is_ok_and(|there| there.is_file()) {
        return None;
    }
    let [there, run] = [RunFile::open(place).ok()?, RunFile::open(run).ok()?];
    let alike = |name: &str| there.attribute(name) == run.attribute(name);
    ["scene", "program", "source_revision", "inputs"].into_iter().all(alike).then(|| there.time().len())
}
