//! The runs of a study that are under way: each is made by one process at a time, and what is kept of it lets a long one go on.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use plateau_core::model::mesh::Mesh;
use plateau_core::simulation::SimulationError;
use plateau_io::claim::{Claim, ClaimError, Seen};
use plateau_io::run_file::checkpoint::{self, SimulationState};
use plateau_io::run_file::{Image, RunFileError};
use plateau_io::temporary::Temporary;
use serde::{Deserialize, Serialize};

use crate::error::RunError;
use crate::sweep::warnings::SweepObserver;

/// Folder of locks and states, in that of the results.
const FOLDER: &str = "under-way";
/// Letters of the identity of a run.
const IDENTITY: usize = 64;

/// Number of times that a process shows that it still makes a run, which those on other machines cannot see otherwise.
const TOUCH: Duration = Duration::from_secs(10);
/// For how long nobody must have touched a run that a process of another machine had, before it counts as ended.
const SILENCE: Duration = Duration::from_secs(180);

/// Reason why a run did not finish.
pub enum Ended {
    /// A signal came.
    Stopped,
    /// The problem.
    Failed(String),
    /// Problem with its run file, which is not one of the run.
    Unkept(String),
}

impl From<SimulationError> for Ended {
    fn from(error: SimulationError) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<RunFileError> for Ended {
    fn from(error: RunFileError) -> Self {
        Self::Unkept(error.to_string())
    }
}

impl From<RunError> for Ended {
    fn from(error: RunError) -> Self {
        Self::Failed(error.to_string())
    }
}

/// Content of a run file between two steps.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FileState {
    /// Moments of which it has maps.
    pub snapshots: usize,
    /// Wall time of the run so far, s.
    pub wall_time: f64,
    /// The file as it is on the disk.
    pub images: Vec<Image>,
}

/// The state of one run between two steps.
#[derive(Debug, Serialize, Deserialize)]
pub struct SavedState {
    /// Name, version and revision of the program: another one may lay out states in another way.
    pub program: String,
    /// Engine that takes the steps.
    pub simulation: SimulationState,
    /// The series so far, time first.
    pub columns: Vec<Vec<f64>>,
    /// Their names.
    pub names: Vec<String>,
    /// Content of the run file, if the study keeps those.
    pub file: Option<FileState>,
}

/// A run that this process makes: nobody else makes it meanwhile, and its state is kept when it is due. Lock and state are named by the
/// identity of the run: another scene, surface or generation of the program has another one.
pub struct UnderWay<'a> {
    observer: &'a dyn SweepObserver,
    path: PathBuf,
    /// None where no lock can be made: better twice than never, the run is made without, and its state is not kept.
    claim: Option<Claim>,
    every: Duration,
    last: Instant,
    touched: Instant,
}

/// Locks of runs that others make, as this process saw them.
#[derive(Debug, Default)]
pub struct Others(BTreeMap<PathBuf, (Seen, Instant)>);

impl Others {
    /// The lock as it was seen first and ever since, if nobody has touched it for so long.
    fn silent(&mut self, path: &Path, silence: Duration) -> Option<Seen> {
        let seen = Claim::seen(path)?;
        let (first, since) = self.0.entry(path.to_owned()).or_insert_with(|| (seen.clone(), Instant::now()));
        if *first != seen {
            (*first, *since) = (seen, Instant::now());
            return None;
        }
        (since.elapsed() >= silence).then_some(seen)
    }
}

impl<'a> UnderWay<'a> {
    /// Takes the run of that identity, unless another process makes it. Its state is never due until
    /// [`keep_every`](Self::keep_every) says when.
    pub fn take(
        results: &Path,
        identity: &str,
        others: &Mutex<Others>,
        observer: &'a dyn SweepObserver,
    ) -> Option<Self> {
        let path = results.join(FOLDER).join(identity);
        let claim = match claim(&path, observer) {
            Err(ClaimError::Elsewhere { .. }) => {
                let silent = others.lock().unwrap_or_else(PoisonError::into_inner).silent(&path, SILENCE);
                Some(silent.and_then(|seen| Claim::of_silent(&path, &seen).ok())?)
            }
            claim => claim.ok()?,
        };
        if claim.is_some() {
            Temporary::remove_abandoned(&path);
        }
        let now = Instant::now();
        Some(Self { observer, path, claim, every: Duration::MAX, last: now, touched: now })
    }

