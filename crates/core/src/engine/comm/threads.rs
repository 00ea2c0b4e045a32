//! Workers that are threads of one process and share memory.
//!
//! Messages are words in memory that all threads see; a counter tells when one is complete. Nothing is locked, and a
//! worker that waits spins briefly and then sleeps until it is woken. It does not just give way: who gives way to a busy
//! process gets the core back milliseconds later.
//!
//! Who writes a message looks whether anybody sleeps, which costs next to nothing; only then does it wake who waits for that
//! message. So a worker without a core of its own leaves the core to those that have work.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering, fence};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};

use crossbeam::utils::CachePadded;

use crate::engine::comm::{CommError, Communicator, Exchange};

/// Number of looks at a counter before sleeping, where every worker has a core of its own: some 30 µs, several steps of a small mesh.
const SPINS: u32 = 2000;
/// Number of looks at a counter after which the clock is read: some 0.1 µs.
const LOOKS_PER_TIME: u32 = 8;
/// Words of a message that are gathered at a time.
const WORDS_AT_A_TIME: usize = 4096;

/// A message and how many were written in its place so far.
#[derive(Debug)]
struct Place {
    number: usize,
    written: CachePadded<AtomicU64>,
    words: Box<[AtomicU64]>,
}

impl Place {
    fn new(number: usize, words: usize) -> Self {
        let words = (0..words).map(|_| AtomicU64::new(0)).collect();
        Self { number, written: CachePadded::new(AtomicU64::new(0)), words }
    }

    /// Writes words from the place `first` on, and counts them as a message.
    fn write(&self, first: usize, words: &[u64]) {
        self.words[first..].iter().zip(words).for_each(|(place, word)| place.store(*word, Ordering::Relaxed));
        // Who reads this count sees the words that were written before.
        self.written.store(self.written.load(Ordering::Relaxed) + 1, Ordering::Release);
    }
}

/// Time and bytes of a worker's exchange so far; nobody else writes them.
#[derive(Debug, Default)]
struct Exchanged {
    waited_nanoseconds: AtomicU64,
    halo_bytes: AtomicU64,
}

/// State that the threads share.
#[derive(Debug)]
struct Shared {
    /// Two places for each worker's part of a gathering: while the slowest still reads one, the fastest writes the next.
    gathered: Vec<[Place; 2]>,
    /// A place for what crosses each boundary.
    halos: Vec<Place>,
    parking: Parking,
    exchanged: Vec<CachePadded<Exchanged>>,
    failed: AtomicBool,
    failure: Mutex<Option<CommError>>,
    spins: u32,
}

/// One thread's end of the connection.
#[derive(Debug)]
pub struct Threads {
    rank: usize,
    shared: Arc<Shared>,
    /// Gatherings so far.
    gatherings: u64,
    /// Messages received at each boundary so far.
    received: Vec<u64>,
    /// The messages of all workers, as far as they have come.
    messages: Vec<Vec<u64>>,
}

impl Threads {
    /// The ends of `workers` threads that hand at most `halo_words` words over each of `boundaries` boundaries.
    pub fn connect(workers: usize, boundaries: usize, halo_words: usize) -> Vec<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let shared = Arc::new(Shared {
            gathered: (0..workers)
                .map(|rank| [2 * rank, 2 * rank + 1].map(|number| Place::new(number, WORDS_AT_A_TIME + 1)))
                .collect(),
            halos: (0..boundaries).map(|boundary| Place::new(2 * workers + boundary, halo_words)).collect(),
            parking: Parking::new(workers),
            exchanged: (0..workers).map(|_| CachePadded::default()).collect(),
            failed: AtomicBool::new(false),
            failure: Mutex::new(None),
            spins: if workers <= cores { SPINS } else { 0 },
        });
        let end = |rank| Self {
            rank,
            shared: shared.clone(),
            gatherings: 0,
            received: vec![0; boundaries],
            messages: vec![Vec::with_capacity(WORDS_AT_A_TIME); workers],
        };
        (0..workers).map(end).collect()
    }

    /// Returns an alarm, to tell the others of a failure with.
    pub fn alarm(&self) -> Alarm {
        Alarm { rank: self.rank, shared: self.shared.clone() }
    }

    /// Waits until `count` messages were written in a place.
    fn wait(&self, place: &Place, count: u64) -> Result<(), CommError> {
        let is_there = || place.written.load(Ordering::Acquire) >= count;
        if is_there() {
            return Ok(());
        }
        let (start, mut looks) = (Instant::now(), 0);
        let mut waited = Duration::ZERO;
        while !is_there() {
            if self.shared.failed.load(Ordering::Relaxed) {
                let failure = self.shared.failure.lock().unwrap_or_else(PoisonError::into_inner);
                let unknown = || CommError::Worker { worker: self.rank, message: "an unknown failure".into() };
                return Err(failure.clone().unwrap_or_else(unknown));
            }
            let spins = looks < self.shared.spins;
            if spins {
                std::hint::spin_loop();
            } else {
                self.shared.parking.sleep(self.rank, place.number, is_there);
            }
            looks = looks.saturating_add(1);
            // On the way, not at the end, when there is work to do; and while it spins seldom, for some clocks are slow.
            if !spins || looks % LOOKS_PER_TIME == 0 {
                waited = start.elapsed();
            }
        }
        add(&self.shared.exchanged[self.rank].waited_nanoseconds, waited.as_nanos() as u64);
        Ok(())
    }

    /// Writes a part of one's message and counts it; its first word is the length of the whole.
    fn publish(&mut self, length: usize, part: &[u64]) {
        let place = &self.shared.gathered[self.rank][(self.gatherings % 2) as usize];
        place.words[0].store(length as u64, Ordering::Relaxed);
        place.write(1, part);
        self.shared.parking.wake(place.number);
        self.gatherings += 1;
    }

    /// Waits for the part that another worker wrote last, and appends it to what came before; returns the length of the
    /// whole.
    fn collect(&mut self, from: usize) -> Result<usize, CommError> {
        let gathering = self.gatherings - 1;
        let place = &self.shared.gathered[from][(gathering % 2) as usize];
        self.wait(place, gathering / 2 + 1)?;
        let length = place.words[0].load(Ordering::Relaxed) as usize;
        let message = &mut self.messages[from];
        let missing = (length - message.len()).min(WORDS_AT_A_TIME);
        message.extend(place.words[1..=missing].iter().map(|word| word.load(Ordering::Relaxed)));
        Ok(length)
    }
}

