//! Statuses of eight pairs of cells, and the coefficients that belong to them.

use crate::engine::coefficients::{StatusPair, Table};
use crate::engine::lanes::{Chunk, LANES, Lanes};
use crate::engine::parts::build_up;
use crate::engine::strips::chunks;

/// A table of [`crate::engine::coefficients::Coefficients`] in chunks, strip by strip.
#[derive(Debug, Clone, PartialEq)]
pub struct ChunkTable(Vec<[Chunk; StatusPair::COUNT]>);

impl ChunkTable {
    /// The table times a factor.
    pub fn new(table: &Table, factor: f64) -> Self {
        let pairs =
            table.each_ref().map(|rows| chunks(&rows.iter().map(|entry| entry * factor).collect::<Vec<_>>(), 0.0));
        Self((0..pairs[0].len()).map(|strip| pairs.each_ref().map(|chunks| chunks[strip])).collect())
    }

    /// Each pair's entries in a strip.
    #[inline(always)]
    pub(super) fn strip<L: Lanes>(&self, strip: usize) -> Entries<L> {
        // Without a closure, which would be compiled without the instruction set.
        let [a, b, c, d, e, f] = &self.0[strip];
        Entries([L::load(a), L::load(b), L::load(c), L::load(d), L::load(e), L::load(f)])
    }
}

/// A coefficient of every pair in the eight rows of a strip.
#[derive(Clone, Copy)]
pub(super) struct Entries<L>([L; StatusPair::COUNT]);

/// The statuses of eight pairs.
#[derive(Clone, Copy)]
pub(super) struct Pairs<L: Lanes> {
    /// The pin's base is resin.
    pub on_resin: L::Mask,
    /// The pin is secondary.
    pub pin_secondary: L::Mask,
    /// The disc is secondary; not looked at where build-up has the properties of what it lies on.
    pub disc_secondary: L::Mask,
}

/// The pairs that are told apart where build-up has the properties of what it lies on: resin and plateaus.
pub const PLAIN_PAIRS: [usize; 2] = [RESIN, PLATEAU];
/// Bare resin on the coating.
pub const RESIN: usize = 0;
/// A fibre on the coating.
pub const PLATEAU: usize = 2;

impl<L: Lanes> Pairs<L> {
    /// Resin without build-up.
    #[inline(always)]
    pub fn resin(self) -> L::Mask {
        self.on_resin & !self.pin_secondary
    }

    /// The cells of one pair, by its index.
    #[inline(always)]
    pub fn are(self, pair: usize) -> L::Mask {
        let pin = match pair / 2 {
            0 => self.resin(),
            1 => !self.on_resin & !self.pin_secondary,
            _ => self.pin_secondary,
        };
        pin & if pair % 2 == 1 { self.disc_secondary } else { !self.disc_secondary }
    }

    /// Each pair's entry. Where build-up has no properties of its own, two of the six entries serve all.
    #[inline(always)]
    pub fn pick<const BUILD_UP: u8>(self, entries: &Entries<L>) -> L {
        let entries = &entries.0;
        if BUILD_UP != build_up::DISTINCT {
            return L::select(self.resin(), entries[RESIN], entries[PLATEAU]);
        }
        let on_coating = L::select(self.on_resin, entries[0], entries[2]);
        let on_debris = L::select(self.on_resin, entries[1], entries[3]);
        let bare = L::select(self.disc_secondary, on_debris, on_coating);
        let secondary = L::select(self.disc_secondary, entries[5], entries[4]);
        L::select(self.pin_secondary, secondary, bare)
    }
}

impl<L: Lanes> Entries<L> {
    /// The entry of plateaus where they are all alike.
    #[inline(always)]
    pub fn plateau(&self) -> L {
        self.0[PLATEAU]
    }

    /// The entries of plateaus, by whether pin and disc are secondary.
    #[inline(always)]
    pub fn plateaus<const BUILD_UP: u8>(&self, [pin, disc]: [L::Mask; 2]) -> L {
        if BUILD_UP != build_up::DISTINCT {
            return self.plateau();
        }
        let on_coating = L::select(pin, self.0[4], self.0[2]);
        L::select(disc, L::select(pin, self.0[5], self.0[3]), on_coating)
    }
}

/// The index of one of eight pairs, from their statuses as bytes.
pub(super) fn pair_of_lane(lane: usize, distinct: bool, [on_resin, pin_secondary, disc_secondary]: [u8; 3]) -> u8 {
    let [on_resin, pin_secondary, disc_secondary] =
        [on_resin, pin_secondary, disc_secondary].map(|byte| byte >> lane & 1);
    let pin = if pin_secondary == 1 { 2 } else { 1 - on_resin };
    match distinct {
        true => 2 * pin + disc_secondary,
        false if pin == 0 => RESIN as u8,
        false => PLATEAU as u8,
    }
}

/// The lanes whose bit is set.
pub(super) fn lanes_of(mut byte: u8) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = byte.trailing_zeros() as usize;
        byte &= byte.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}
