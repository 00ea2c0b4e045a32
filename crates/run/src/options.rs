//! What is asked of a run besides its scene.

use std::path::PathBuf;

use plateau_core::engine::kernel::InstructionSet;
use plateau_core::simulation::Engine;

/// What is asked of a run besides its scene.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Run file, instead of the one that the scene names.
    pub output: Option<PathBuf>,
    /// Whether a file that is there may be replaced.
    pub replace: bool,
    /// Whether the run begins or goes on.
    pub mode: StartMode,
    /// How it is carried out.
    pub execution: ExecutionOptions,
    /// Who makes it.
    pub program: Program,
}

/// Whether a run begins or goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StartMode {
    /// It begins.
    #[default]
    New,
    /// It goes on from the last checkpoint of a run of the same scene, which was stopped or killed.
    Resume,
    /// The same, and the scene may be longer than the run was.
    Extend,
}

impl StartMode {
    /// Whether a run that is there is to be gone on with.
    pub(crate) fn resumes(self) -> bool {
        self != Self::New
    }
}

/// How a run is carried out. Nothing of it shows in the results, but that the two engines round differently.
#[derive(Debug, Clone, Copy)]
pub struct ExecutionOptions {
    /// What takes the steps.
    pub engine: Engine,
    /// Instruction set of the kernels; the widest that the processor has unless given.
    pub instructions: Option<InstructionSet>,
    /// Whether each worker stays on a core of its own.
    pub pin: bool,
}

impl Default for ExecutionOptions {
    fn default() -> Self {
        Self { engine: Engine::Fast, instructions: None, pin: false }
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
    /// This library, of which no revision is known.
    fn default() -> Self {
        Self { name: format!("plateau {}", env!("CARGO_PKG_VERSION")), revision: "unknown".into() }
    }
}
