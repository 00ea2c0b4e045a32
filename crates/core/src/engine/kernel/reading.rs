//! Reading of the pairs of the next step against a bracket of displacements: all that the load balance needs of them.

use super::pairs::{PLAIN_PAIRS, PLATEAU, Pairs, RESIN, lanes_of, pair_of_lane};
use crate::engine::coefficients::StatusPair;
use crate::engine::exact::{Quantum, RowIntegers};
use crate::engine::lanes::{BYTES, Chunk, IntegerChunk, Integers, LANES, Lanes, Mask};
use crate::engine::parts::build_up;
use serde::{Deserialize, Serialize};

/// Displacements between which the next load balance is expected.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bracket {
    /// Lower end, a multiple of the quantum, m.
    pub low: f64,
    /// Width, a multiple of the quantum, m.
    pub width: f64,
    /// Quantum of the overlaps at the lower end, m.
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
    /// Gap g, m.
    pub gap: f64,
    /// Row of the mesh.
    pub row: u32,
    /// Column of the pin.
    pub column: u32,
    /// Statuses, as [`StatusPair::index`].
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
    /// Largest anchored overlaps, which show any that is out of the quantum's range.
    pub largest: Chunk,
    /// Rows of the strip that is being read which touch somewhere in the bracket, column by column, one bit each; zeros fill up what is
    /// looked at at a time.
    pub(super) reached: Vec<u8>,
}

impl Reading {
    /// Creates an empty reading. Where build-up has the properties of what it lies on, only two pairs are told apart.
    pub fn new(first_row: usize, strips: usize, distinct: bool) -> Self {
        let rows = |pair| RowIntegers::new(if told_apart(distinct).contains(&pair) { strips } else { 0 });
        Self {
            overlap: std::array::from_fn(rows),
            near: Vec::new(),
            first_row,
            largest: Chunk([0.0; LANES]),
            reached: Vec::new(),
        }
    }

    /// Starts anew.
    pub fn clear(&mut self) {
        self.overlap.iter_mut().for_each(RowIntegers::clear);
        self.near.clear();
        self.largest = Chunk([0.0; LANES]);
    }

    /// Makes room for what so many columns of a strip reach.
    #[inline(always)]
    pub(super) fn begin_strip(&mut self, columns: usize) {
        self.reached.clear();
        self.reached.resize(columns.next_multiple_of(BYTES), 0);
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
    /// Overlap −`width` of a gap at the upper end, anchored.
    high: L,
}

impl<L: Lanes> BracketLanes<L> {
    #[inline(always)]
    pub fn new(bracket: &Bracket) -> Self {
        let anchor = bracket.quantum.anchor();
        Self { low: L::splat(anchor + bracket.low), none: L::splat(anchor), high: L::splat(anchor - bracket.width) }
    }
}

/// Positions of eight pairs against a bracket.
#[derive(Clone, Copy)]
struct Stand<L: Lanes> {
    /// Overlaps at the lower end, anchored; of no meaning for pairs that do not touch there.
    overlap: L,
    /// Pairs that touch at the lower end.
    touches: L::Mask,
    /// Pairs that touch somewhere in the bracket.
    reached: L::Mask,
}

impl<L: Lanes> Stand<L> {
    /// Compares eight pairs with gaps g = z_p − z_d, m, with a bracket.
    #[inline(always)]
    fn new(gap: L, bracket: &BracketLanes<L>) -> Self {
        let overlap = bracket.low - gap;
        Self { overlap, touches: bracket.none.below(overlap), reached: overlap.at_least(bracket.high) }
    }
}

/// The sums of a strip while it is read; those of resin, which seldom touches, are not among them.
#[derive(Clone, Copy)]
pub(super) struct StripReading<L: Lanes, const BUILD_UP: u8> {
    overlap: [L::Integers; StatusPair::COUNT],
    largest: L,
}

impl<L: Lanes, const BUILD_UP: u8> StripReading<L, BUILD_UP> {
    /// Returns empty sums.
    #[inline(always)]
    pub fn new() -> Self {
        Self { overlap: [L::Integers::splat(0); StatusPair::COUNT], largest: L::splat(0.0) }
    }

    /// Reads eight pairs of a strip and a column of the pin: gap g = z_p − z_d against the bracket. Their statuses are looked at only
    /// where build-up has properties of its own; what else is seldom [`StripReading::note_seldom`] looks at after the strip. Returns
    /// those that touch at the lower end and those that touch somewhere in the bracket, one bit each.
    #[inline(always)]
    pub fn add(
        &mut self,
        gap: L,
        pairs: Pairs<L>,
        bracket: &BracketLanes<L>,
        strip: usize,
        overlaps: &mut [RowIntegers; StatusPair::COUNT],
    ) -> [u8; 2] {
        if BUILD_UP != build_up::DISTINCT {
            return self.add_alike(gap, bracket);
        }
        let stand = Stand::new(gap, bracket);
        self.add_distinct(&stand, pairs, strip, overlaps);
        [stand.touches.byte(), stand.reached.byte()]
    }

    /// Reads eight pairs as [`StripReading::add`] does, where build-up has the properties of what it lies on.
    #[inline(always)]
    pub fn add_alike(&mut self, gap: L, bracket: &BracketLanes<L>) -> [u8; 2] {
        let stand = Stand::new(gap, bracket);
        self.largest = stand.overlap.greater(self.largest);
        self.overlap[PLATEAU] = self.overlap[PLATEAU].plus_where(stand.touches, stand.overlap.bits());
        [stand.touches.byte(), stand.reached.byte()]
    }

