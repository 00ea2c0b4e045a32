//! Exact sums over all cells that the load balance and the debris need.
//!
//! What a pair carries and loses is proportional to its overlap, with a weight of its statuses and row. So a few
//! weighted sums of the counts of a pass stand for all its cells; and as they are integers, those of many workers add
//! up to those of one.

use std::ops::Range;

use crate::engine::coefficients::{Coefficients, StatusPair, Table};
use crate::engine::exact::{ExactSum, RowIntegers, Unit, Weights, of_words, product, words};
use crate::engine::kernel::{Bracket, Moved, NearPair, PLATEAU, Reading, told_apart};
use crate::engine::parts::Needs;
use crate::model::mesh::Mesh;
use crate::model::parameters::Parameters;
use serde::{Deserialize, Serialize};

/// The weights of every row, for what is summed.
#[derive(Debug, Clone, PartialEq)]
pub struct RowWeights {
    /// Stiffness k A by pair, N/m.
    pub stiffness: [Weights; StatusPair::COUNT],
    /// Area A, m².
    pub area: Weights,
    /// Raw volume that plateaus of the pin lose per overlap, by pair, m².
    pub pin_loss: [Weights; StatusPair::COUNT],
    /// Raw volume that the disc loses per overlap, by pair, m².
    pub disc_loss: [Weights; StatusPair::COUNT],
    /// Largest stiffness k A by pair, N/m.
    pub largest_stiffness: [f64; StatusPair::COUNT],
    /// Pairs that are told apart.
    pub pairs: &'static [usize],
    /// Unit of the volumes that few cells of a step move, m³.
    pub volume: Unit,
    /// Unit of the raw losses of pairs that begin to touch within a bracket, m³.
    pub raw: Unit,
    /// Largest load that a step may have, N.
    pub largest_load: f64,
    /// Relief of the initial surfaces, m: from the lowest to the highest height of the disc, plus the same of the pin.
    pub relief: f64,
    pub needs: Needs,
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
        let largest_load = parameters.largest_load();
        let worn = losses.into_iter().fold(0.0, f64::max) * largest_load * area;
        let finest = if worn > 0.0 { FINEST_VOLUME.min(libm::ilogb(worn) - RAW_BITS) } else { FINEST_VOLUME };
        let by_area = |table: &Table| table.each_ref().map(|rows| Weights::new(&times_area(rows, mesh)));
        Self {
            stiffness: coefficients.stiffness.each_ref().map(|rows| Weights::new(rows)),
            largest_stiffness: coefficients.stiffness.each_ref().map(|rows| rows.iter().copied().fold(0.0, f64::max)),
            volume: Unit::new(FINEST_VOLUME, mesh.pin_area() * (relief + parameters.materials.wear_height) + worn),
            raw: Unit::new(finest, worn),
            largest_load,
            relief,
            area: Weights::new(mesh.area()),
            pin_loss: by_area(&coefficients.pin),
            disc_loss: by_area(&coefficients.disc),
            pairs: told_apart(needs.distinct),
            needs,
            own,
        }
    }

    /// Stiffness k A of a pair, N/m.
    pub fn stiffness_of(&self, near: &NearPair) -> f64 {
        self.stiffness[usize::from(near.pair)].value(near.row as usize)
    }

    /// Raw volume that a plateau of the pin that begins to touch within a bracket loses, where all have the same properties.
    pub fn near_loss(&self, row: usize, overlap: f64) -> ExactSum {
        self.raw.exact(self.pin_loss[PLATEAU].value(row) * overlap)
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
    /// Load Σ k A (low − g).
    pub load: i128,
    /// Slope Σ k A.
    pub stiffness: i128,
    /// Area Σ A.
    pub area: i128,
    /// Sum of raw losses of the pin's volume at the lower end.
    pub pin_loss: i128,
    /// Sum of raw losses of the pin's volume per displacement beyond the lower end.
    pub pin_loss_rate: i128,
    /// Sum of raw losses of the disc's volume at the lower end.
    pub disc_loss: i128,
    /// Sum of raw losses of the disc's volume per displacement beyond the lower end.
    pub disc_loss_rate: i128,
}

/// Sums over all cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sums {
    /// The pairs of the coming step.
    pub pairs: [PairSums; StatusPair::COUNT],
    /// Volume compacted on the pin, in units and quanta of the deposits.
    pub deposited_pin: i128,
    /// Volume compacted on the disc, in units and quanta of the deposits.
    pub deposited_disc: i128,
    /// Volume that plateaus of the pin lost, in units and coarse and fine quanta of the losses; only where build-up has
    /// properties of its own.
    pub lost_pin: [i128; 2],
    /// Volume that the disc lost, in the same units and quanta.
    pub lost_disc: [i128; 2],
    /// Volume of build-up that broke away.
    pub returned: ExactSum,
    /// Volume compacted on the pin of what resin ahead lost.
    pub deposited_pin_of_resin: ExactSum,
    /// Volume compacted on the disc of what resin ahead lost.
    pub deposited_disc_of_resin: ExactSum,
    /// Volume of build-up on resin that was worn through, where it has the properties of fibre.
    pub worn_through: ExactSum,
    /// Raw volume that this build-up would have lost.
    pub raw_through: RawLoss,
}

