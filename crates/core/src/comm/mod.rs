//! What the workers of one simulation tell each other.

#[cfg(feature = "mpi")]
pub mod mpi;

/// What the workers of one simulation tell each other. All messages are words of 64 bits; floating-point numbers
/// travel as their bits.
pub trait Communicator {
    /// Which worker this is, counted from 0.
    fn rank(&self) -> usize;

    /// How many workers there are.
    fn size(&self) -> usize;

    /// Hands a message (a pin column that crosses the lower boundary of sector `boundary`) to worker `to`; it may be
    /// delivered as late as in [`Self::receive_halo`]. Never blocks on the receiver.
    ///
    /// # Errors
    /// When the message cannot be sent.
    fn send_halo(&mut self, boundary: usize, to: usize, words: &[u64]) -> Result<(), CommError>;

    /// The message that worker `from` sent for this boundary in this step.
    ///
    /// # Errors
    /// When no such message of this length can come.
    fn receive_halo(&mut self, boundary: usize, from: usize, words: &mut [u64]) -> Result<(), CommError>;

    /// Gathers a message of any length from every worker, one's own included, and gives them to `each` in order of
    /// rank; lengths differ from worker to worker and from call to call.
    ///
    /// # Errors
    /// When a worker is lost or the messages are too long.
    fn all_gather(&mut self, words: &[u64], each: &mut dyn FnMut(usize, &[u64])) -> Result<(), CommError>;
}

/// Why workers cannot talk to each other.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CommError {
    /// MPI.
    #[cfg(feature = "mpi")]
    #[error(transparent)]
    Mpi(#[from] mpi::MpiError),
}