impl Communicator for Threads {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.shared.gathered.len()
    }

    fn send_halo(&mut self, boundary: usize, _to: usize, words: &[u64]) -> Result<(), CommError> {
        let place = &self.shared.halos[boundary];
        add(&self.shared.exchanged[self.rank].halo_bytes, size_of_val(words) as u64);
        place.write(0, words);
        self.shared.parking.wake(place.number);
        Ok(())
    }

    fn receive_halo(&mut self, boundary: usize, _from: usize, words: &mut [u64]) -> Result<(), CommError> {
        // Whatever crosses a boundary goes from the owner of one sector to that of the other, so both count alike.
        self.received[boundary] += 1;
        let place = &self.shared.halos[boundary];
        self.wait(place, self.received[boundary])?;
        words.iter_mut().zip(&place.words).for_each(|(word, sent)| *word = sent.load(Ordering::Relaxed));
        Ok(())
    }

    fn all_gather(&mut self, words: &[u64], each: &mut dyn FnMut(usize, &[u64])) -> Result<(), CommError> {
        self.messages.iter_mut().for_each(Vec::clear);
        // Nearly always one part is all: who has no more writes empty ones until the longest message is through.
        let mut start = 0;
        loop {
            let end = (start + WORDS_AT_A_TIME).min(words.len());
            self.publish(words.len(), words.get(start..end).unwrap_or(&[]));
            let mut longest = 0;
            for from in 0..self.size() {
                longest = longest.max(self.collect(from)?);
            }
            start += WORDS_AT_A_TIME;
            if start >= longest {
                break;
            }
        }
        self.messages.iter().enumerate().for_each(|(from, message)| each(from, message));
        Ok(())
    }
}

/// Adds to a number that only this thread changes.
fn add(number: &AtomicU64, more: u64) {
    number.store(number.load(Ordering::Relaxed) + more, Ordering::Relaxed);
}

/// Tells the other threads that one failed, so that none waits for it, and tells what that one exchanged.
#[derive(Debug, Clone)]
pub struct Alarm {
    rank: usize,
    shared: Arc<Shared>,
}

impl Alarm {
    /// Raises the alarm; the first message stays.
    pub fn raise(&self, message: String) {
        let mut failure = self.shared.failure.lock().unwrap_or_else(PoisonError::into_inner);
        failure.get_or_insert(CommError::Worker { worker: self.rank, message });
        self.shared.failed.store(true, Ordering::Release);
        self.shared.parking.wake_all();
    }

    /// Returns the time and bytes of the worker's exchange so far.
    pub fn exchange(&self) -> Exchange {
        let Exchanged { waited_nanoseconds, halo_bytes } = &*self.shared.exchanged[self.rank];
        Exchange {
            waited: Duration::from_nanos(waited_nanoseconds.load(Ordering::Relaxed)),
            halo_bytes: halo_bytes.load(Ordering::Relaxed),
        }
    }
}

/// Longest sleep: after it a sleeper looks by itself, whatever happens.
const LONGEST: Duration = Duration::from_millis(20);

/// Value of `waits_for` while a worker waits for nothing.
const NOTHING: usize = 0;

/// A worker that may sleep.
#[derive(Debug, Default)]
struct Sleeper {
    thread: OnceLock<Thread>,
    /// Number of the place that the worker waits for, plus one.
    waits_for: AtomicUsize,
}

/// Workers that may sleep, by rank.
#[derive(Debug)]
pub(super) struct Parking {
    sleepers: Box<[CachePadded<Sleeper>]>,
    /// Number of workers that sleep.
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

    /// Wakes all that sleep.
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

#[cfg(test)]
#[path = "../../../tests/unit/engine/comm/threads.rs"]
mod tests;
