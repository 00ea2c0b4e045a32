//! Engine, workers and instruction set with which the steps of a simulation are taken.

use std::fmt;

use crate::engine::kernel::InstructionSet;
use crate::engine::parts::Needs;
use crate::model::parameters::Parameters;

/// Implementation of the model that takes the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Engine {
    /// Eight cells at a time, on any number of workers: one pass over the pin a step. It has local debris (model 4L).
    #[default]
    Fast,
    /// The plain model, cell by cell ([`crate::model`]), on one worker: the same results but for rounding, slowly.
    Plain,
}

impl Engine {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Plain => "plain",
        }
    }

    /// Returns the engine of a scene where this one is asked for: the plain model where debris is pooled (model 4P).
    pub fn of(self, parameters: &Parameters) -> Self {
        if Needs::of(parameters).pools { Self::Plain } else { self }
    }
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Division of the mesh among workers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Decomposition {
    /// Whichever of the two, or both, is fastest by a model of costs.
    #[default]
    Auto,
    /// The ring into angular sectors, which hand columns on as the pin sweeps across their boundaries.
    Sectors,
    /// The radius into bands of rows, as many as the number of workers can be divided by, and each band into sectors for the others.
    Bands,
}

/// Settings by which a simulation is carried out. Nothing of them shows in the results, but that the two engines round differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Execution {
    /// Engine that takes the steps.
    pub engine: Engine,
    /// Workers that share the ring, at least 1: threads or ranks of a job.
    pub workers: usize,
    /// Instruction set of the kernels.
    pub instructions: InstructionSet,
    /// Division of the mesh among the workers.
    pub decomposition: Decomposition,
    /// True if each worker stays on a core of its own.
    pub pin: bool,
    /// True if cells to which nothing out of the ordinary happens are passed over with few instructions: false is for tests.
    pub shortcut: bool,
}

impl Execution {
    /// Returns what the steps are taken with: the name of the instruction set, or `plain model`.
    pub fn means(&self) -> &'static str {
        match self.engine {
            Engine::Fast => self.instructions.name(),
            Engine::Plain => "plain model",
        }
    }
}

impl Default for Execution {
    fn default() -> Self {
        let instructions = InstructionSet::best();
        Self {
            engine: Engine::Fast,
            workers: 1,
            instructions,
            decomposition: Decomposition::Auto,
            pin: false,
            shortcut: true,
        }
    }
}
