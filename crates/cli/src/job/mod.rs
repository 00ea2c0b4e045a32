//! The processes that run one scene together: this one alone, or with feature `mpi` the ranks that `mpirun` started.
//! Either way a [`Job`] looks the same to the commands.

#[cfg(not(feature = "mpi"))]
mod alone;
#[cfg(feature = "mpi")]
mod ranks;

#[cfg(not(feature = "mpi"))]
pub use alone::Job;
#[cfg(feature = "mpi")]
pub use ranks::Job;
