//! What the workers of one simulation tell each other.

#[cfg(feature = "mpi")]
pub mod mpi;
#[cfg(feature = "mpi")]
mod mpi_job;
mod parking;
pub(crate) mod single;
pub(crate) mod threads;
#[cfg(feature = "mpi")]
mod work_requests;

use thiserror::Error;

use crate::model::error::SimulationError;

/// Why workers cannot go on together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CommError {
    /// A worker failed.
    #[error("worker {worker} failed: {message}")]
    Worker {
        /// Which.
        worker: usize,
        /// What it said.
        message: String,
    },
    /// MPI.
    #[cfg(feature = "mpi")]
    #[error(transparent)]
    Mpi(#[from] mpi_job::MpiError),
}

impl From<CommError> for SimulationError {
    fn from(error: CommError) -> Self {
        Self::Worker { message: error.to_string() }
    }
}

/// How a worker reaches the others.
///
/// All workers take the same steps and call [`Communicator::all_gather`] equally often; so nobody is more than one
/// call ahead.
pub trait Communicator {
    /// Which of the workers this one is.
    fn rank(&self) -> usize;

    /// How many workers there are.
    fn size(&self) -> usize;

    /// Hands a pin column that crosses the lower boundary of sector `boundary` to worker `to`.
    ///
    /// It may arrive as late as [`Communicator::receive_halo`] asks for it; this call never waits for the receiver. At
    /// most one column crosses a boundary between two calls of [`Communicator::all_gather`].
    ///
    /// # Errors
    /// [`CommError`] when a worker failed.
    fn send_halo(&mut self, boundary: usize, to: usize, words: &[u64]) -> Result<(), CommError>;

    /// The column that worker `from` handed over at this boundary in this step.
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
