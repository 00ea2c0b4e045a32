//! Putting together what all workers read and moved.

use super::Worker;
use crate::engine::comm::Communicator;
use crate::engine::kernel::{Bracket, NearPair, Reading};
use crate::model::error::SimulationError;

impl<C: Communicator> Worker<C> {
    /// The sums over all workers after a pass that read the next step against a bracket.
    pub(super) fn gather_pass(&mut self, bracket: &Bracket) -> Result<(), SimulationError> {
        self.sums.take_reading(&self.weights, &self.reading, bracket);
        if let Some(taken) = &self.bracket {
            self.sums.take_moved(&self.weights, &self.moved, taken, self.contact.displacement());
        }
        self.exchange(true)
    }

    /// The sums over all workers after the coming step was read once more.
    pub(super) fn gather_reading(&mut self, bracket: &Bracket) -> Result<(), SimulationError> {
        self.sums.take_reading(&self.weights, &self.reading, bracket);
        self.exchange(false)
    }

    /// Adds the sums of the other workers to one's own.
    fn exchange(&mut self, moved: bool) -> Result<(), SimulationError> {
        if self.communicator.size() == 1 {
            return Ok(());
        }
        let own = self.communicator.rank();
        let Self { communicator, message, reading, sums, weights, .. } = self;
        message.clear();
        write_near(message, reading);
        sums.write_reading(weights, message);
        if moved {
            sums.write_moved(message);
        }
        communicator.all_gather(message, &mut |from, words| {
            if from != own {
                let mut words = words.iter().copied();
                add_near(&mut words, reading);
                sums.add_reading(weights, &mut words);
                if moved {
                    sums.add_moved(&mut words);
                }
            }
        })?;
        Ok(())
    }
}

fn write_near(message: &mut Vec<u64>, reading: &Reading) {
    message.push(reading.largest().to_bits());
    message.push(reading.near.len() as u64);
    for near in &reading.near {
        message.extend([
            near.gap.to_bits(),
            u64::from(near.column) << 40 | u64::from(near.row) << 8 | u64::from(near.pair),
        ]);
    }
}

fn add_near(words: &mut impl Iterator<Item = u64>, reading: &mut Reading) {
    let mut next = || words.next().unwrap_or(0);
    reading.largest.0[0] = reading.largest.0[0].max(f64::from_bits(next()));
    for _ in 0..next() {
        let (gap, cell) = (next(), next());
        let (column, row) = ((cell >> 40) as u32, (cell >> 8) as u32);
        reading.near.push(NearPair { gap: f64::from_bits(gap), row, column, pair: cell as u8 });
    }
}
