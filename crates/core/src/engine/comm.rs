//! Communication between the workers of one simulation.

pub(crate) mod threads;

use std::fmt::Debug;
use std::time::Duration;

use thiserror::Error;

use crate::model::error::SimulationError;

/// Reason that workers cannot go on together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum CommError {
    #[error("worker {worker} failed: {message}")]
    Worker { worker: usize, message: String },
    /// Ranks cannot reach each other.
    #[error("{message}")]
    Ranks { message: String },
}

impl From<CommError> for SimulationError {
    fn from(error: CommError) -> Self {
        Self::Worker { message: error.to_string() }
    }
}

/// Time and bytes of a worker's exchange with the others so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Exchange {
    /// Time that the worker waited for the others.
    pub waited: Duration,
    /// Bytes that the worker handed over boundaries between sectors.
    pub halo_bytes: u64,
}

/// Connection of a worker to the others.
///
/// All workers take the same steps and call [`Communicator::all_gather`] equally often; so nobody is more than one
/// call ahead.
pub trait Communicator: Debug + Send {
    /// Returns the number of this worker, from 0.
    fn rank(&self) -> usize;

    /// Returns the number of workers.
    fn size(&self) -> usize;

    /// Hands what crosses a boundary between sectors to worker `to`.
    ///
    /// It may arrive as late as [`Communicator::receive_halo`] asks for it; this call never waits for the receiver. Messages of
    /// different kinds have boundaries of their own: at most one crosses each between two calls of [`Communicator::all_gather`].
    ///
    /// # Errors
    /// [`CommError`] when a worker failed.
    fn send_halo(&mut self, boundary: usize, to: usize, words: &[u64]) -> Result<(), CommError>;

    /// Receives what worker `from` handed over at this boundary in this step; words beyond that have no meaning.
    ///
    /// # Errors
    /// [`CommError`] when a worker failed.
    fn receive_halo(&mut self, boundary: usize, from: usize, words: &mut [u64]) -> Result<(), CommError>;

    /// Gathers a message from every worker, one's own included, and gives them to `each` in the order of the workers;
    /// lengths may differ from worker to worker and from call to call.
    ///
    /// # Errors
    /// [`CommError`] when a worker failed.
    fn all_gather(&mut self, words: &[u64], each: &mut dyn FnMut(usize, &[u64])) -> Result<(), CommError>;
}

/// Connection of a worker that is alone.
#[derive(Debug, Clone, Copy)]
pub struct Single;

impl Communicator for Single {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn send_halo(&mut self, _boundary: usize, to: usize, _words: &[u64]) -> Result<(), CommError> {
        unreachable!("worker {to} of one")
    }

    fn receive_halo(&mut self, _boundary: usize, from: usize, _words: &mut [u64]) -> Result<(), CommError> {
        unreachable!("worker {from} of one")
    }

    fn all_gather(&mut self, words: &[u64], each: &mut dyn FnMut(usize, &[u64])) -> Result<(), CommError> {
        each(0, words);
        Ok(())
    }
}
