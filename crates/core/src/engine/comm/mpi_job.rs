//! An MPI job (feature `mpi`) from the start of MPI to its end, and what can go wrong in one.

use std::cell::Cell;
use std::fmt;
use std::thread;

use ::mpi::Count;
use ::mpi::environment::{Threading, Universe};
use ::mpi::topology::SimpleCommunicator;
use ::mpi::traits::Communicator as _;

/// Largest tag that every MPI library takes (MPI 3.1, section 8.1.2).
pub(super) const LARGEST_TAG: usize = 32_767;

/// Bytes for halo messages on their way. As all ranks meet in every step, these are the messages of two steps at most.
/// The system gives memory only for the part that is used.
const SEND_BUFFER: usize = 64 << 20;

/// Why ranks cannot talk to each other.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MpiError {
    /// MPI can be started once in the life of a process.
    #[error("MPI was started before in this process")]
    StartedBefore,
    /// The library serves programs of one thread only.
    #[error("this MPI library gives thread support {found:?}, at least Funneled is needed: use one built with threads")]
    Threads {
        /// What the library gives.
        found: Threading,
    },
    /// The number of a boundary is no valid tag.
    #[error("the ring has a sector {boundary}, MPI tells at most {LARGEST_TAG} apart: use fewer ranks or columns")]
    Boundary {
        /// The sector.
        boundary: usize,
    },
    /// A message is too long for the counts of MPI, which have 32 bits.
    #[error("a message of {words} words, MPI takes at most {}: use a smaller mesh", Count::MAX)]
    Length {
        /// Its length.
        words: usize,
    },
    /// A halo message is shorter than it must be.
    #[error("rank {from} sent {found} words for the boundary of sector {boundary}, expected {expected}")]
    Halo {
        /// The sender.
        from: usize,
        /// The sector.
        boundary: usize,
        /// Words that came.
        found: usize,
        /// Words of a halo column.
        expected: usize,
    },
}

/// What ends with MPI; a job that is dropped before this rank is done ends all ranks.
pub(super) struct Job {
    finished: Cell<bool>,
    world: SimpleCommunicator,
    /// Ends MPI when it is dropped, and waits for the other ranks then.
    _universe: Universe,
}

impl Job {
    /// Starts MPI.
    pub(super) fn start() -> Result<Self, MpiError> {
        let (mut universe, threading) =
            ::mpi::initialize_with_threading(Threading::Funneled).ok_or(MpiError::StartedBefore)?;
        if threading < Threading::Funneled {
            return Err(MpiError::Threads { found: threading });
        }
        universe.set_buffer_size(SEND_BUFFER);
        Ok(Self { finished: Cell::new(false), world: universe.world(), _universe: universe })
    }

    /// This rank is done: from here on MPI may end in good order.
    pub(super) fn finish(&self) {
        self.finished.set(true);
    }

    /// All ranks.
    pub(super) fn world(&self) -> &SimpleCommunicator {
        &self.world
    }
}

impl Drop for Job {
    fn drop(&mut self) {
        if !self.finished.get() || thread::panicking() {
            self.world.abort(1);
        }
    }
}

impl fmt::Debug for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Job").field("rank", &self.world.rank()).field("size", &self.world.size()).finish()
    }
}
