//! How the pairs of the next step stand to a bracket of displacements: all that the load balance needs of them.

use super::pairs::{PLAIN_PAIRS, PLATEAU, Pairs, RESIN, lanes_of, pair_of_lane};
use crate::engine::coefficients::StatusPair;
use crate::engine::exact::{Quantum, RowIntegers};
use crate::engine::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use crate::engine::parts::build_up;
use serde::{Deserialize, Serialize};

/// Displacements between which the next load balance is expected.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bracket {
    /// Its lower end, a multiple of the quantum, m.
    pub low: f64,
    /// How far it reaches, a multiple of the quantum, m.
    pub width: f64,
    /// Of which overlaps at the lower end are multiples.
    pub quantum: Quantum,
}

impl Bracket {
    /// The displacements from `low` on, `width` long, and what rounding adds; the quantum is a coarser one if it must be
    /// for a number as large as these.
    pub fn new(low: f64, width: f64, quantum: Quantum) -> Self {
        let size = low.abs() + width;
        let excess = if size > quantum.reach() { libm::ilogb(size / quantum.reach()).saturating_add(1) } else { 0 };
        let quantum = quantum.coarser(excess);
        let (low, width) = (quantum.nearest(low - quantum.value()), quantum.nearest(width + 2.0 * quantum.value()));
        Self { low, width, quantum }
    }
}

/// A pair that touches at some displacements of the bracket and not at others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearPair {
    /// g, m.
    pub gap: f64,
    /// Its row.
    pub row: u32,
    /// Its column of the pin.
    pub column: u32,
    /// Its [`StatusPair::index`].
    pub pair: u8,
}

/// The pairs of a step against a bracket, by pair of statuses and row.
///
/// What a pair carries and loses is proportional to its overlap, with a coefficient of its statuses and row: so sums of
/// overlaps stand for the cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The bits of the anchored overlaps low − g of the cells that touch at the lower end, added up: see
    /// [`Quantum::split`].
    pub overlap: [RowIntegers; StatusPair::COUNT],
    /// Pairs with low ≤ g ≤ low + width, to half a quantum.
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
        Self { overlap: std::array::from_fn(rows), near: Vec::new(), first_row, largest: Chunk([0.0; LANES]) }
    }

    /// Starts anew.
    pub fn clear(&mut self) {
        self.overlap.iter_mut().for_each(RowIntegers::clear);
        self.near.clear();
        self.largest = Chunk([0.0; LANES]);
    }

    /// The largest of the anchored overlaps.
    pub fn largest(&self) -> f64 {
        self.largest.0.iter().copied().fold(0.0, f64::max)
    }

    /// The largest overlap at the lower end of the bracket that was read, m; not positive where nothing touches.
    pub fn largest_overlap(&self, bracket: &Bracket) -> f64 {
        self.largest() - bracket.quantum.anchor()
    }
}

/// The indices of the pairs that are told apart.
pub fn told_apart(distinct: bool) -> &'static [usize] {
    if distinct { &[0, 1, 2, 3, 4, 5] } else { &PLAIN_PAIRS }
}

/// A bracket for eight cells at a time.
#[derive(Clone, Copy)]
pub(super) struct BracketLanes<L: Lanes> {
    /// The lower end, anchored: a gap taken off it leaves the anchored overlap, in one rounding.
    low: L,
    /// Overlap 0, anchored.
    none: L,
    /// What is left of a gap at the upper end, anchored.
    high: L,
}

impl<L: Lanes> BracketLanes<L> {
    #[inline(always)]
    pub fn new(bracket: &Bracket) -> Self {
        let anchor = bracket.quantum.anchor();
        Self { low: L::splat(anchor + bracket.low), none: L::splat(anchor), high: L::splat(anchor - bracket.width) }
    }
}

/// How eight pairs stand to a bracket.
#[derive(Clone, Copy)]
struct Stand<L: Lanes> {
    /// Their overlaps at its lower end, anchored; of no meaning for pairs that do not touch there.
    overlap: L::Integers,
    /// Which touch at the lower end.
    touches: L::Mask,
    /// Which touch somewhere in the bracket, but not at its lower end.
    near: L::Mask,
}

/// The sums of a strip while it is read; those of resin, which seldom touches, are not among them.
#[derive(Clone, Copy)]
pub(super) struct StripReading<L: Lanes, const BUILD_UP: u8> {
    overlap: [L::Integers; StatusPair::COUNT],
    largest: L,
}

