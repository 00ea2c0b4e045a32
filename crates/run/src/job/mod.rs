//! The processes that run one scene together: this one alone, or with feature `mpi` the ranks that `mpirun` started.
//! Either way a [`Job`] looks the same.

#[cfg(not(feature = "mpi"))]
mod alone;
#[cfg(feature = "mpi")]
mod ranks;

mod work_queue;

#[cfg(not(feature = "mpi"))]
pub use alone::Job;
#[cfg(feature = "mpi")]
pub use ranks::Job;

/// What the processes of a job settle between steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Agreement {
    /// The signal that asks the run to stop, if there was one.
    pub signal: Option<u8>,
    /// Whether the state is to be kept.
    pub save: bool,
    /// Steps before the next agreement.
    pub steps: u64,
}

/// How a piece of shared work ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PieceEnd {
    /// It is done.
    Done,
    /// It failed; the others go on.
    Failed,
    /// No more is to be begun.
    Stopped,
}
