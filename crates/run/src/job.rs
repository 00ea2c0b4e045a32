//! The processes that run one scene together: this one alone, or with feature `mpi` the ranks that `mpirun` started.
//! Either way a [`Job`] looks the same. What they agree on between steps, and work of independent pieces, shared among the threads of
//! a process.

#[cfg(feature = "mpi")]
pub mod mpi;
mod ranks;

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

pub use ranks::Job;

/// Agreement of the processes of a job between steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Agreement {
    /// The signal that asks the run to stop, if there was one.
    pub signal: Option<u8>,
    /// Tells whether the state is to be kept.
    pub save: bool,
    /// Number of steps before the next agreement.
    pub steps: u64,
}

/// End of a piece of shared work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PieceEnd {
    /// Piece that is done.
    Done,
    /// Piece that failed; the others go on.
    Failed,
    /// Stop: no other piece is to be begun.
    Stopped,
    /// Piece that another process is at: it is to be looked at again after the others.
    Later,
}

/// Hands out pieces, each once, or again where it was to be later.
#[derive(Debug)]
pub struct WorkQueue {
    pieces: Mutex<VecDeque<usize>>,
    failures: AtomicUsize,
    most_failures: usize,
    stopped: AtomicBool,
}

impl WorkQueue {
    /// Queues these pieces, until so many have failed.
    pub fn new(pieces: &[usize], most_failures: Option<usize>) -> Self {
        let most_failures = most_failures.unwrap_or(usize::MAX);
        let pieces = Mutex::new(pieces.iter().copied().collect());
        Self { pieces, failures: 0.into(), most_failures, stopped: false.into() }
    }

    /// The next piece.
    pub fn next(&self) -> Option<usize> {
        if self.stopped.load(Ordering::Relaxed) || self.failures.load(Ordering::Relaxed) >= self.most_failures {
            return None;
        }
        self.waiting().pop_front()
    }

    fn waiting(&self) -> MutexGuard<'_, VecDeque<usize>> {
        self.pieces.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes note of how a piece ended.
    pub fn note(&self, piece: usize, end: PieceEnd) {
        match end {
            PieceEnd::Done => {}
            PieceEnd::Failed => drop(self.failures.fetch_add(1, Ordering::Relaxed)),
            PieceEnd::Later => self.waiting().push_back(piece),
            PieceEnd::Stopped => self.stopped.store(true, Ordering::Relaxed),
        }
    }

    /// Does pieces until there are no more.
    pub fn work(&self, work: &(dyn Fn(usize) -> PieceEnd + Sync)) {
        while let Some(piece) = self.next() {
            self.note(piece, work(piece));
        }
    }

    /// Does all pieces, on so many threads, or as many as there are pieces.
    pub fn share(
        &self,
        jobs: usize,
        work: &(dyn Fn(usize) -> PieceEnd + Sync),
    ) -> Result<(), rayon::ThreadPoolBuildError> {
        // A thread without a piece would only wait; thousands of them keep a machine busy.
        let threads = jobs.min(self.waiting().len()).max(1);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        pool.scope(|scope| (0..threads).for_each(|_| scope.spawn(|_| self.work(work))));
        Ok(())
    }
}

/// Process on its own, where the program is built without MPI.
#[cfg(not(feature = "mpi"))]
mod alone {
    use plateau_core::engine::comm::{CommError, Single};

    /// Process on its own, from the start of a job to its end.
    #[derive(Debug)]
    pub struct Session(());

    impl Session {
        /// Starts the job.
        pub fn start() -> Result<Self, CommError> {
            Ok(Self(()))
        }

        /// Communicator of one process alone.
        pub fn communicator(&self) -> Single {
            Single
        }

        /// Ends the job in good order.
        pub fn finish(self) {}

        /// Ends the job, whose process reports and ends itself as it likes.
        pub fn fail(self, _status: u8, _report: impl FnOnce()) {}
    }
}

#[cfg(test)]
#[path = "../tests/unit/job.rs"]
mod tests;
