//! What the kernels must know of a scene and of a step.

use super::lanes::{Chunk, Integers, Lanes};
use super::pairs::{ChunkTable, Entries};
use super::reading::{Bracket, BracketLanes};
use crate::exact::Quantum;
use crate::pair::Coefficients;
use crate::parameters::Parameters;

/// What stays the same in every step.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules {
    /// Raw loss of the pin per overlap, negative: the kernels have −u at hand.
    pin_loss: ChunkTable,
    /// Raw loss of the disc per overlap, negative.
    disc_loss: ChunkTable,
    fibre: ChunkTable,
    coating: ChunkTable,
    /// h_m, m.
    wear_height: f64,
    /// β.
    pad_share: f64,
}

impl Rules {
    /// The rules of a scene.
    pub fn new(parameters: &Parameters, coefficients: &Coefficients) -> Self {
        Self {
            pin_loss: ChunkTable::new(&coefficients.pin, -1.0),
            disc_loss: ChunkTable::new(&coefficients.disc, -1.0),
            fibre: ChunkTable::new(&coefficients.fibre, 1.0),
            coating: ChunkTable::new(&coefficients.coating, 1.0),
            wear_height: parameters.materials.wear_height,
            pad_share: parameters.plateaus.pad_share,
        }
    }
}

/// What changes from step to step.
#[derive(Debug, Clone, Copy)]
pub struct Conditions<'a> {
    /// δ, m.
    pub displacement: f64,
    /// s of every row, m.
    pub share: &'a [Chunk],
    /// Of which deposits are counted as multiples.
    pub deposits: Quantum,
    /// Of which losses that were spared are counted as multiples.
    pub losses: Quantum,
    /// Where the next load balance is expected.
    pub bracket: Bracket,
}

/// Rules and conditions of a strip, for eight cells at a time.
pub(super) struct StripRules<L: Lanes> {
    pub strip: usize,
    pub zero: L,
    pub displacement: L,
    pub pin_loss: Entries<L>,
    pub disc_loss: Entries<L>,
    pub fibre: Entries<L>,
    pub coating: Entries<L>,
    pub wear_height: L,
    pub pad_share: L,
    pub share: L,
    /// β s, m: the pin's part of an even deposit.
    pub even_on_pin: L,
    /// (1 − β) s, m: the disc's part of it.
    pub even_on_disc: L,
    /// Number whose last bit is worth a quantum of the deposits.
    pub deposits: L,
    /// Number whose last bit is worth a quantum of the losses.
    pub losses: L,
    pub bracket: BracketLanes<L>,
}

impl<L: Lanes> StripRules<L> {
    #[inline(always)]
    pub fn new(rules: &Rules, conditions: &Conditions, strip: usize) -> Self {
        let share = L::load(&conditions.share[strip]);
        let pad_share = L::splat(rules.pad_share);
        let even_on_pin = share * pad_share;
        Self {
            strip,
            zero: L::splat(0.0),
            displacement: L::splat(conditions.displacement),
            pin_loss: rules.pin_loss.strip(strip),
            disc_loss: rules.disc_loss.strip(strip),
            fibre: rules.fibre.strip(strip),
            coating: rules.coating.strip(strip),
            wear_height: L::splat(rules.wear_height),
            pad_share,
            share,
            even_on_pin,
            even_on_disc: share - even_on_pin,
            deposits: L::splat(conditions.deposits.anchor()),
            losses: L::splat(conditions.losses.anchor()),
            bracket: BracketLanes::new(&conditions.bracket),
        }
    }

    /// By how many quanta a deposit is above the even one.
    #[inline(always)]
    pub fn beyond(&self, deposit: L, even: L) -> L::Integers {
        (self.deposits + deposit).bits().minus((self.deposits + even).bits())
    }

    /// A loss in quanta.
    #[inline(always)]
    pub fn loss(&self, height: L) -> L::Integers {
        (self.losses + height).bits().minus(self.losses.bits())
    }
}