    /// Notes what is seldom of eight pairs that were added: bare resin that touches, and pairs of which the bracket does not say whether
    /// they do. `bare` are those of bare resin, one bit each.
    #[inline(always)]
    pub fn note_seldom(
        gap: L,
        bare: u8,
        pairs: Pairs<L>,
        bracket: &BracketLanes<L>,
        place: [usize; 2],
        reading: &mut Reading,
    ) {
        let stand = Stand::new(gap, bracket);
        let touching = stand.touches.byte();
        if BUILD_UP != build_up::DISTINCT && touching & bare != 0 {
            let mut overlap = IntegerChunk::default();
            stand.overlap.bits().store(&mut overlap);
            give_to_resin(reading, place[0], touching & bare, &overlap);
        }
        let near = stand.reached.byte() & !touching;
        if near != 0 {
            note_near::<L, BUILD_UP>(reading, gap, near, statuses::<L, BUILD_UP>(bare, pairs), place);
        }
    }

    /// Adds eight pairs by their statuses.
    #[inline(always)]
    fn add_distinct(
        &mut self,
        stand: &Stand<L>,
        pairs: Pairs<L>,
        strip: usize,
        overlaps: &mut [RowIntegers; StatusPair::COUNT],
    ) {
        self.largest = stand.overlap.greater(self.largest);
        let (overlap, touches) = (stand.overlap.bits(), stand.touches);
        let Pairs { pin_secondary, disc_secondary, .. } = pairs;
        let (resin, plateaus) = (touches & pairs.resin(), touches & !pairs.resin());
        let (on_coating, on_debris) = (plateaus & !disc_secondary, plateaus & disc_secondary);
        let [_, _, a, b, c, d] = self.overlap;
        self.overlap[2] = a.plus_where(on_coating & !pin_secondary, overlap);
        self.overlap[3] = b.plus_where(on_debris & !pin_secondary, overlap);
        self.overlap[4] = c.plus_where(on_coating & pin_secondary, overlap);
        self.overlap[5] = d.plus_where(on_debris & pin_secondary, overlap);
        // Seldom.
        if resin.any() {
            let mut pair = RESIN;
            while pair < PLATEAU {
                let sum = &mut overlaps[pair].0[strip];
                L::Integers::load(sum).plus_where(touches & pairs.are(pair), overlap).store(sum);
                pair += 1;
            }
        }
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

/// Columns of a strip with pairs that are seldom: of which the bracket does not say whether they touch, or bare resin that may.
pub(super) struct SeldomColumns {
    /// Groups of columns that were looked at.
    groups: usize,
    /// Columns of the last group that are still to come, one bit each.
    some: u32,
}

impl SeldomColumns {
    /// Leaves of the rows that touch somewhere in the bracket those that are seldom, and begins with the first column.
    #[inline(always)]
    pub fn of(reached: &mut [u8], touches: &[u8], plateau: &[u8]) -> Self {
        // A compiler makes a wide loop of this.
        for ((reached, touches), plateau) in reached.iter_mut().zip(touches).zip(plateau) {
            *reached &= !(touches & plateau);
        }
        Self { groups: 0, some: 0 }
    }

    /// Returns the next of these columns; the bytes are those that [`SeldomColumns::of`] left.
    #[inline(always)]
    pub fn next<L: Lanes>(&mut self, seldom: &[u8]) -> Option<usize> {
        while self.some == 0 {
            self.some = L::some_of(seldom.as_chunks().0.get(self.groups)?);
            self.groups += 1;
        }
        let place = self.some.trailing_zeros() as usize;
        self.some &= self.some - 1;
        Some((self.groups - 1) * BYTES + place)
    }
}

/// Statuses of eight pairs, one bit each: on resin, secondary on the pin, secondary on the disc; where these have no properties of
/// their own, all that is not bare resin counts as a fibre.
#[inline(always)]
fn statuses<L: Lanes, const BUILD_UP: u8>(bare: u8, pairs: Pairs<L>) -> [u8; 3] {
    if BUILD_UP == build_up::DISTINCT {
        [pairs.on_resin.byte(), pairs.pin_secondary.byte(), pairs.disc_secondary.byte()]
    } else {
        [bare, 0, 0]
    }
}

/// Moves the overlaps of bare resin, which were added to those of plateaus of the strip.
#[cold]
#[inline(never)]
fn give_to_resin(reading: &mut Reading, strip: usize, resin: u8, overlap: &IntegerChunk) {
    for lane in lanes_of(resin) {
        for (pair, sign) in [(RESIN, 1), (PLATEAU, -1)] {
            let sum = &mut reading.overlap[pair].0[strip][lane];
            *sum = sum.wrapping_add(overlap[lane].wrapping_mul(sign));
        }
    }
}

/// Notes the few pairs of which the bracket does not say whether they touch.
#[inline(always)]
fn note_near<L: Lanes, const BUILD_UP: u8>(
    reading: &mut Reading,
    gap: L,
    lanes: u8,
    statuses: [u8; 3],
    [strip, column]: [usize; 2],
) {
    let mut gaps = Chunk([0.0; LANES]);
    gap.store(&mut gaps);
    note_each(reading, &gaps, lanes, statuses, BUILD_UP == build_up::DISTINCT, [strip, column]);
}

#[cold]
#[inline(never)]
fn note_each(
    reading: &mut Reading,
    gaps: &Chunk,
    lanes: u8,
    statuses: [u8; 3],
    distinct: bool,
    [strip, column]: [usize; 2],
) {
    let first_row = reading.first_row + strip * LANES;
    for lane in lanes_of(lanes) {
        reading.near.push(NearPair {
            gap: gaps.0[lane],
            row: (first_row + lane) as u32,
            column: column as u32,
            pair: pair_of_lane(lane, distinct, statuses),
        });
    }
}
