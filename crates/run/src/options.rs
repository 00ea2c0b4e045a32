//! Options of a run besides its scene, its observer, and options of a sweep.

use std::fmt::Display;
use std::path::PathBuf;

use plateau_core::observe::Sample;
use plateau_core::simulation::{Execution, Simulation};

/// Options of a run besides its scene.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Run file, instead of the one that the scene names.
    pub output: Option<PathBuf>,
    /// Tells whether a file that is there may be replaced.
    pub replace: bool,
    /// Start of the run: it begins or goes on.
    pub mode: StartMode,
    /// Execution that is asked for; workers and decomposition are those of the scene.
    pub execution: Execution,
    /// Program that makes the run.
    pub program: Program,
}

/// Start of a run: it begins or goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StartMode {
    /// Run that begins.
    #[default]
    New,
    /// Run that goes on from the last checkpoint of a run of the same scene, which was stopped or killed.
    Resume,
    /// Run that goes on likewise, but whose scene may be longer than the run was.
    Extend,
}

impl StartMode {
    /// Tells whether a run that is there is to be gone on with.
    pub(crate) fn resumes(self) -> bool {
        self != Self::New
    }
}

/// The program that makes a run, as run files and checkpoints name it. Only the same program goes on from its checkpoints.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// Name and version.
    pub name: String,
    /// Revision of the source.
    pub revision: String,
}

impl Program {
    /// Name, version and revision: what tells results of different programs apart.
    pub fn build(&self) -> String {
        format!("{} {}", self.name, self.revision)
    }
}

impl Default for Program {
    /// Returns this library, of which no revision is known.
    fn default() -> Self {
        Self { name: format!("plateau {}", env!("CARGO_PKG_VERSION")), revision: "unknown".into() }
    }
}

/// Options of a sweep: the runs of a study that are made, and their execution.
#[derive(Debug, Clone)]
pub struct SweepOptions {
    /// Tells whether runs that failed before, or did not keep a series that is needed now, are made again.
    pub retry: bool,
    /// Tells whether the run file of every run is kept, and runs are made again that have none.
    pub keep_files: bool,
    /// The part of the runs that this process makes; all of them if none.
    pub part: Option<Part>,
    /// Runs at a time, at most.
    pub jobs: usize,
    /// Threads of each run.
    pub workers: usize,
    /// Failures after which no more runs begin; as many as there are if none.
    pub most_failures: Option<usize>,
    /// The program, as records and states name it.
    pub program: Program,
}

impl Default for SweepOptions {
    /// All runs that are not there yet, one at a time on one thread.
    fn default() -> Self {
        Self {
            retry: false,
            keep_files: false,
            part: None,
            jobs: 1,
            workers: 1,
            most_failures: None,
            program: Program::default(),
        }
    }
}

/// One of several equal parts of the runs of a study: of `count` tasks the one with this number, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Number of the part, from 1.
    pub number: usize,
    /// Number of parts.
    pub count: usize,
}

/// Follows a run, or the runs of a study. Every method has an answer already: an observer says only what it cares for, `()` cares for
/// nothing.
///
/// In a job of several processes each has an observer of its own. All are told the same, and it suffices that one of them
/// asks for something.
pub trait Observer {
    /// Told what deserves attention though the run goes on.
    fn warning(&self, _message: &dyn Display) {}

    /// Told what is worth knowing.
    fn note(&self, _message: &dyn Display) {}

    /// Told how a surface was made ready, one step a line; for those who want to see it.
    fn detail(&self, _message: &dyn Display) {}

    /// Called when all that the run needs is read and made, and nothing is written: until now whoever wants to stop it may end the process.
    fn prepared(&self) {}

    /// Called when steps begin, to be taken until this physical time (s); `name` tells a run from others of the same scene, else it is
    /// empty.
    fn starts(&self, _name: &str, _duration: f64) {}

    /// Called about ten times a second between two steps.
    fn progress(&self, _simulation: &Simulation) {}

    /// Called when a sample was taken; it is on its way to the run file.
    fn sample(&self, _sample: &Sample) {}

    /// Called when the last step was taken, or the run ends before; of a study when no more runs are made.
    fn ends(&self) {}

    /// The number of the signal that asks the run to stop, if one does. Looked at as often as [`progress`](Self::progress) is
    /// called; a run that has a file leaves a checkpoint.
    fn asked_to_stop(&self) -> Option<u8> {
        None
    }

    /// Tells whether a checkpoint was asked for since the last time.
    fn asked_to_save(&self) -> bool {
        false
    }
}

impl Observer for () {}
