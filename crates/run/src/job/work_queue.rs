//! Agreement of the processes of a job between steps, and work of independent pieces, shared among the threads of this process.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Agreement of the processes of a job between steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Agreement {
    /// The signal that asks the run to stop, if there was one.
    pub signal: Option<u8>,
    /// Tells whether the state is to be kept.
    pub save: bool,
    /// Steps before the next agreement.
    pub steps: u64,
}

/// End of a piece of shared work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PieceEnd {
    /// It is done.
    Done,
    /// It failed; the others go on.
    Failed,
    /// No more is to be begun.
    Stopped,
    /// Another process is at it: it is to be looked at again after the others.
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
    /// These pieces, until so many have failed.
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
    ///
    /// # Errors
    /// When the system gives no threads.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn done(count: usize, most_failures: Option<usize>, end: impl Fn(usize) -> PieceEnd + Sync) -> Vec<usize> {
        let pieces: Vec<usize> = (1..=count).rev().collect();
        let done = Mutex::new(Vec::new());
        let work = |piece| {
            done.lock().unwrap().push(piece);
            end(piece)
        };
        WorkQueue::new(&pieces, most_failures).share(3, &work).unwrap();
        let mut done = done.into_inner().unwrap();
        done.sort_unstable();
        done
    }

    #[test]
    fn every_piece_is_done_once() {
        assert_eq!(done(1000, None, |_| PieceEnd::Done), (1..=1000).collect::<Vec<_>>());
        assert!(done(0, None, |_| PieceEnd::Done).is_empty());
        assert_eq!(done(100, None, |_| PieceEnd::Failed).len(), 100);
    }

    #[test]
    fn what_is_to_be_later_comes_after_the_others_until_it_is_done() {
        let order = Mutex::new(Vec::new());
        let work = |piece| {
            let mut order = order.lock().unwrap();
            order.push(piece);
            let is_held = piece == 2 && order.len() < 6;
            if is_held { PieceEnd::Later } else { PieceEnd::Done }
        };
        WorkQueue::new(&[1, 2, 3, 4], None).share(1, &work).unwrap();
        assert_eq!(order.into_inner().unwrap(), [1, 2, 3, 4, 2, 2]);
    }

    #[test]
    fn no_thread_is_without_a_piece() {
        let threads = Mutex::new(0);
        let work = |_| {
            *threads.lock().unwrap() = rayon::current_num_threads();
            PieceEnd::Done
        };
        WorkQueue::new(&[1, 2, 3], None).share(10_000, &work).unwrap();
        assert_eq!(threads.into_inner().unwrap(), 3);
    }

    #[test]
    fn no_more_is_begun_after_the_last_straw() {
        assert!((2..=4).contains(&done(1000, Some(2), |_| PieceEnd::Failed).len()));
        assert!(done(1000, None, |_| PieceEnd::Stopped).len() <= 3);
    }
}