/// Raw volume that plateaus of the pin lose, of parts that add up and come off exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RawLoss {
    /// Loss at the lower end of the bracket, of the pairs that touch there, in units and quanta.
    pub low: i128,
    /// Loss of these pairs per displacement beyond the lower end, in units.
    pub rate: i128,
    /// Loss of the pairs that begin to touch within the bracket.
    pub near: ExactSum,
}

impl Sums {
    /// Takes the sums of what was read against a bracket.
    pub fn take_reading(&mut self, weights: &RowWeights, reading: &Reading, bracket: &Bracket) {
        let split = bracket.quantum.split();
        for pair in weights.pairs {
            let overlaps = reading.overlap[*pair].rows(0..weights.own.len());
            // Statuses that touch nowhere, as resin mostly, cost nothing.
            let touches = overlaps.iter().fold(0, |any, overlap| any | overlap) != 0;
            self.pairs[*pair] = if touches { weights.pair_sums(*pair, overlaps, &split) } else { PairSums::default() };
        }
    }

    /// Takes the sums of what a pass moved in a step that was read against a bracket and has this displacement (m).
    pub fn take_moved(&mut self, weights: &RowWeights, moved: &Moved, bracket: &Bracket, displacement: f64) {
        let sum = |counts: &RowIntegers| weights.area.sum(weights.own.clone(), counts.rows(0..weights.own.len()));
        if weights.needs.forms {
            self.deposited_pin = sum(&moved.deposited_pin);
            self.deposited_disc = sum(&moved.deposited_disc);
        }
        if weights.needs.distinct {
            self.lost_pin = moved.lost_pin.each_ref().map(sum);
            self.lost_disc = moved.lost_disc.each_ref().map(sum);
        }
        self.seldom().into_iter().for_each(|sum| *sum = ExactSum::default());
        self.raw_through = RawLoss::default();
        for event in &moved.seldom {
            let row = event.row as usize;
            let area = weights.area.value(row);
            self.returned.add(weights.volume.exact(event.returned * area));
            self.deposited_pin_of_resin.add(weights.volume.exact(event.deposited[0] * area));
            self.deposited_disc_of_resin.add(weights.volume.exact(event.deposited[1] * area));
            if event.worn_through > 0.0 {
                self.worn_through.add(weights.volume.exact(event.worn_through * area));
                // As the pair was read.
                let overlap = bracket.quantum.count_difference(bracket.low, event.gap);
                if overlap > 0 {
                    self.raw_through.low += product(weights.pin_loss[PLATEAU].row(row), overlap);
                    self.raw_through.rate += i128::from(weights.pin_loss[PLATEAU].row(row));
                } else {
                    self.raw_through.near.add(weights.near_loss(row, displacement - event.gap));
                }
            }
        }
    }

    /// Adds what another worker sent of a reading.
    pub fn add_reading(&mut self, weights: &RowWeights, words: &mut impl Iterator<Item = u64>) {
        for pair in weights.pairs {
            if words.next() == Some(1) {
                self.pairs[*pair].each().into_iter().for_each(|sum| *sum += of_words(words));
            }
        }
    }

    /// Adds what another worker sent of a pass.
    pub fn add_moved(&mut self, words: &mut impl Iterator<Item = u64>) {
        self.counted().into_iter().for_each(|sum| *sum += of_words(words));
        self.seldom().into_iter().for_each(|sum| sum.add(ExactSum::of_integer(of_words(words))));
    }

    /// Writes what was read, for other workers.
    pub fn write_reading(&self, weights: &RowWeights, message: &mut Vec<u64>) {
        for pair in weights.pairs {
            let mut sums = self.pairs[*pair];
            let touches = sums != PairSums::default();
            message.push(u64::from(touches));
            if touches {
                sums.each().into_iter().for_each(|sum| message.extend(words(*sum)));
            }
        }
    }

    /// Writes what was moved, for other workers.
    pub fn write_moved(&self, message: &mut Vec<u64>) {
        let mut sums = *self;
        sums.counted().into_iter().for_each(|sum| message.extend(words(*sum)));
        sums.seldom().into_iter().for_each(|sum| message.extend(words(sum.integer())));
    }
}

impl RowWeights {
    /// The sums of one kind of pairs; `split` parts the sums of anchored overlaps, see [`Quantum::split`].
    fn pair_sums(&self, pair: usize, overlaps: &[i64], split: impl Fn(i64) -> (i64, i64)) -> PairSums {
        let (mut sums, rows) = (PairSums::default(), self.own.clone());
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

impl Sums {
    /// Returns the sums of what happens in few cells.
    fn seldom(&mut self) -> [&mut ExactSum; 5] {
        let Self { returned, deposited_pin_of_resin, deposited_disc_of_resin, worn_through, raw_through, .. } = self;
        [returned, deposited_pin_of_resin, deposited_disc_of_resin, worn_through, &mut raw_through.near]
    }

    /// Returns the sums that are counted in quanta.
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
