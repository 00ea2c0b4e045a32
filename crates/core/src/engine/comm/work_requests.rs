//! A queue at rank 0 of pieces of independent work for the ranks of an MPI job (feature `mpi`): who is done asks for the
//! next piece, so quick ranks get more of them.

use std::rc::Rc;

use ::mpi::topology::Communicator as _;
use ::mpi::traits::{Destination, Source};
use ::mpi::{Rank, Tag};

use super::mpi_job::Job;

/// Tag of requests to rank 0, and of its answers.
const TAG: Tag = 0;
/// The answer when there is nothing more to do.
const NOTHING: u64 = u64::MAX;

/// One end of the queue: rank 0 answers, the others ask.
#[derive(Debug)]
pub struct WorkRequests {
    job: Rc<Job>,
}

impl WorkRequests {
    pub(super) fn new(job: Rc<Job>) -> Self {
        Self { job }
    }

    /// On rank 0: who asks and with which word, if somebody does.
    pub fn request(&self) -> Option<(usize, u64)> {
        let anybody = self.job.world().any_process();
        let status = anybody.immediate_probe_with_tag(TAG)?;
        let from = self.job.world().process_at_rank(status.source_rank());
        let (word, _) = from.receive_with_tag::<u64>(TAG);
        Some((status.source_rank().unsigned_abs() as usize, word))
    }

    /// On rank 0: the answer to a rank that asked.
    pub fn answer(&self, rank: usize, piece: Option<usize>) {
        let word = piece.map_or(NOTHING, |piece| piece as u64);
        self.job.world().process_at_rank(rank as Rank).send_with_tag(&word, TAG);
    }

    /// On another rank: tells rank 0 a word and waits for the next piece; none when there are no more.
    pub fn ask(&self, word: u64) -> Option<usize> {
        let first = self.job.world().process_at_rank(0);
        first.send_with_tag(&word, TAG);
        let (answer, _) = first.receive_with_tag::<u64>(TAG);
        (answer != NOTHING).then_some(answer as usize)
    }
}
