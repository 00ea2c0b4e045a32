//! How the pairs of the next step stand to a bracket of displacements: all that the load balance needs of them.

use super::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use super::pairs::{PLAIN_PAIRS, PLATEAU, Pairs, RESIN, lanes_of, pair_of_lane};
use crate::exact::{Quantum, RowIntegers};
use crate::pair::Pair;

/// Displacements between which the next load balance is expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bracket {
    /// Its lower end, m.
    pub low: f64,
    /// How far it reaches, m.
    pub width: f64,
    /// Of which overlaps at the lower end are multiples.
    pub quantum: Quantum,
}

/// A pair that touches at some displacements of the bracket and not at others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearPair {
    /// g, m.
    pub gap: f64,
    /// Its row.
    pub row: u32,
    /// Its [`Pair::index`].
    pub pair: u8,
}

/// The pairs of a step against a bracket, by pair of statuses and row.
///
/// What a pair carries and loses is proportional to its overlap, with a coefficient of its statuses and row: so sums of
/// overlaps stand for the cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Cells that touch at the lower end.
    pub touching: [RowIntegers; Pair::COUNT],
    /// Σ (low − g) over them in quanta, plus the anchor's bits for each.
    pub overlap: [RowIntegers; Pair::COUNT],
    /// Pairs with low ≤ g < low + width.
    pub near: Vec<NearPair>,
    /// The row of the mesh that is the first here.
    pub first_row: usize,
    /// The largest anchored overlaps: show any that is out of the quantum's range.
    pub largest: Chunk,
}

impl Reading {
    /// Nothing read. Where build-up has the properties of what it lies on, only two pairs are told apart.
    pub fn new(first_row: usize, strips: usize, distinct: bool) -> Self {
        let rows = |pair| RowIntegers::new(if told_apart(distinct).contains(&pair) { strips } else { 0 });
        Self {
            touching: std::array::from_fn(rows),
            overlap: std::array::from_fn(rows),
            near: Vec::new(),
            first_row,
            largest: Chunk([0.0; LANES]),
        }
    }

    /// Starts anew.
    pub fn clear(&mut self) {
        self.touching.iter_mut().chain(&mut self.overlap).for_each(RowIntegers::clear);
        self.near.clear();
        self.largest = Chunk([0.0; LANES]);
    }

    /// The largest of the anchored overlaps.
    pub fn largest(&self) -> f64 {
        self.largest.0.iter().copied().fold(0.0, f64::max)
    }

    /// Whether an overlap was too large for the quantum.
    pub fn is_out_of_range(&self, quantum: Quantum) -> bool {
        // Beyond, the last bit of an anchored overlap is worth two quanta.
        self.largest() >= quantum.anchor() * (2.0 / 1.5)
    }
}

/// The indices of the pairs that are told apart.
pub fn told_apart(distinct: bool) -> &'static [usize] {
    if distinct { &[0, 1, 2, 3, 4, 5] } else { &PLAIN_PAIRS }
}

/// A bracket for eight cells at a time.
#[derive(Clone, Copy)]
pub(super) struct BracketLanes<L: Lanes> {
    low: L,
    width: L,
    anchor: L,
    zero: L,
    /// 1; the compiler is not to know, for it would count by the mask as a number, which takes more instructions.
    one: L::Integers,
}

impl<L: Lanes> BracketLanes<L> {
    #[inline(always)]
    pub fn new(bracket: &Bracket) -> Self {
        Self {
            low: L::splat(bracket.low),
            width: L::splat(bracket.width),
            anchor: L::splat(bracket.quantum.anchor()),
            zero: L::splat(0.0),
            one: L::Integers::splat(std::hint::black_box(1)),
        }
    }
}

/// The sums of a strip while it is swept.
#[derive(Clone, Copy)]
pub(super) struct StripReading<L: Lanes, const DISTINCT: bool> {
    touching: [L::Integers; Pair::COUNT],
    overlap: [L::Integers; Pair::COUNT],
    largest: L,
}

