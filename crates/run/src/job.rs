//! The processes that run one scene together: this one alone, or with feature `mpi` the ranks that `mpirun` started.
//! Either way a [`Job`] looks the same. What they agree on between steps, and work of independent pieces, shared among the threads of
//! a process.

#[cfg(feature = "mpi")]
pub mod mpi;

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
#[cfg(feature = "mpi")]
use std::{thread, time::Duration};

use plateau_core::engine::comm::{CommError, Communicator};
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::{Execution, Simulation, SimulationError};

use crate::error::{InputError, RunError, RunFailure};

#[cfg(not(feature = "mpi"))]
use self::alone::Session;
#[cfg(feature = "mpi")]
use self::mpi::Session;

/// Between two looks for ranks that want work.
#[cfg(feature = "mpi")]
const PAUSE: Duration = Duration::from_millis(1);

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

/// This process as one of the ranks: all run the same scene, the first one writes the run file and talks to the user. Without MPI there is
/// one.
#[derive(Debug)]
pub struct Job {
    session: Session,
    /// For what the ranks settle between steps.
    meeting: Box<dyn Communicator>,
}

impl Job {
    /// Joins the other ranks.
    pub fn start() -> Result<Self, RunFailure> {
        let session = Session::start()?;
        let meeting = Box::new(session.communicator());
        Ok(Self { session, meeting })
    }

    /// Tells whether this rank writes the run file and talks to the user.
    pub fn leads(&self) -> bool {
        self.meeting.rank() == 0
    }

    /// Number of ranks.
    pub fn ranks(&self) -> usize {
        self.meeting.size()
    }

    /// The simulation that the ranks carry out together; a single rank may have threads instead.
    pub(crate) fn simulation(
        &self,
        parameters: Parameters,
        surfaces: InitialSurfaces,
        execution: Execution,
    ) -> Result<Simulation, SimulationError> {
        if self.ranks() == 1 {
            return Simulation::with_execution(parameters, surfaces, execution);
        }
        Simulation::on_ranks(parameters, surfaces, execution, Box::new(self.session.communicator()))
    }

    /// Agrees with all ranks: they stop and save if any was asked to, and take as many steps as the first, for clocks
    /// differ.
    pub fn agree(&mut self, own: Agreement) -> Result<Agreement, CommError> {
        let (mut largest, mut save, mut first) = (0, false, own.steps);
        let words = [own.signal.unwrap_or(0).into(), own.steps, own.save.into()];
        self.meeting.all_gather(&words, &mut |rank, words| {
            largest = largest.max(words[0]);
            save |= words[2] == 1;
            if rank == 0 {
                first = words[1];
            }
        })?;
        let signal = u8::try_from(largest).ok().filter(|signal| *signal != 0);
        Ok(Agreement { signal, save, steps: first })
    }

    /// Makes sure that all ranks are about to do the same, which `text` describes.
    pub(crate) fn compare(&mut self, text: &str) -> Result<(), RunError> {
        let mut first = Vec::new();
        let mut other = None;
        let words: Vec<_> = text.bytes().map(u64::from).collect();
        self.meeting.all_gather(&words, &mut |rank, words| {
            if rank == 0 {
                first = words.to_vec();
            } else if words != first {
                other = other.or(Some(rank));
            }
        })?;
        let refused = |rank| {
            InputError::Refused(format!(
                "rank {rank} was given another scene, other surfaces or another build of this program than rank 0: give all ranks the \
                 same, where the machines share no files by copying them"
            ))
        };
        other.map_or(Ok(()), |rank| Err(refused(rank).into()))
    }

    /// Does all pieces of independent work, each on one rank, until so many have failed. A single rank has as many threads
    /// as there are `jobs`, several have one each.
    pub fn share(
        &mut self,
        pieces: &[usize],
        jobs: usize,
        most_failures: Option<usize>,
        work: &(dyn Fn(usize) -> PieceEnd + Sync),
    ) -> Result<(), RunFailure> {
        #[cfg(feature = "mpi")]
        if self.ranks() > 1 {
            self.share_among_ranks(WorkQueue::new(pieces, most_failures), work);
            return Ok(());
        }
        Ok(WorkQueue::new(pieces, most_failures).share(jobs, work)?)
    }

    /// The same for several ranks: rank 0 hands the pieces out while a thread of its own works. Only its queue counts: another rank may
    /// see what is to be done a moment later, when some of it is done.
    #[cfg(feature = "mpi")]
    fn share_among_ranks(&self, queue: WorkQueue, work: &(dyn Fn(usize) -> PieceEnd + Sync)) {
        let requests = self.session.work_requests();
        if !self.leads() {
            let mut end = PieceEnd::Done;
            while let Some(piece) = requests.ask(end as u64) {
                end = work(piece);
                if end == PieceEnd::Stopped {
                    break;
                }
            }
            if end == PieceEnd::Stopped {
                requests.ask(end as u64);
            }
            return;
        }
        thread::scope(|scope| {
            let own = scope.spawn(|| queue.work(work));
            let mut given = vec![None; self.ranks()];
            let mut others = self.ranks() - 1;
            while others > 0 || !own.is_finished() {
                let Some((rank, word)) = requests.request() else {
                    thread::sleep(PAUSE);
                    continue;
                };
                let ends = [PieceEnd::Done, PieceEnd::Failed, PieceEnd::Stopped, PieceEnd::Later];
                let end = ends.into_iter().find(|end| *end as u64 == word).unwrap_or(PieceEnd::Done);
                if let Some(piece) = given[rank].take() {
                    queue.note(piece, end);
                }
                // Who stopped wants no more.
                let piece = if end == PieceEnd::Stopped { None } else { queue.next() };
                given[rank] = piece;
                others -= usize::from(piece.is_none());
                requests.answer(rank, piece);
            }
        });
    }

    /// The sums of two counts over all ranks.
    pub fn sum(&mut self, one: usize, other: usize) -> Result<(usize, usize), CommError> {
        let mut sums = (0, 0);
        self.meeting.all_gather(&[one as u64, other as u64], &mut |_, words| {
            sums = (sums.0 + words[0] as usize, sums.1 + words[1] as usize);
        })?;
        Ok(sums)
    }

    /// Leaves the other ranks in good order.
    pub fn finish(self) {
        self.session.finish();
    }

    /// Ends all ranks with this exit status after `report` said why; a single one ends itself as it likes.
    pub fn fail(self, status: u8, report: impl FnOnce()) {
        self.session.fail(status, report)
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
