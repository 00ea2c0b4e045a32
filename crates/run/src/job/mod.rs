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
pub use work_queue::{Agreement, PieceEnd};
