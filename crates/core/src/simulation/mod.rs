//! A pin on a disc, from its first step to its last (model section 4).

pub mod checkpoint;
mod control;
mod observation;
mod plain;
mod workers;

use std::sync::Arc;

use self::checkpoint::{Checkpoint, LastContact};
use self::workers::Workers;
#[cfg(feature = "mpi")]
use crate::engine::comm::{Communicator as _, mpi::Mpi};
pub use crate::engine::execution::{Engine, Execution};
#[cfg(feature = "mpi")]
use crate::engine::kernel::InstructionSet;
#[cfg(feature = "mpi")]
use crate::engine::parts::Needs;
use crate::model::accounts::Resting;
use crate::model::clock::Clock;
pub use crate::model::error::SimulationError;
pub use crate::model::history::Course;
use crate::model::mesh::Mesh;
use crate::model::parameters::Parameters;
use crate::model::state::{Base, InitialSurfaces};

/// A pin on a disc, and everything that happened to them so far.
///
/// What can be asked of it between two steps is in the file `observation.rs`.
#[derive(Debug)]
pub struct Simulation {
    parameters: Arc<Parameters>,
    pin_base: Vec<Base>,
    execution: Execution,
    workers: Workers,
    clock: Clock,
    contact: Option<LastContact>,
    resting: Option<LastMoment>,
}

/// The accounts at the moment that was asked for last: those after it may follow from them.
#[derive(Debug)]
struct LastMoment {
    /// Steps done, the step that the moment belongs to, and whether it is in a pause.
    of: (u64, u64, bool),
    /// When it is, s.
    until: f64,
    accounts: Resting,
}

impl Simulation {
    /// The state at t = 0, no build-up and no debris, on one worker.
    ///
    /// # Errors
    /// [`SimulationError`] when the surfaces do not fit the mesh or hold a height that is not finite.
    pub fn new(parameters: Parameters, surfaces: InitialSurfaces) -> Result<Self, SimulationError> {
        Self::with_execution(parameters, surfaces, Execution::default())
    }

    /// The same, carried out in a certain way.
    ///
    /// # Errors
    /// [`SimulationError`] as [`Simulation::new`], and when there are no more threads to be had.
    pub fn with_execution(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        execution: Execution,
    ) -> Result<Self, SimulationError> {
        Self::with_disc_turned(parameters, surfaces, execution, 0)
    }

    /// The same with the disc turned by `columns` columns: step n faces the columns that step n + `columns` would face.
    ///
    /// # Errors
    /// [`SimulationError`] as [`Simulation::with_execution`].
    pub fn with_disc_turned(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        mut execution: Execution,
        columns: u64,
    ) -> Result<Self, SimulationError> {
        let mesh = &parameters.mesh;
        check(mesh, &surfaces)?;
        execution.engine = execution.engine.of(&parameters);
        // A sector has at least two columns.
        let most = if execution.engine == Engine::Plain { 1 } else { (mesh.disc_columns() / 2).max(1) };
        execution.workers = execution.workers.clamp(1, most);
        let (parameters, pin_base) = (Arc::new(parameters), surfaces.pin_base.clone());
        let workers = Workers::start(&parameters, surfaces, execution, columns)?;
        let clock = parameters.clock();
        Ok(Self { parameters, pin_base, execution, workers, clock, contact: None, resting: None })
    }

    /// The same as [`Simulation::new`] on the ranks of an MPI job, of which this process is one (feature `mpi`).
    ///
    /// All ranks must make the same calls in the same order, and get the same answers. Where there are more ranks than
    /// sectors, the last ones have no cells and only keep pace.
    ///
    /// # Errors
    /// [`SimulationError`] as [`Simulation::new`]; [`SimulationError::PlainOnRanks`] where debris is pooled.
    #[cfg(feature = "mpi")]
    pub fn on_ranks(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        instructions: InstructionSet,
        communicator: Mpi,
    ) -> Result<Self, SimulationError> {
        check(&parameters.mesh, &surfaces)?;
        if Needs::of(&parameters).pools {
            return Err(SimulationError::PlainOnRanks { ranks: communicator.size() });
        }
        let parameters = Arc::new(parameters);
        let execution = Execution { workers: communicator.size(), instructions, ..Execution::default() };
        let workers = Workers::on_ranks(&parameters, &surfaces, execution, communicator);
        let (clock, pin_base) = (parameters.clock(), surfaces.pin_base);
        Ok(Self { parameters, pin_base, execution, workers, clock, contact: None, resting: None })
    }

