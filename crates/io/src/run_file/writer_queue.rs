//! The queues before the thread that writes a run file, and the answers that it owes.

use std::time::{Duration, Instant};

use crossbeam::channel::{self, Receiver, Sender, TrySendError};
use plateau_core::observe::{Sample, Snapshot};

use super::Image;

/// What a simulation sends to the thread that writes.
#[derive(Debug)]
pub(super) struct Queues {
    pub(super) samples: Sender<Sample>,
    pub(super) snapshots: Sender<Snapshot>,
    pub(super) syncs: Sender<Sender<Vec<Image>>>,
    /// See [`Synced`].
    pub(super) alive: Receiver<()>,
}

/// Sends and adds to `waited` how long that took if the queue was full; false when nobody receives any more.
pub(super) fn send<T>(queue: &Sender<T>, value: T, waited: &mut Duration) -> bool {
    match queue.try_send(value) {
        Ok(()) => true,
        Err(TrySendError::Disconnected(_)) => false,
        Err(TrySendError::Full(value)) => {
            let start = Instant::now();
            let sent = queue.send(value).is_ok();
            *waited += start.elapsed();
            sent
        }
    }
}

/// An answer that a writer owes: whether what was sent to it is on the disk.
#[derive(Debug)]
pub struct Synced {
    answers: Receiver<Vec<Image>>,
    /// Closed when the writer has ended. A question that it has not taken then stays in its queue, and is never answered.
    alive: Receiver<()>,
}

impl Synced {
    /// The answer to a question that was put to a writer, for as long as that is alive.
    pub(super) fn new(answers: Receiver<Vec<Image>>, alive: Receiver<()>) -> Self {
        Self { answers, alive }
    }

    /// For a run file that is complete on the disk.
    pub fn already() -> Self {
        let (answer, answers) = channel::bounded(1);
        // There is room for it.
        let _ = answer.send(Vec::new());
        Self { answers, alive: channel::never() }
    }

    /// Waits for the answer: the image of the file as it is on the disk, if it is there; none of a file that is closed.
    pub fn wait(&self) -> Option<Vec<Image>> {
        crossbeam::select! {
            recv(self.answers) -> answer => answer.ok(),
            recv(self.alive) -> _ => self.answers.try_recv().ok(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_question_that_nobody_takes_is_answered_with_no() {
        let (questions, taken) = channel::bounded(1);
        let (life, alive) = channel::bounded(0);
        let (answer, answers) = channel::bounded(1);
        questions.send(answer).unwrap();
        drop((taken, life));
        assert_eq!(Synced::new(answers, alive).wait(), None);
        assert_eq!(Synced::already().wait(), Some(Vec::new()));
    }
}
