//! Designs of studies: which runs to make, and in which order.
//!
//! Nothing here knows of simulations, files or the command line.

pub mod design;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Puts items into a random order: Fisher and Yates, from the end. Equal seeds give equal orders.
pub fn shuffle<T>(items: &mut [T], seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for last in (1..items.len()).rev() {
        // Below 2^32 items, the share of numbers that come once more often is below 2^-32.
        let other = random.next_u64() % (last as u64 + 1);
        items.swap(last, other as usize);
    }
}

#[cfg(test)]
#[path = "../tests/unit/shuffle.rs"]
mod tests;
