//! Workers that are ranks of an MPI job (feature `mpi`): every rank runs the same program in a process of its own,
//! on one machine or on several.
//!
//! Errors inside the MPI library end the whole job by themselves, as the MPI standard has it (`MPI_ERRORS_ARE_FATAL`,
//! MPI 3.1, section 8.3).

use std::cell::Cell;
use std::rc::Rc;
use std::time::Duration;
use std::{fmt, thread};

use ::mpi::datatype::PartitionMut;
use ::mpi::environment::{Threading, Universe};
use ::mpi::topology::SimpleCommunicator;
use ::mpi::traits::{Communicator as _, CommunicatorCollectives, Destination, Equivalence, Source};
use ::mpi::{Count, Rank, Tag};

use plateau_core::engine::comm::{CommError, Communicator};
use send_wrapper::SendWrapper;

/// Words beyond which a message of `all_gather` goes in a second round every time: rare long messages must not make
/// the many short ones slow.
const LONGEST_SLOT: usize = 1024;

/// Time for which a rank that failed waits for rank 0 to report the same and end all: what fails is mostly the same on all ranks,
/// and rank 0 may have a file to close.
const HEAD_START: Duration = Duration::from_secs(5);

/// Process as one rank of an MPI job, from the start to the end of MPI.
///
/// A job ends well only when every rank says so with [`Session::finish`]. A session that is dropped otherwise, by a
/// panic or a forgotten path, ends all ranks with exit status 1, because the others would wait for this one for ever.
#[derive(Debug)]
pub struct Session {
    job: Rc<Job>,
}

impl Session {
    /// Starts MPI; a process that no launcher started is the only rank. To be called on the main thread, once, before
    /// the program starts other threads. Only the main thread may talk to other ranks.
    ///
    /// # Errors
    /// [`MpiError::StartedBefore`] the second time, [`MpiError::Threads`] when no program with threads may use the
    /// library.
    pub fn start() -> Result<Self, CommError> {
        Ok(Self { job: Rc::new(Job::start()?) })
    }

    /// A way to talk to the other ranks. MPI ends when the session and all of them are gone.
    #[must_use]
    pub fn communicator(&self) -> Mpi {
        let world = &self.job.world();
        Mpi {
            rank: world.rank().unsigned_abs() as usize,
            size: world.size().unsigned_abs() as usize,
            slot: 0,
            outgoing: Vec::new(),
            incoming: Vec::new(),
            job: SendWrapper::new(Rc::clone(&self.job)),
        }
    }

    /// Requests of this rank for pieces of independent work, or answers to them.
    #[must_use]
    pub fn work_requests(&self) -> WorkRequests {
        WorkRequests { job: Rc::clone(&self.job) }
    }

    /// Ends this rank's part in good order. Waits for the other ranks to do the same.
    pub fn finish(self) {
        self.job.finish();
    }

    /// Ends all ranks with this exit status after `report` said why. Rank 0 reports at once; another rank does so only
    /// if the job still runs after some seconds: rank 0 has then not failed in the same way. A single rank leaves MPI in
    /// good order, and ends itself as it likes.
    pub fn fail(self, status: u8, report: impl FnOnce()) {
        let world = self.job.world();
        if world.size() == 1 {
            return self.finish();
        }
        if world.rank() != 0 {
            thread::sleep(HEAD_START);
        }
        report();
        world.abort(status.into())
    }
}

/// The ranks of a job as workers of one simulation. All ranks must make the same calls of
/// [`all_gather`](Communicator::all_gather) in the same order.
#[derive(Debug)]
pub struct Mpi {
    rank: usize,
    size: usize,
    /// Words of a message that fit into the first round of `all_gather`; equal on all ranks.
    slot: usize,
    /// Part of this rank in the first round: the length of its message, then its first `slot` words.
    outgoing: Vec<u64>,
    /// Words that a round brought, in order of rank.
    incoming: Vec<u64>,
    /// Job, to be used only by the thread that started MPI, which is all that MPI was promised.
    job: SendWrapper<Rc<Job>>,
}

impl Communicator for Mpi {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    /// A buffered send: MPI copies the message and delivers it whenever the receiver is ready.
    fn send_halo(&mut self, boundary: usize, to: usize, words: &[u64]) -> Result<(), CommError> {
        count(words.len())?;
        self.job.world().process_at_rank(to as Rank).buffered_send_with_tag(words, tag(boundary)?);
        Ok(())
    }

    fn receive_halo(&mut self, boundary: usize, from: usize, words: &mut [u64]) -> Result<(), CommError> {
        let most = words.len();
        let status = self.job.world().process_at_rank(from as Rank).receive_into_with_tag(words, tag(boundary)?);
        let found = status.count(u64::equivalent_datatype()).unsigned_abs() as usize;
        if found > most {
            return Err(MpiError::Halo { from, boundary, found, most }.into());
        }
        Ok(())
    }

    /// One round of messages of equal length does where nobody's message is longer than in earlier calls; all ranks see
    /// all lengths and so agree on whether a second round is needed.
    fn all_gather(&mut self, words: &[u64], each: &mut dyn FnMut(usize, &[u64])) -> Result<(), CommError> {
        if self.size == 1 {
            each(0, words);
            return Ok(());
        }
        let stride = self.gather_slots(words);
        let longest = self.incoming.iter().step_by(stride).max().map_or(0, |&length| length as usize);
        if longest > self.slot {
            let lengths: Vec<_> = self.incoming.iter().step_by(stride).map(|&length| length as usize).collect();
            if longest <= LONGEST_SLOT {
                self.slot = longest;
            }
            return self.gather_all(words, &lengths, each);
        }
        for (rank, part) in self.incoming.chunks_exact(stride).enumerate() {
            each(rank, &part[1..=part[0] as usize]);
        }
        Ok(())
    }
}

