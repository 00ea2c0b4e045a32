//! What the load balance and the debris need to know of all cells: exact sums, pool by pool.
//!
//! What a pair carries and loses is proportional to its overlap, with a weight of its statuses and row. So a few
//! weighted sums of the counts of a sweep stand for all its cells; and as they are integers, those of many workers add
//! up to those of one.

use std::ops::Range;

use crate::engine::coefficients::{Coefficients, StatusPair, Table};
use crate::engine::exact::{ExactSum, RowIntegers, Unit, Weights, of_words, product, words};
use crate::engine::kernel::{Bracket, Moved, NearPair, PLATEAU, Reading, told_apart};
use crate::engine::parts::Needs;
use crate::model::mesh::Mesh;
use crate::model::parameters::{DebrisRule, Parameters};
use serde::{Deserialize, Serialize};

/// The weights of every row, for what is summed.
#[derive(Debug, Clone, PartialEq)]
pub struct RowWeights {
    /// k A by pair, N/m.
    pub stiffness: [Weights; StatusPair::COUNT],
    /// A, m².
    pub area: Weights,
    /// Raw volume that plateaus of the pin lose per overlap, by pair, m².
    pub pin_loss: [Weights; StatusPair::COUNT],
    /// The same of the disc.
    pub disc_loss: [Weights; StatusPair::COUNT],
    /// The largest k A by pair, N/m.
    pub largest_stiffness: [f64; StatusPair::COUNT],
    /// Pairs that are told apart.
    pub pairs: &'static [usize],
    /// Of which the volumes that few cells of a step move are multiples.
    pub volume: Unit,
    /// Of which raw losses of pairs are multiples that begin to touch within a bracket.
    pub raw: Unit,
    /// How far the initial heights of pin and disc are apart from the lowest to the highest of each, m.
    pub relief: f64,
    pub needs: Needs,
    rows: usize,
    pools: usize,
    /// Rows of the worker.
    own: Range<usize>,
}

impl RowWeights {
    /// The weights of a scene whose initial heights have a `relief` (m), for a worker that has the rows `own`.
    pub fn new(parameters: &Parameters, coefficients: &Coefficients, own: Range<usize>, relief: f64) -> Self {
        let mesh = &parameters.mesh;
        let needs = Needs::of(parameters);
        let losses = coefficients.pair_losses().map(|loss| loss.per_load);
        let area = mesh.area().iter().copied().fold(0.0, f64::max);
        // About the largest volume that a step wears off, m³: what a cell loses that carries all the load.
        let worn = losses.into_iter().fold(0.0, f64::max) * parameters.largest_load() * area;
        let finest = if worn > 0.0 { FINEST_VOLUME.min(libm::ilogb(worn) - RAW_BITS) } else { FINEST_VOLUME };
        let by_area = |table: &Table| table.each_ref().map(|rows| Weights::new(&times_area(rows, mesh)));
        Self {
            stiffness: coefficients.stiffness.each_ref().map(|rows| Weights::new(rows)),
            largest_stiffness: coefficients.stiffness.each_ref().map(|rows| rows.iter().copied().fold(0.0, f64::max)),
            volume: Unit::new(FINEST_VOLUME, mesh.pin_area() * (relief + parameters.materials.wear_height) + worn),
            raw: Unit::new(finest, worn),
            relief,
            area: Weights::new(mesh.area()),
            pin_loss: by_area(&coefficients.pin),
            disc_loss: by_area(&coefficients.disc),
            pairs: told_apart(needs.distinct),
            needs,
            rows: mesh.rows(),
            pools: match parameters.plateaus.debris {
                DebrisRule::Local | DebrisRule::Contact => 1,
                DebrisRule::Track => mesh.rows(),
            },
            own,
        }
    }

    /// Number of pools.
    pub fn pools(&self) -> usize {
        self.pools
    }

    /// The rows that share a pool.
    pub fn rows_of(&self, pool: usize) -> Range<usize> {
        let rows = self.rows / self.pools;
        pool * rows..(pool + 1) * rows
    }

    /// Those of the worker's rows that share a pool: as rows of the mesh, and as the worker counts them.
    fn own_rows_of(&self, pool: usize) -> (Range<usize>, Range<usize>) {
        let Range { start, end } = self.rows_of(pool);
        let start = start.clamp(self.own.start, self.own.end);
        let end = end.clamp(start, self.own.end);
        (start..end, start - self.own.start..end - self.own.start)
    }

    /// k A of a pair, N/m.
    pub fn stiffness_of(&self, near: &NearPair) -> f64 {
        self.stiffness[usize::from(near.pair)].value(near.row as usize)
    }

    /// Raw volume that a plateau of the pin loses that begins to touch within a bracket, where all have the same properties.
    pub fn near_loss(&self, row: usize, overlap: f64) -> ExactSum {
        self.raw.exact(self.pin_loss[PLATEAU].value(row) * overlap)
    }

    /// The pool of a row.
    pub fn pool_of(&self, row: usize) -> usize {
        row * self.pools / self.rows
    }
}

