//! What is kept of a study's runs that are under way, so that a long one need not begin again.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use plateau_core::model::mesh::Mesh;
use plateau_core::simulation::SimulationError;
use plateau_io::checkpoint::{self, SimulationState};
use plateau_io::claim::Claim;
use plateau_io::temporary::Temporary;
use plateau_run::Assembly;
use serde::{Deserialize, Serialize};

use crate::message;

/// Letters of the identity of a run.
const IDENTITY: usize = 64;

/// The state of one run between two steps.
#[derive(Debug, Serialize, Deserialize)]
pub struct State {
    /// What takes the steps.
    pub simulation: SimulationState,
    /// The series so far, time first.
    pub columns: Vec<Vec<f64>>,
    /// Their names.
    pub names: Vec<String>,
}

/// Where the state of one run is, and when it is due. The file is named by the identity of the run: another scene, program
/// or surface has another one.
#[derive(Debug)]
pub struct UnderWay {
    path: PathBuf,
    every: Duration,
    last: Instant,
    /// Held from the first state that is kept on. Another process may be making the same run, and keep its states there.
    claim: Option<Claim>,
    refused: bool,
}

impl UnderWay {
    /// For a run of that identity, whose state is never due until [`keep_every`](Self::keep_every) says when.
    pub fn new(results: &Path, identity: &str) -> Self {
        let path = results.join("under-way").join(identity);
        Self { path, every: Duration::MAX, last: Instant::now(), claim: None, refused: false }
    }

    /// Says how often the state is to be kept, in seconds.
    pub fn keep_every(&mut self, every: f64) {
        self.every = Duration::try_from_secs_f64(every).unwrap_or(Duration::MAX);
    }

    /// What was kept of a run on this mesh, if there is something that holds and has these series.
    pub fn find(&self, mesh: &Mesh, names: &[String]) -> Option<State> {
        let most = checkpoint::ample_size(mesh);
        let state: Option<State> = checkpoint::read(&self.path, Some(most)).unwrap_or_else(|error| {
            message::warning(format_args!("{error}: this run begins again"));
            None
        });
        state.filter(|state| state.names == names)
    }

    /// Whether it is time to keep the state.
    pub fn is_due(&self) -> bool {
        self.last.elapsed() >= self.every
    }

    /// Keeps the state; what cannot be kept is done again if need be.
    ///
    /// # Errors
    /// [`SimulationError`] when a worker failed.
    pub fn keep(
        &mut self,
        assembly: &mut Assembly,
        columns: &[Vec<f64>],
        names: Vec<String>,
    ) -> Result<(), SimulationError> {
        self.last = Instant::now();
        let state = State { simulation: assembly.checkpoint()?, columns: columns.to_vec(), names };
        if self.claims()
            && let Err(error) = checkpoint::keep(&self.path, &state)
        {
            not_kept(&error);
        }
        Ok(())
    }

    /// Whether the state is this process's to keep; says once why not.
    fn claims(&mut self) -> bool {
        if self.claim.is_none() && !self.refused {
            let folder = self.path.parent().map_or(Ok(()), fs::create_dir_all);
            let claim = folder.map_err(|error| error.to_string()).and_then(|()| {
                let claim = Claim::of(&self.path).map_err(|error| error.to_string())?;
                checkpoint::refuse_one_foreign(&self.path, false).map_err(|error| error.to_string())?;
                Ok(claim)
            });
            match claim {
                Ok(claim) => {
                    Temporary::remove_abandoned(&self.path);
                    self.claim = Some(claim);
                }
                Err(error) => {
                    not_kept(&error);
                    self.refused = true;
                }
            }
        }
        self.claim.is_some()
    }

    /// Forgets the state of a run whose result is kept.
    pub fn forget(&mut self) {
        // Most runs are too short to have left any; the folder goes with its last file.
        if self.path.exists() && self.claims() && fs::remove_file(&self.path).is_ok() {
            self.claim = None;
            let _ = self.path.parent().map(fs::remove_dir);
        }
    }
}

/// Removes the states of runs that have come to their end: of a process that was killed between keeping the result and forgetting
/// the state. Gives how many are left of runs that are none of the study, as of another version of it or of the program.
pub fn tidy(results: &Path, is_run: impl Fn(&str) -> bool, has_ended: impl Fn(&str) -> bool) -> usize {
    let folder = results.join("under-way");
    let Ok(entries) = fs::read_dir(&folder) else { return 0 };
    let mut strangers = 0;
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_state = name.len() == IDENTITY && name.bytes().all(|byte| byte.is_ascii_hexdigit());
        if is_state && has_ended(&name) {
            UnderWay::new(results, &name).forget();
        } else if is_state && !is_run(&name) {
            strangers += 1;
        }
    }
    // The folder goes with its last file.
    let _ = fs::remove_dir(&folder);
    strangers
}

fn not_kept(error: &dyn std::fmt::Display) {
    message::warning(format_args!("cannot keep the state of a run: {error}; the run goes on"));
}
