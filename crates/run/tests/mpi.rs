//! The ranks of an MPI job, on their own. `tests/extra/mpi.sh` runs this under `mpirun` with several numbers of ranks;
//! plain `cargo test --features mpi` runs it as a single rank.
//!
//! Without an argument it exchanges messages; `panic`, `drop` and `fail` end one rank out of order while the others
//! wait for it, and `fail-alike` ends all of them with the same message.

use plateau_core::engine::comm::Communicator;
use plateau_run::job::mpi::{Mpi, Session};

const ROUNDS: u64 = 3000;
/// 100 kB: far more than an MPI library sends before the receiver is ready.
const LONG: u64 = 12_500;

fn main() {
    // A test harness that passes options of its own passes words that begin with a dash.
    let how = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let session = Session::start().expect("MPI");
    assert!(Session::start().is_err(), "MPI starts once");
    let mut ranks = session.communicator();
    for round in 0..ROUNDS {
        exchange(&mut ranks, round);
        gather(&mut ranks, round);
    }
    let last = ranks.rank() + 1 == ranks.size();
    match how.as_deref() {
        None => {}
        Some("panic") if last => panic!("rank {} panics on purpose", ranks.rank()),
        Some("drop") if last => return,
        Some("fail") if last => return session.fail(3, || eprintln!("this rank alone failed on purpose")),
        Some("fail-alike") => return session.fail(3, || eprintln!("all ranks failed on purpose")),
        // The others wait for a message that never comes.
        Some(_) => ranks.receive_halo(0, ranks.size() - 1, &mut [0]).expect("a message"),
    }
    if ranks.rank() == 0 {
        println!("{ROUNDS} rounds of {} ranks were right", ranks.size());
    }
    session.finish();
}

/// Everybody sends to everybody, oneself included, before anybody receives: two messages each, received in the other
/// order. In every third round there is a gathering in between.
fn exchange(ranks: &mut Mpi, round: u64) {
    let (rank, size) = (ranks.rank(), ranks.size());
    for boundary in [0, 1] {
        for to in 0..size {
            ranks.send_halo(boundary, to, &halo(round, boundary, rank, to)).expect("sent");
        }
    }
    if round.is_multiple_of(3) {
        gather(ranks, ROUNDS + round);
    }
    for boundary in [1, 0] {
        for from in 0..size {
            let expected = halo(round, boundary, from, rank);
            let mut words = vec![u64::MAX; expected.len()];
            ranks.receive_halo(boundary, from, &mut words).expect("received");
            assert!(words == expected, "round {round}: rank {rank} got other words from {from} for {boundary}");
        }
    }
}

/// Everybody hears everybody.
fn gather(ranks: &mut Mpi, round: u64) {
    let (rank, size) = (ranks.rank(), ranks.size());
    let mut heard = 0;
    ranks
        .all_gather(&message(round, rank), &mut |from, words| {
            assert_eq!(from, heard, "round {round}: the order of ranks");
            assert!(words == message(round, from), "round {round}: rank {rank} heard other words from {from}");
            heard += 1;
        })
        .expect("gathered");
    assert_eq!(heard, size);
}

/// What `from` sends to `to` for a boundary: a column of 240 words, and every 16th time a long one.
fn halo(round: u64, boundary: usize, from: usize, to: usize) -> Vec<u64> {
    let mut stream = Stream(round << 24 | (boundary as u64) << 16 | (from as u64) << 8 | to as u64);
    let length = if stream.next().is_multiple_of(16) { LONG } else { 240 };
    (0..length).map(|_| stream.next()).collect()
}

/// What a rank says in a round: at first one word more in every round, said by every other rank, so that no length
/// is left out; then mostly a few words, at times none, at times many.
fn message(round: u64, rank: usize) -> Vec<u64> {
    let mut stream = Stream(!(round << 8 | rank as u64));
    let length = match stream.next() % 64 {
        _ if round < 1200 => round.saturating_sub((round + rank as u64) % 2),
        0 => 0,
        1 => stream.next() % LONG,
        2..8 => stream.next() % 2000,
        _ => 20 + stream.next() % 20,
    };
    (0..length).map(|_| stream.next()).collect()
}

/// A reproducible stream of words (SplitMix64).
struct Stream(u64);

impl Stream {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        word ^ (word >> 31)
    }
}