/// Exponent of the unit of volumes that few cells of a step move, where that of a scene need not be larger.
const FINEST_VOLUME: i32 = -140;

/// Bits of what a step wears off below which the raw losses of few cells may be cut.
const RAW_BITS: i32 = 64;

fn times_area(rows: &[f64], mesh: &Mesh) -> Vec<f64> {
    rows.iter().zip(mesh.area()).map(|(value, area)| value * area).collect()
}

/// Sums over the pairs of one kind that touch at the lower end of a bracket, in units and quanta.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PairSums {
    /// Σ k A (low − g).
    pub load: i128,
    /// Σ k A.
    pub stiffness: i128,
    /// Σ A.
    pub area: i128,
    /// Σ raw loss of the pin's volume at the lower end.
    pub pin_loss: i128,
    /// … and per displacement beyond it.
    pub pin_loss_rate: i128,
    /// Σ raw loss of the disc's volume at the lower end.
    pub disc_loss: i128,
    /// … and per displacement beyond it.
    pub disc_loss_rate: i128,
}

/// Sums over the cells that share a pool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PoolSums {
    /// The pairs of the coming step.
    pub pairs: [PairSums; StatusPair::COUNT],
    /// Volume compacted on the pin beyond the even deposit, in units and quanta of the deposits.
    pub deposited_pin: i128,
    /// The same on the disc.
    pub deposited_disc: i128,
    /// Whether an open cell had no room for the whole share: else the pool is empty.
    pub limited: bool,
    /// Volume that plateaus of the pin lost, in units and coarse and fine quanta of the losses; only where build-up has
    /// properties of its own.
    pub lost_pin: [i128; 2],
    /// The same of the disc.
    pub lost_disc: [i128; 2],
    /// Volume of fallen build-up.
    pub returned: ExactSum,
    /// Volume compacted on the pin of what resin ahead lost.
    pub deposited_pin_of_resin: ExactSum,
    /// The same on the disc.
    pub deposited_disc_of_resin: ExactSum,
    /// Volume of build-up on resin that was worn through, where it has the properties of fibre.
    pub worn_through: ExactSum,
    /// Raw volume that it would have lost.
    pub raw_through: RawLoss,
}

/// Raw volume that plateaus of the pin lose, of parts that add up and come off exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RawLoss {
    /// Of the pairs that touch at the lower end of the bracket, there, in units and quanta.
    pub low: i128,
    /// … and per displacement beyond it, in units.
    pub rate: i128,
    /// Of the pairs that begin to touch within the bracket.
    pub near: ExactSum,
}

/// The sums of every pool.
#[derive(Debug, Clone, PartialEq)]
pub struct Sums {
    /// By pool.
    pub pools: Vec<PoolSums>,
}

impl Sums {
    /// All 0.
    pub fn new(pools: usize) -> Self {
        Self { pools: vec![PoolSums::default(); pools] }
    }

    /// Takes the sums of what was read against a bracket.
    pub fn take_reading(&mut self, weights: &RowWeights, reading: &Reading, bracket: &Bracket) {
        let split = bracket.quantum.split();
        for (pool, sums) in self.pools.iter_mut().enumerate() {
            let (rows, here) = weights.own_rows_of(pool);
            for pair in weights.pairs {
                let overlaps = reading.overlap[*pair].rows(here.clone());
                // Statuses that touch nowhere, as resin mostly, cost nothing.
                let touches = overlaps.iter().fold(0, |any, overlap| any | overlap) != 0;
                sums.pairs[*pair] = if touches {
                    weights.pair_sums(*pair, rows.clone(), overlaps, &split)
                } else {
                    PairSums::default()
                };
            }
        }
    }

    /// Takes the sums of what a sweep moved in a step that was read against a bracket and has this displacement (m).
    pub fn take_moved(&mut self, weights: &RowWeights, moved: &Moved, bracket: &Bracket, displacement: f64) {
        for (pool, sums) in self.pools.iter_mut().enumerate() {
            let (rows, here) = weights.own_rows_of(pool);
            let sum = |counts: &RowIntegers| weights.area.sum(rows.clone(), counts.rows(here.clone()));
            if weights.needs.forms {
                sums.deposited_pin = sum(&moved.deposited_pin);
                sums.deposited_disc = sum(&moved.deposited_disc);
                sums.limited = moved.is_limited(here.clone());
            }
            if weights.needs.distinct {
                sums.lost_pin = moved.lost_pin.each_ref().map(sum);
                sums.lost_disc = moved.lost_disc.each_ref().map(sum);
            }
            sums.seldom().into_iter().for_each(|sum| *sum = ExactSum::default());
            sums.raw_through = RawLoss::default();
        }
        for event in &moved.seldom {
            let sums = &mut self.pools[weights.pool_of(event.row as usize)];
            let area = weights.area.value(event.row as usize);
            sums.returned.add(weights.volume.exact(event.returned * area));
            sums.deposited_pin_of_resin.add(weights.volume.exact(event.deposited[0] * area));
            sums.deposited_disc_of_resin.add(weights.volume.exact(event.deposited[1] * area));
            if event.worn_through > 0.0 {
                sums.worn_through.add(weights.volume.exact(event.worn_through * area));
                // As the pair was read.
                let overlap = bracket.quantum.count_difference(bracket.low, event.gap);
                if overlap > 0 {
                    sums.raw_through.low += product(weights.pin_loss[PLATEAU].row(event.row as usize), overlap);
                    sums.raw_through.rate += i128::from(weights.pin_loss[PLATEAU].row(event.row as usize));
                } else {
                    sums.raw_through.near.add(weights.near_loss(event.row as usize, displacement - event.gap));
                }
            }
        }
    }