impl<L: Lanes, const BUILD_UP: u8> StripReading<L, BUILD_UP> {
    /// Nothing read.
    #[inline(always)]
    pub fn new() -> Self {
        Self { overlap: [L::Integers::splat(0); StatusPair::COUNT], largest: L::splat(0.0) }
    }

    /// How eight pairs with gaps g = z_p − z_d stand to the bracket.
    #[inline(always)]
    fn face(&mut self, gap: L, bracket: &BracketLanes<L>) -> Stand<L> {
        let anchored = bracket.low - gap;
        self.largest = anchored.greater(self.largest);
        let touches = bracket.none.below(anchored);
        Stand { overlap: anchored.bits(), touches, near: anchored.at_least(bracket.high) & !touches }
    }

    /// Reads eight pairs of a strip and a column of the pin: gap g = z_p − z_d against the bracket. Returns those that touch
    /// at its lower end.
    #[inline(always)]
    pub fn add(
        &mut self,
        gap: L,
        pairs: Pairs<L>,
        bracket: &BracketLanes<L>,
        [strip, column]: [usize; 2],
        reading: &mut Reading,
    ) -> L::Mask {
        let Stand { overlap, touches, near } = self.face(gap, bracket);
        let resin = touches & pairs.resin();
        let plateaus = touches & !pairs.resin();
        if BUILD_UP == build_up::DISTINCT {
            let Pairs { pin_secondary, disc_secondary, .. } = pairs;
            let (on_coating, on_debris) = (plateaus & !disc_secondary, plateaus & disc_secondary);
            let [_, _, a, b, c, d] = self.overlap;
            self.overlap[2] = a.plus_where(on_coating & !pin_secondary, overlap);
            self.overlap[3] = b.plus_where(on_debris & !pin_secondary, overlap);
            self.overlap[4] = c.plus_where(on_coating & pin_secondary, overlap);
            self.overlap[5] = d.plus_where(on_debris & pin_secondary, overlap);
        } else {
            self.overlap[PLATEAU] = self.overlap[PLATEAU].plus_where(plateaus, overlap);
        }
        // Seldom.
        if resin.any() {
            let mut pair = RESIN;
            while pair < PLATEAU && (pair == RESIN || BUILD_UP == build_up::DISTINCT) {
                let of_pair = if BUILD_UP == build_up::DISTINCT { touches & pairs.are(pair) } else { resin };
                let sum = &mut reading.overlap[pair].0[strip];
                L::Integers::load(sum).plus_where(of_pair, overlap).store(sum);
                pair += 1;
            }
        }
        if near.any() {
            let mut gaps = Chunk([0.0; LANES]);
            gap.store(&mut gaps);
            let statuses = [pairs.on_resin.byte(), pairs.pin_secondary.byte(), pairs.disc_secondary.byte()];
            note_near::<BUILD_UP>(reading, &gaps, near.byte(), statuses, [strip, column]);
        }
        touches
    }

    /// Reads eight pairs as if all were plateaus and none near; returns those that touch, and those that are near.
    #[inline(always)]
    pub fn add_plateaus(&mut self, gap: L, bracket: &BracketLanes<L>) -> (L::Mask, L::Mask) {
        let Stand { overlap, touches, near } = self.face(gap, bracket);
        self.overlap[PLATEAU] = self.overlap[PLATEAU].plus_where(touches, overlap);
        (touches, near)
    }

    /// Adds the sums of the strip to the others.
    #[inline(always)]
    pub fn store(self, strip: usize, reading: &mut Reading) {
        let mut pair = PLATEAU;
        while pair < StatusPair::COUNT {
            if BUILD_UP == build_up::DISTINCT || pair == PLATEAU {
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
fn note_near<const BUILD_UP: u8>(
    reading: &mut Reading,
    gaps: &Chunk,
    lanes: u8,
    statuses: [u8; 3],
    [strip, column]: [usize; 2],
) {
    let first_row = reading.first_row;
    reading.near.extend(lanes_of(lanes).map(|lane| NearPair {
        gap: gaps.0[lane],
        row: (first_row + strip * LANES + lane) as u32,
        column: column as u32,
        pair: pair_of_lane(lane, BUILD_UP == build_up::DISTINCT, statuses),
    }));
}
