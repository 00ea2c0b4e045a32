//! Workers that take the steps of a simulation.

use std::sync::Arc;

use super::checkpoint::Checkpoint;
use super::plain::Plain;
use crate::engine::comm::threads::Threads;
use crate::engine::comm::{Communicator, Exchange, Single};
use crate::engine::execution::{Engine, Execution};
use crate::engine::parts::Needs;
use crate::engine::sector::Partition;
use crate::engine::worker::{EngineMemory, Worker, halo_words, waiting_columns};
use crate::engine::worker_threads::WorkerThreads;
use crate::model::accounts::Accounts;
use crate::model::clock::Operation;
use crate::model::error::SimulationError;
use crate::model::memory::{Course, Memory};
use crate::model::parameters::Parameters;
use crate::model::state::InitialSurfaces;
use crate::observe::{Map, Sample, Snapshot};

/// Workers that take the steps.
#[derive(Debug)]
pub(super) enum Workers {
    /// This thread, alone or, each for itself, with the other processes of a job.
    One(Box<Worker>),
    /// Threads of their own.
    Threads(Box<WorkerThreads>),
    /// This thread, with the plain model.
    Plain(Box<Plain>),
}

/// Gives the same call to whoever takes the steps.
macro_rules! call {
    ($workers:expr, $worker:ident => $call:expr) => {
        match $workers {
            Self::One($worker) => $call,
            Self::Threads($worker) => $call,
            Self::Plain($worker) => $call,
        }
    };
}

/// The partition for so many workers, whose sectors are longer than what of a segment waits for the next.
pub(super) fn partition(parameters: &Parameters, execution: Execution) -> Arc<Partition> {
    let shortest = waiting_columns(Needs::of(parameters).transport) + 1;
    Arc::new(Partition::new(&parameters.mesh, execution.workers, execution.decomposition, shortest))
}

impl Workers {
    /// Starts the workers of a simulation at t = 0, over a disc turned by `turned` columns.
    pub fn start(
        parameters: &Arc<Parameters>,
        surfaces: InitialSurfaces,
        execution: Execution,
        turned: u64,
    ) -> Result<Self, SimulationError> {
        if execution.engine == Engine::Plain {
            return Ok(Self::Plain(Box::new(Plain::new(parameters.clone(), surfaces, turned))));
        }
        if execution.workers == 1 {
            return Ok(Self::one(parameters, &surfaces, execution, turned, Box::new(Single)));
        }
        let partition = partition(parameters, execution);
        let halo_words = halo_words(parameters.mesh.rows(), Needs::of(parameters));
        let worker = |end: Threads| {
            let alarm = end.alarm();
            (Worker::new(parameters.clone(), &surfaces, partition.clone(), execution, turned, Box::new(end)), alarm)
        };
        let workers =
            Threads::connect(execution.workers, partition.messages(), halo_words).into_iter().map(worker).collect();
        let refused =
            |error: std::io::Error| SimulationError::Threads { workers: execution.workers, message: error.to_string() };
        let threads = WorkerThreads::start(workers, execution.pin).map_err(refused)?;
        Ok(Self::Threads(Box::new(threads)))
    }

    /// This thread as one of the workers that `communicator` connects.
    pub fn one(
        parameters: &Arc<Parameters>,
        surfaces: &InitialSurfaces,
        execution: Execution,
        turned: u64,
        communicator: Box<dyn Communicator>,
    ) -> Self {
        let partition = partition(parameters, execution);
        Self::One(Box::new(Worker::new(parameters.clone(), surfaces, partition, execution, turned, communicator)))
    }

    /// Takes steps until `step` of them are done; the last may be watched, for a sample or maps of pressure to follow.
    pub fn advance_to(&mut self, step: u64, watched: bool) -> Result<(), SimulationError> {
        call!(self, worker => worker.advance_to(step, watched))
    }

    /// Has the coming steps stand for `acceleration` revolutions each (model 4.6).
    pub fn accelerate(&mut self, acceleration: f64) -> Result<(), SimulationError> {
        call!(self, worker => worker.accelerate(acceleration))
    }

    /// Has the coming steps taken under another load and at another speed.
    pub fn operate(&mut self, operation: &Operation) -> Result<(), SimulationError> {
        call!(self, worker => worker.operate(operation))
    }

    /// Returns the state that is kept beside the surfaces.
    pub fn memory(&mut self) -> Result<(Memory, Option<EngineMemory>), SimulationError> {
        let (memory, engine) = match self {
            Self::One(worker) => worker.memory(),
            Self::Threads(threads) => threads.memory()?,
            Self::Plain(plain) => return Ok((plain.memory(), None)),
        };
        Ok((memory, Some(engine)))
    }

    /// The accounts of friction, heat and emission, where the scene asks for any.
    pub fn accounts(&mut self, parameters: &Parameters) -> Result<Option<Accounts>, SimulationError> {
        let state = self.memory()?.0.accounts;
        Ok(Accounts::of(parameters).zip(state).map(|(mut accounts, state)| {
            accounts.restore(state);
            accounts
        }))
    }

    /// Takes over the state of a simulation of the same parameters and surfaces, of the same engine.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), SimulationError> {
        let Checkpoint { heights, memory, engine, .. } = checkpoint;
        match (self, engine) {
            (Self::One(worker), Some(engine)) => worker.restore(heights, memory, engine),
            (Self::Threads(threads), Some(engine)) => threads.restore(heights, memory, engine),
            (Self::Plain(plain), None) => {
                plain.restore(heights, memory);
                Ok(())
            }
            _ => Err(SimulationError::OtherState { what: "an engine" }),
        }
    }

    /// The reported quantities after the last step.
    pub fn sample(&mut self) -> Result<Sample, SimulationError> {
        call!(self, worker => worker.sample())
    }

    /// The maps asked for, as they are now.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        call!(self, worker => worker.snapshot(maps))
    }

    /// Returns the summary of the steps so far.
    pub fn course(&self) -> Course {
        call!(self, worker => worker.course())
    }

    /// Returns the time and bytes of each thread's exchange with the others so far; zeros for one alone and for a rank of a job.
    pub fn exchanges(&self) -> Vec<Exchange> {
        match self {
            Self::Threads(threads) => threads.exchanges(),
            _ => vec![Exchange::default()],
        }
    }
}
