//! Workers that sleep until the message for which they wait is written.
//!
//! Who writes a message looks whether anybody sleeps, which costs next to nothing; only then does it wake who waits for that
//! message. So a worker without a core of its own leaves the core to those that have work.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering, fence};
use std::thread::{self, Thread};
use std::time::Duration;

use crossbeam::utils::CachePadded;

/// After so long a sleeper looks by itself, whatever happens.
const LONGEST: Duration = Duration::from_millis(20);

/// What a sleeper waits for while it waits for nothing.
const NOTHING: usize = 0;

/// A worker that may sleep.
#[derive(Debug, Default)]
struct Sleeper {
    thread: OnceLock<Thread>,
    /// The number of the place that it waits for, plus one.
    waits_for: AtomicUsize,
}

/// Where workers sleep, by rank.
#[derive(Debug)]
pub(super) struct Parking {
    sleepers: Box<[CachePadded<Sleeper>]>,
    /// How many sleep.
    sleeping: CachePadded<AtomicUsize>,
}

impl Parking {
    /// Room for so many workers.
    pub fn new(workers: usize) -> Self {
        Self { sleepers: (0..workers).map(|_| CachePadded::default()).collect(), sleeping: CachePadded::default() }
    }

    /// Sleeps until a message is written in a place, unless it is there already; may return earlier.
    pub fn sleep(&self, rank: usize, place: usize, is_there: impl Fn() -> bool) {
        let Sleeper { thread, waits_for } = &*self.sleepers[rank];
        thread.get_or_init(thread::current);
        waits_for.store(place + 1, Ordering::Relaxed);
        self.sleeping.fetch_add(1, Ordering::SeqCst);
        // Either this worker sees the message here, or who wrote it sees this worker in `wake`.
        fence(Ordering::SeqCst);
        if !is_there() {
            thread::park_timeout(LONGEST);
        }
        self.sleeping.fetch_sub(1, Ordering::SeqCst);
        waits_for.store(NOTHING, Ordering::Relaxed);
    }

    /// Wakes who sleeps until a message is written in a place: it has been.
    #[inline]
    pub fn wake(&self, place: usize) {
        fence(Ordering::SeqCst);
        if self.sleeping.load(Ordering::Relaxed) > 0 {
            self.unpark(|waits_for| waits_for == place + 1);
        }
    }

    /// Wakes all.
    pub fn wake_all(&self) {
        self.unpark(|waits_for| waits_for != NOTHING);
    }

    #[cold]
    fn unpark(&self, is_waited_for: impl Fn(usize) -> bool) {
        for sleeper in &self.sleepers {
            if is_waited_for(sleeper.waits_for.load(Ordering::Relaxed))
                && let Some(thread) = sleeper.thread.get()
            {
                thread.unpark();
            }
        }
    }
}
