//! A bound on the memory of this process while a library is at work that takes what a damaged file asks for.
//!
//! The system bounds a process, not a thread. So there is one bound at a time, what can be had is not asked meanwhile, and where several
//! runs are made at once, a bound leaves what the others may need.

use std::sync::{Mutex, MutexGuard, PoisonError};

use rlimit::Resource;

use super::system;

/// Pieces of work that are being done. Who holds this also holds the bound.
static AT_WORK: Mutex<usize> = Mutex::new(0);

fn hold() -> MutexGuard<'static, usize> {
    // It is a count, which a panic of another thread cannot leave half done.
    AT_WORK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A piece of work with memory of its own, such as a run of a study, as long as it lives. Where there are several in this process, the
/// bound of one is no tighter than what the system has left, for beyond it the program would end in all of them.
#[derive(Debug)]
pub struct AtWork(());

impl AtWork {
    /// One more piece of work; waits while there is a bound that does not know of it.
    pub fn begin() -> Self {
        *hold() += 1;
        Self(())
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        *hold() -= 1;
    }
}

/// The limits of the address space before they were made tighter: put back at the end, also after a panic.
struct Before(u64, u64);

impl Drop for Before {
    fn drop(&mut self) {
        let _ = Resource::AS.set(self.0, self.1);
    }
}

/// Does `work` with at most `more` bytes beyond what the process has now. Where the system does not tell that, or takes no
/// limits, there is no bound. `work` must not ask for what can be had, and begin no piece of work.
pub(crate) fn bounded<T>(more: u64, work: impl FnOnce() -> T) -> T {
    let at_work = hold();
    let others = if *at_work > 1 { system::available().unwrap_or(u64::MAX) } else { 0 };
    let _before = Resource::AS.get().ok().zip(system::address_space()).map(|((soft, hard), now)| {
        let bound = now.saturating_add(more).saturating_add(others);
        let _ = Resource::AS.set(bound.min(soft), hard);
        Before(soft, hard)
    });
    work()
}

/// Asks the system while there is no bound, so that it says what all of the process may have.
pub(super) fn unbounded<T>(ask: impl FnOnce() -> T) -> T {
    let _none = hold();
    ask()
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;
    use std::thread;
    use std::time::Duration;

    use super::*;
    use crate::memory::refuse_beyond;

    /// Other tests of this process go on meanwhile.
    const MOST_ELSEWHERE: u64 = 1 << 30;

    fn is_there(bytes: usize) -> bool {
        Vec::<u8>::new().try_reserve_exact(bytes).is_ok()
    }

    #[test]
    fn more_than_the_bound_is_not_to_be_had_but_by_others() {
        let bytes = 4 << 30;
        assert!(!bounded(MOST_ELSEWHERE, || is_there(bytes)));
        assert!(is_there(bytes));
        let panicked = thread::spawn(|| bounded(MOST_ELSEWHERE, || panic!("a mistake")));
        assert!(panicked.join().is_err());
        assert!(is_there(bytes));
        // Several pieces of work, each of which takes what it needs.
        let _works = [AtWork::begin(), AtWork::begin()];
        let another = bounded(0, || thread::spawn(move || is_there(bytes / 2)).join());
        assert!(another.unwrap(), "this needs a machine with 2 GiB of free memory");
    }

    #[test]
    fn a_bound_is_not_taken_for_what_can_be_had() {
        let (give, take) = channel();
        let ask = move || give.send(refuse_beyond(MOST_ELSEWHERE + 1)).unwrap();
        // The thread would answer at once: that half of a second shows only what is wrong.
        let early = bounded(MOST_ELSEWHERE, || {
            thread::spawn(ask);
            take.recv_timeout(Duration::from_millis(500)).ok()
        });
        assert_eq!(early.unwrap_or_else(|| take.recv().unwrap()), Ok(()));
    }
}