impl Mpi {
    /// The first round: every length and as much of every message as fits. Gives the words from one rank to the next.
    fn gather_slots(&mut self, words: &[u64]) -> usize {
        let stride = 1 + self.slot;
        self.outgoing.clear();
        self.outgoing.push(words.len() as u64);
        self.outgoing.extend(words.iter().take(self.slot));
        self.outgoing.resize(stride, 0);
        self.incoming.resize(stride * self.size, 0);
        self.job.world().all_gather_into(&self.outgoing[..], &mut self.incoming[..]);
        stride
    }

    /// The second round: messages of known lengths.
    fn gather_all(
        &mut self,
        words: &[u64],
        lengths: &[usize],
        each: &mut dyn FnMut(usize, &[u64]),
    ) -> Result<(), CommError> {
        let total = lengths.iter().sum();
        count(total)?;
        let counts: Vec<_> = lengths.iter().map(|&length| length as Count).collect();
        let starts: Vec<_> =
            counts.iter().scan(0, |next, count| Some(std::mem::replace(next, *next + count))).collect();
        self.incoming.resize(total, 0);
        let mut parts = PartitionMut::new(&mut self.incoming[..], counts, starts);
        self.job.world().all_gather_varcount_into(words, &mut parts);
        let mut rest = &self.incoming[..];
        for (rank, &length) in lengths.iter().enumerate() {
            let (part, after) = rest.split_at(length);
            each(rank, part);
            rest = after;
        }
        Ok(())
    }
}

fn tag(boundary: usize) -> Result<Tag, MpiError> {
    if boundary > LARGEST_TAG { Err(MpiError::Boundary { boundary }) } else { Ok(boundary as Tag) }
}

/// Refuses a number of words that MPI cannot count.
fn count(words: usize) -> Result<(), MpiError> {
    if words > Count::MAX as usize { Err(MpiError::Length { words }) } else { Ok(()) }
}

/// Largest tag that every MPI library takes (MPI 3.1, section 8.1.2).
const LARGEST_TAG: usize = 32_767;

/// Bytes for halo messages on their way. As all ranks meet in every step, these are the messages of two steps at most.
/// The system gives memory only for the part that is used.
const SEND_BUFFER: usize = 64 << 20;

/// Reason why ranks cannot talk to each other.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum MpiError {
    #[error("MPI was started before in this process")]
    StartedBefore,
    #[error("this MPI library gives thread support {found:?}, at least Funneled is needed: use one built with threads")]
    Threads { found: Threading },
    #[error("messages cross boundary {boundary}, MPI tells at most {LARGEST_TAG} apart: use fewer ranks or columns")]
    Boundary { boundary: usize },
    #[error("a message of {words} words, MPI takes at most {}: use a smaller mesh", Count::MAX)]
    Length { words: usize },
    #[error("rank {from} sent {found} words across boundary {boundary}, expected at most {most}")]
    Halo { from: usize, boundary: usize, found: usize, most: usize },
}

impl From<MpiError> for CommError {
    fn from(error: MpiError) -> Self {
        Self::Ranks { message: error.to_string() }
    }
}

/// Connection of this rank to MPI; dropped before the rank is done, it ends all ranks.
struct Job {
    finished: Cell<bool>,
    world: SimpleCommunicator,
    /// Ends MPI when it is dropped, and waits for the other ranks then.
    _universe: Universe,
}

impl Job {
    fn start() -> Result<Self, MpiError> {
        let (mut universe, threading) =
            ::mpi::initialize_with_threading(Threading::Funneled).ok_or(MpiError::StartedBefore)?;
        if threading < Threading::Funneled {
            return Err(MpiError::Threads { found: threading });
        }
        universe.set_buffer_size(SEND_BUFFER);
        Ok(Self { finished: Cell::new(false), world: universe.world(), _universe: universe })
    }

    /// Notes that this rank is done: from here on MPI may end in good order.
    fn finish(&self) {
        self.finished.set(true);
    }

    /// Communicator of all ranks.
    fn world(&self) -> &SimpleCommunicator {
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

/// Tag of requests to rank 0, and of its answers.
const TAG: Tag = 0;
/// The answer when there is nothing more to do.
const NOTHING: u64 = u64::MAX;

/// One end of a queue at rank 0 of pieces of independent work for the ranks of the job: rank 0 answers, the others ask. Who is done asks
/// for the next piece, so quick ranks get more of them.
#[derive(Debug)]
pub struct WorkRequests {
    job: Rc<Job>,
}

impl WorkRequests {
    /// Returns on rank 0 the rank that asks, with its word, if one does.
    pub fn request(&self) -> Option<(usize, u64)> {
        let anybody = self.job.world().any_process();
        let status = anybody.immediate_probe_with_tag(TAG)?;
        let from = self.job.world().process_at_rank(status.source_rank());
        let (word, _) = from.receive_with_tag::<u64>(TAG);
        Some((status.source_rank().unsigned_abs() as usize, word))
    }

    /// Answers on rank 0 a rank that asked.
    pub fn answer(&self, rank: usize, piece: Option<usize>) {
        let word = piece.map_or(NOTHING, |piece| piece as u64);
        self.job.world().process_at_rank(rank as Rank).send_with_tag(&word, TAG);
    }

    /// Asks from another rank: tells rank 0 a word and waits for the next piece; none when there are no more.
    pub fn ask(&self, word: u64) -> Option<usize> {
        let first = self.job.world().process_at_rank(0);
        first.send_with_tag(&word, TAG);
        let (answer, _) = first.receive_with_tag::<u64>(TAG);
        (answer != NOTHING).then_some(answer as usize)
    }
}