    /// Adds what another worker sent of a reading.
    pub fn add_reading(&mut self, weights: &RowWeights, words: &mut impl Iterator<Item = u64>) {
        for sums in &mut self.pools {
            for pair in weights.pairs {
                if words.next() == Some(1) {
                    sums.pairs[*pair].each().into_iter().for_each(|sum| *sum += of_words(words));
                }
            }
        }
    }

    /// Adds what another worker sent of a sweep.
    pub fn add_moved(&mut self, words: &mut impl Iterator<Item = u64>) {
        for sums in &mut self.pools {
            sums.counted().into_iter().for_each(|sum| *sum += of_words(words));
            sums.limited |= words.next() == Some(1);
            sums.seldom().into_iter().for_each(|sum| sum.add(ExactSum::of_integer(of_words(words))));
        }
    }

    /// Writes what was read, for other workers.
    pub fn write_reading(&self, weights: &RowWeights, message: &mut Vec<u64>) {
        for sums in &self.pools {
            for pair in weights.pairs {
                let mut pair_sums = sums.pairs[*pair];
                let touches = pair_sums != PairSums::default();
                message.push(u64::from(touches));
                if touches {
                    pair_sums.each().into_iter().for_each(|sum| message.extend(words(*sum)));
                }
            }
        }
    }

    /// Writes what was moved, for other workers.
    pub fn write_moved(&self, message: &mut Vec<u64>) {
        for sums in &self.pools {
            let mut sums = *sums;
            sums.counted().into_iter().for_each(|sum| message.extend(words(*sum)));
            message.push(u64::from(sums.limited));
            sums.seldom().into_iter().for_each(|sum| message.extend(words(sum.integer())));
        }
    }
}

impl RowWeights {
    /// The sums of one kind of pairs over some rows; `split` parts the sums of anchored overlaps, see [`Quantum::split`].
    fn pair_sums(
        &self,
        pair: usize,
        rows: Range<usize>,
        overlaps: &[i64],
        split: impl Fn(i64) -> (i64, i64),
    ) -> PairSums {
        let mut sums = PairSums::default();
        let overlaps = &overlaps[..rows.len()];
        let (stiffness, area) = (self.stiffness[pair].rows(rows.clone()), self.area.rows(rows.clone()));
        let pin_loss = self.pin_loss[pair].rows(rows.clone());
        for row in 0..rows.len() {
            let (count, overlap) = split(overlaps[row]);
            sums.load += product(stiffness[row], overlap);
            sums.stiffness += product(stiffness[row], count);
            sums.area += product(area[row], count);
            sums.pin_loss += product(pin_loss[row], overlap);
            sums.pin_loss_rate += product(pin_loss[row], count);
        }
        // Where build-up has properties of its own, each loss is counted when it is lost.
        if self.needs.disc_wears && !self.needs.distinct {
            let disc_loss = self.disc_loss[pair].rows(rows.clone());
            for row in 0..rows.len() {
                let (count, overlap) = split(overlaps[row]);
                sums.disc_loss += product(disc_loss[row], overlap);
                sums.disc_loss_rate += product(disc_loss[row], count);
            }
        }
        sums
    }
}

impl PoolSums {
    /// What happens in few cells.
    fn seldom(&mut self) -> [&mut ExactSum; 5] {
        let Self { returned, deposited_pin_of_resin, deposited_disc_of_resin, worn_through, raw_through, .. } = self;
        [returned, deposited_pin_of_resin, deposited_disc_of_resin, worn_through, &mut raw_through.near]
    }

    /// What is counted in quanta.
    fn counted(&mut self) -> [&mut i128; 8] {
        let Self { deposited_pin, deposited_disc, lost_pin, lost_disc, raw_through, .. } = self;
        let [[pin, pin_rest], [disc, disc_rest]] = [lost_pin, lost_disc];
        let RawLoss { low, rate, .. } = raw_through;
        [deposited_pin, deposited_disc, pin, pin_rest, disc, disc_rest, low, rate]
    }
}

impl PairSums {
    fn each(&mut self) -> [&mut i128; 7] {
        let Self { load, stiffness, area, pin_loss, pin_loss_rate, disc_loss, disc_loss_rate } = self;
        [load, stiffness, area, pin_loss, pin_loss_rate, disc_loss, disc_loss_rate]
    }
}
