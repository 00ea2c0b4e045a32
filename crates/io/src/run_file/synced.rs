//! Whether what was sent to the writer of a run file is on the disk.

use crossbeam::channel::{self, Receiver};

/// An answer that a writer owes.
#[derive(Debug)]
pub struct Synced {
    answers: Receiver<()>,
    /// Closed when the writer has ended. A question that it has not taken then stays in its queue, and is never answered.
    alive: Receiver<()>,
}

impl Synced {
    pub(super) fn new(answers: Receiver<()>, alive: Receiver<()>) -> Self {
        Self { answers, alive }
    }

    /// For a run file that is complete on the disk.
    pub fn already() -> Self {
        let (answer, answers) = channel::bounded(1);
        // There is room for it.
        let _ = answer.send(());
        Self { answers, alive: channel::never() }
    }

    /// Waits for the answer: whether it is on the disk.
    pub fn wait(&self) -> bool {
        crossbeam::select! {
            recv(self.answers) -> answer => answer.is_ok(),
            recv(self.alive) -> _ => self.answers.try_recv().is_ok(),
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
        assert!(!Synced::new(answers, alive).wait());
        assert!(Synced::already().wait());
    }
}