    /// One step: see the table in [`crate`].
    ///
    /// # Errors
    /// [`SimulationError::Contact`] when no displacement carries the load, [`SimulationError::Worker`] when a worker
    /// failed.
    pub fn advance(&mut self) -> Result<(), SimulationError> {
        self.advance_to(self.steps_done() + 1)
    }

    /// Takes steps until `step` of them are done.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_to(&mut self, step: u64) -> Result<(), SimulationError> {
        self.workers.advance_to(step, true)
    }

    /// The same where no sample and no map of pressure is taken after the last of the steps: its pressures are not kept.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn pass_to(&mut self, step: u64) -> Result<(), SimulationError> {
        self.workers.advance_to(step, false)
    }

    /// Has the coming steps stand for another number of revolutions than those so far (model 4.6).
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn accelerate(&mut self, acceleration: f64) -> Result<(), SimulationError> {
        self.workers.accelerate(acceleration)?;
        self.resting = None;
        Arc::make_mut(&mut self.parameters).time_acceleration = acceleration;
        self.clock = self.clock.changed(self.steps_done(), self.parameters.step_time());
        Ok(())
    }

    /// Goes on from a checkpoint of a simulation with the same parameters, time acceleration apart, and the same initial
    /// surfaces: the coming steps are bit for bit those that it would have taken.
    ///
    /// # Errors
    /// [`SimulationError::Checkpoint`] and [`SimulationError::OtherState`] when it is of another mesh or scene,
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), SimulationError> {
        checkpoint.check(&self.parameters.mesh)?;
        let (found, expected) = (checkpoint.engine().name(), self.execution.engine.name());
        if found != expected {
            return Err(SimulationError::OtherEngine { found, expected });
        }
        let (memory, engine) = self.workers.memory()?;
        if let Some(what) = checkpoint.misfit(&memory, engine.as_ref()) {
            return Err(SimulationError::OtherState { what });
        }
        self.workers.restore(checkpoint)?;
        self.resting = None;
        self.clock = checkpoint.clock();
        self.contact = checkpoint.contact.clone();
        Arc::make_mut(&mut self.parameters).time_acceleration = checkpoint.memory.time_acceleration;
        Ok(())
    }

    /// What the simulation was told.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Base of every pin cell, column by column.
    pub fn pin_base(&self) -> &[Base] {
        &self.pin_base
    }

    /// How it is carried out.
    pub fn execution(&self) -> Execution {
        self.execution
    }

    /// What the steps so far were like.
    pub fn course(&self) -> Course {
        self.workers.course()
    }

    /// Steps done.
    pub fn steps_done(&self) -> u64 {
        self.course().steps
    }

    /// Steps that are done when t is at least `time` (s) for the first time, with what the coming steps are told now; of a cycle, the
    /// last that ends no later.
    pub fn steps_until(&self, time: f64) -> u64 {
        match &self.parameters.cycle {
            Some(cycle) => cycle.steps_done(time, self.parameters.step_angle()),
            None => self.clock.steps_until(time),
        }
    }

    /// t, s.
    pub fn time(&self) -> f64 {
        self.course().time
    }
}

/// Refuses surfaces that do not fit the mesh or have a height that is not finite.
fn check(mesh: &Mesh, surfaces: &InitialSurfaces) -> Result<(), SimulationError> {
    if !surfaces.fits(mesh) {
        return Err(SimulationError::Size { disc: mesh.disc_cells(), pin: mesh.pin_cells() });
    }
    let is_absent = |surface: &str, cell: usize| surface == "pin" && !mesh.is_present(cell);
    for (surface, heights) in [("disc", &surfaces.disc_height), ("pin", &surfaces.pin_height)] {
        let refused = heights.iter().enumerate().filter(|(_, height)| !height.is_finite());
        let count = refused.filter(|(cell, _)| !is_absent(surface, *cell)).count();
        if count > 0 {
            return Err(SimulationError::Height { surface, count });
        }
    }
    Ok(())
}
