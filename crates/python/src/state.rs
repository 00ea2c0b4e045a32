//! The state of a simulation in a file, from which another goes on bit for bit.

use std::path::{Path, PathBuf};

use plateau_io::run_file::checkpoint::{self, SimulationState};
use plateau_io::scene::Scene;
use plateau_run::Program;
use serde::{Deserialize, Serialize};

use crate::failure::Failure;

/// This library, as run files name it: as the program that was built of the same source, so that each goes on with runs of the
/// other.
pub fn program() -> Program {
    Program { name: format!("plateau {}", env!("CARGO_PKG_VERSION")), revision: env!("PLATEAU_REVISION").into() }
}

/// State of a simulation: all that it takes to go on.
#[derive(Debug, Serialize, Deserialize)]
pub struct State {
    /// Name, version and revision of the program.
    program: String,
    /// The resolved scene; files that it names are looked for from the working directory.
    pub scene: String,
    /// Surface files that were read, with their SHA-256.
    pub inputs: Vec<(PathBuf, String)>,
    /// The simulation.
    pub simulation: SimulationState,
}

impl State {
    /// Puts a state together.
    pub fn new(scene: &Scene, inputs: &[(PathBuf, String)], simulation: SimulationState) -> Self {
        let (program, scene) = (program().build(), scene.resolved.clone());
        Self { program, scene, inputs: inputs.to_vec(), simulation }
    }

    /// Writes it; what was there before stays until it is complete.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        if path.exists() && !matches!(checkpoint::read::<Self>(path, None), Ok(Some(_))) {
            let shown = path.display();
            return Err(Failure::input(format!("{shown} is there and no state of a simulation: take another name")));
        }
        checkpoint::keep(path, self).map_err(|error| Failure::run(format_args!("{}: {error}", path.display())))
    }

    /// Reads one that this program wrote.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let shown = path.display();
        let found = checkpoint::read::<Self>(path, None).map_err(Failure::input)?;
        let state = found.ok_or_else(|| Failure::input(format!("{shown}: there is no such state")))?;
        let here = program().build();
        if state.program == here {
            return Ok(state);
        }
        Err(Failure::input(format!(
            "{shown} was saved by {}, this is {here}: go on with that, or begin again",
            state.program
        )))
    }

    /// Refuses a state whose surface files have changed.
    pub fn compare(&self, inputs: &[(PathBuf, String)]) -> Result<(), Failure> {
        let changed = self.inputs.iter().zip(inputs).find(|(then, now)| then != now);
        match changed {
            None => Ok(()),
            Some(((file, _), _)) => Err(Failure::input(format!(
                "{} has changed since the state was saved: put the file back, or begin again",
                file.display()
            ))),
        }
    }
}