    /// Says how often the state is to be kept, in seconds.
    pub fn keep_every(&mut self, every: f64) {
        self.every = Duration::try_from_secs_f64(every).unwrap_or(Duration::MAX);
    }

    /// Shows those who wait for the run that it is still being made.
    pub fn touch(&mut self) {
        if self.touched.elapsed() >= TOUCH {
            self.claim.iter().for_each(Claim::touch);
            self.touched = Instant::now();
        }
    }

    /// Says that the run is not what it was taken for: its state is another run's, and is neither read nor kept.
    pub fn is_another(&mut self) {
        self.claim = None;
    }

    /// SavedState that was kept of a run on this mesh by the same program, if there is something that holds and has these series.
    pub fn find(&self, mesh: &Mesh, program: &str, names: &[String]) -> Option<SavedState> {
        self.claim.as_ref()?;
        let most = checkpoint::ample_size(mesh);
        let state: Option<SavedState> = checkpoint::read(&self.path, Some(most)).unwrap_or_else(|error| {
            self.observer.warning(&format_args!("{error}: this run begins again"));
            None
        });
        state.filter(|state| state.program == program && state.names == names)
    }

    /// Tells whether it is time to keep the state.
    pub fn is_due(&self) -> bool {
        self.last.elapsed() >= self.every
    }

    /// Keeps the state between two steps; what cannot be kept is done again if need be.
    pub fn keep(&mut self, state: &SavedState) {
        self.last = Instant::now();
        if self.claim.is_none() {
            return;
        }
        if let Err(error) = checkpoint::keep(&self.path, state) {
            not_kept(&error, self.observer);
        }
    }

    /// Forgets the state of a run whose result is kept.
    pub fn forget(self) {
        if self.claim.is_some() {
            // Most runs are too short to have left any.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Claims the place of a state; none where that cannot be, which is said.
fn claim(path: &Path, observer: &dyn SweepObserver) -> Result<Option<Claim>, ClaimError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut tries = 0..10;
    let refused: Box<dyn std::error::Error> = loop {
        if let Err(error) = fs::create_dir_all(folder) {
            break error.into();
        }
        match Claim::of(path) {
            // Another process has ended, and with it went the folder.
            Err(ClaimError::System(_, error)) if error.kind() == ErrorKind::NotFound && tries.next().is_some() => {}
            Err(error @ (ClaimError::Here { .. } | ClaimError::Elsewhere { .. })) => return Err(error),
            Err(error) => break error.into(),
            Ok(claim) => match checkpoint::refuse_one_foreign(path, false) {
                Ok(()) => return Ok(Some(claim)),
                Err(error) => break error.into(),
            },
        }
    };
    not_kept(&refused, observer);
    Ok(None)
}

/// Removes the folder of states if it has nothing more.
pub fn end(results: &Path) {
    let _ = fs::remove_dir(results.join(FOLDER));
}

/// Removes the states and locks of runs that have come to their end: of a process that was killed between keeping the result and forgetting
/// the state. Gives how many are left of runs that are none of the study, as of another version of it.
pub fn tidy(results: &Path, is_run: impl Fn(&str) -> bool, has_ended: impl Fn(&str) -> bool) -> usize {
    let folder = results.join(FOLDER);
    // Of processes that were killed while they asked for a lock, whoever got it.
    Temporary::remove_abandoned_of(&folder, |name| name.contains(".lock"));
    let Ok(entries) = fs::read_dir(folder) else { return 0 };
    let mut strangers = 0;
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let run = name.strip_suffix(".lock").unwrap_or(&name);
        let is_identity = run.len() == IDENTITY && run.bytes().all(|byte| byte.is_ascii_hexdigit());
        if is_identity && has_ended(run) {
            // What is no lock stays, as do states that a living process still has.
            if let Some(under_way) = UnderWay::take(results, run, &Mutex::default(), &()) {
                under_way.forget();
            }
        } else if is_identity && run == name && !is_run(run) {
            strangers += 1;
        }
    }
    end(results);
    strangers
}

fn not_kept(error: &dyn std::fmt::Display, observer: &dyn SweepObserver) {
    observer.warning(&format_args!("cannot keep the state of a run: {error}; the run goes on"));
}

#[cfg(test)]
#[path = "../../tests/unit/sweep/under_way.rs"]
mod tests;