impl<L: Lanes, const DISTINCT: bool> StripReading<L, DISTINCT> {
    /// Nothing read.
    #[inline(always)]
    pub fn new() -> Self {
        let zero = L::Integers::splat(0);
        Self { touching: [zero; Pair::COUNT], overlap: [zero; Pair::COUNT], largest: L::splat(0.0) }
    }

    /// How eight gaps stand to the bracket: g − low, which touch at its lower end, and their overlaps there, anchored.
    #[inline(always)]
    fn face(&mut self, gap: L, bracket: &BracketLanes<L>) -> (L, L::Mask, L::Integers) {
        let beyond = gap - bracket.low;
        let anchored = bracket.anchor - beyond;
        self.largest = anchored.greater(self.largest);
        (beyond, beyond.below(bracket.zero), anchored.bits())
    }

    /// Reads eight pairs: gap g = z_p − z_d against the bracket.
    #[inline(always)]
    pub fn add(&mut self, gap: L, pairs: Pairs<L>, bracket: &BracketLanes<L>, strip: usize, reading: &mut Reading) {
        let (beyond, touches, overlap) = self.face(gap, bracket);
        if DISTINCT {
            let mut pair = 0;
            while pair < Pair::COUNT {
                let these = touches & pairs.are(pair);
                self.touching[pair] = self.touching[pair].plus_where(these, bracket.one);
                self.overlap[pair] = self.overlap[pair].plus_where(these, overlap);
                pair += 1;
            }
        } else {
            let resin = touches & pairs.resin();
            let plateau = touches & !pairs.resin();
            self.touching[PLATEAU] = self.touching[PLATEAU].plus_where(plateau, bracket.one);
            self.overlap[PLATEAU] = self.overlap[PLATEAU].plus_where(plateau, overlap);
            if resin.any() {
                let touching = &mut reading.touching[RESIN].0[strip];
                L::Integers::load(touching).plus_where(resin, bracket.one).store(touching);
                let sum = &mut reading.overlap[RESIN].0[strip];
                L::Integers::load(sum).plus_where(resin, overlap).store(sum);
            }
        }
        let near = beyond.below(bracket.width) & !touches;
        if near.any() {
            let mut gaps = Chunk([0.0; LANES]);
            gap.store(&mut gaps);
            let statuses = [pairs.on_resin.byte(), pairs.pin_secondary.byte(), pairs.disc_secondary.byte()];
            note_near::<DISTINCT>(reading, &gaps, near.byte(), statuses, strip);
        }
    }

    /// Reads eight pairs as if all were plateaus and none near; returns those that touch, and those that are near.
    #[inline(always)]
    pub fn add_plateaus(&mut self, gap: L, bracket: &BracketLanes<L>) -> (L::Mask, L::Mask) {
        let (beyond, touches, overlap) = self.face(gap, bracket);
        self.touching[PLATEAU] = self.touching[PLATEAU].plus_where(touches, bracket.one);
        self.overlap[PLATEAU] = self.overlap[PLATEAU].plus_where(touches, overlap);
        (touches, beyond.within(bracket.width))
    }

    /// Adds the sums of the strip to the others.
    #[inline(always)]
    pub fn store(self, strip: usize, reading: &mut Reading) {
        let mut pair = 0;
        while pair < Pair::COUNT {
            if DISTINCT || pair == PLATEAU {
                let touching = &mut reading.touching[pair].0[strip];
                L::Integers::load(touching).plus(self.touching[pair]).store(touching);
                let overlap = &mut reading.overlap[pair].0[strip];
                L::Integers::load(overlap).plus(self.overlap[pair]).store(overlap);
            }
            pair += 1;
        }
        self.largest.greater(L::load(&reading.largest)).store(&mut reading.largest);
    }
}

/// Notes the few pairs of which the bracket does not say whether they touch.
#[cold]
#[inline(never)]
fn note_near<const DISTINCT: bool>(reading: &mut Reading, gaps: &Chunk, lanes: u8, statuses: [u8; 3], strip: usize) {
    let first_row = reading.first_row;
    reading.near.extend(lanes_of(lanes).map(|lane| NearPair {
        gap: gaps.0[lane],
        row: (first_row + strip * LANES + lane) as u32,
        pair: pair_of_lane(lane, DISTINCT, statuses),
    }));
}
