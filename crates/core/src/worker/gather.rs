//! Putting together what all workers read and moved.
//!
//! A message holds sums by row, as integers: adding those of the others gives every worker the same totals, whoever
//! swept which columns.

use super::Worker;
use crate::comm::Communicator;
use crate::exact::{Exact, RowIntegers};
use crate::kernel::{Moved, NearPair, Reading};
use crate::simulation::SimulationError;

impl<C: Communicator> Worker<C> {
    /// Adds what the other workers read, and after a sweep what they moved, to one's own.
    pub(super) fn gather(&mut self, swept: bool) -> Result<(), SimulationError> {
        if self.communicator.size() == 1 {
            return Ok(());
        }
        let own = self.communicator.rank();
        let (message, reading, moved) = (&mut self.message, &mut self.reading, &mut self.moved);
        message.clear();
        write_reading(message, reading);
        if swept {
            write_moved(message, moved);
        }
        self.communicator.all_gather(message, &mut |from, words| {
            if from != own {
                let mut words = Words(words);
                add_reading(&mut words, reading);
                if swept {
                    add_moved(&mut words, moved);
                }
            }
        })?;
        Ok(())
    }
}

/// A message as far as it is still to be read.
struct Words<'a>(&'a [u64]);

impl<'a> Words<'a> {
    fn take(&mut self, count: usize) -> &'a [u64] {
        let (taken, rest) = self.0.split_at(count);
        self.0 = rest;
        taken
    }

    fn one(&mut self) -> u64 {
        self.take(1)[0]
    }
}

fn rows_of(rows: &RowIntegers) -> usize {
    8 * rows.0.len()
}

fn write_reading(message: &mut Vec<u64>, reading: &Reading) {
    message.push(reading.range as u64);
    message.push(reading.near.len() as u64);
    for near in &reading.near {
        message.extend([near.gap.to_bits(), u64::from(near.row) << 8 | u64::from(near.pair)]);
    }
    for (touching, overlap) in reading.touching.iter().zip(&reading.overlap) {
        if touching.0.is_empty() {
            continue;
        }
        // Statuses that touch nowhere, as resin mostly, are left out.
        let touches = touching.0.iter().any(|chunk| *chunk != [0; 8]);
        message.push(u64::from(touches));
        if touches {
            // A column count fits 32 bits: two rows a word.
            message.extend(touching.0.iter().flat_map(|chunk| {
                let [a, b, c, d, e, f, g, h] = chunk.map(|count| count as u64);
                [a | b << 32, c | d << 32, e | f << 32, g | h << 32]
            }));
            message.extend(overlap.words());
        }
    }
}

fn add_reading(words: &mut Words, reading: &mut Reading) {
    reading.range |= words.one() as i64;
    for _ in 0..words.one() {
        let (gap, cell) = (words.one(), words.one());
        reading.near.push(NearPair { gap: f64::from_bits(gap), row: (cell >> 8) as u32, pair: cell as u8 });
    }
    for (touching, overlap) in reading.touching.iter_mut().zip(&mut reading.overlap) {
        if touching.0.is_empty() || words.one() == 0 {
            continue;
        }
        let counts = words.take(rows_of(touching) / 2);
        for (chunk, counts) in touching.0.iter_mut().zip(counts.chunks_exact(4)) {
            for (pair, count) in chunk.chunks_exact_mut(2).zip(counts) {
                pair[0] += (count & 0xffff_ffff) as i64;
                pair[1] += (count >> 32) as i64;
            }
        }
        overlap.add(words.take(rows_of(overlap)));
    }
}

fn write_moved(message: &mut Vec<u64>, moved: &Moved) {
    for rows in [&moved.deposited_pin, &moved.deposited_disc, &moved.spared_pin, &moved.spared_disc] {
        message.extend(rows.words());
    }
    message.push(u64::from(moved.seldom.happened));
    if moved.seldom.happened {
        message.extend(moved.seldom.returned.iter().chain(&moved.seldom.spared).flat_map(|height| height.words()));
    }
}

fn add_moved(words: &mut Words, moved: &mut Moved) {
    for rows in [&mut moved.deposited_pin, &mut moved.deposited_disc, &mut moved.spared_pin, &mut moved.spared_disc] {
        rows.add(words.take(rows_of(rows)));
    }
    if words.one() == 1 {
        let seldom = &mut moved.seldom;
        seldom.happened = true;
        for height in seldom.returned.iter_mut().chain(&mut seldom.spared) {
            height.add(Exact::of_words(words.one(), words.one()));
        }
    }
}
