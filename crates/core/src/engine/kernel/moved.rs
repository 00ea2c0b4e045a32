//! What a sweep moved, row by row.

use std::ops::Range;

use super::pairs::lanes_of;
use crate::engine::exact::RowIntegers;
use crate::engine::lanes::{Chunk, IntegerChunk, Integers, LANES, Lanes, Mask};

/// What a step took off and put on, as far as it does not follow from its load balance alone.
///
/// With a pool most open cells get the whole share, and those of the pin with a plateau ahead the pad share of it: the even
/// deposit. Only what differs from that is counted here. With local debris no deposit is even.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Heights compacted on the pin beyond the even deposit of a pool, in quanta of the deposits.
    pub deposited_pin: RowIntegers,
    /// Heights compacted on the disc beyond the even deposit of a pool, in quanta of the deposits.
    pub deposited_disc: RowIntegers,
    /// What plateaus of the pin lost, in coarse quanta of the losses and, of the rest, in fine ones; only where build-up
    /// has properties of its own.
    pub lost_pin: [RowIntegers; 2],
    /// The same of the disc.
    pub lost_disc: [RowIntegers; 2],
    /// Rows of each strip, one bit each, in which an open cell had no room for the whole share.
    pub limited: Vec<u8>,
    /// What happened in few cells.
    pub seldom: Vec<SeldomEvent>,
}

/// What happened to the build-up of one cell on resin, or behind one of resin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeldomEvent {
    /// Row of the cell.
    pub row: u32,
    /// Height that returned to the pool because the plateau fell, m.
    pub returned: f64,
    /// Build-up on resin that was worn through, m: it lost that instead of its raw loss.
    pub worn_through: f64,
    /// Gap of such a pair, m.
    pub gap: f64,
    /// What was compacted on pin and disc of what resin ahead lost, m.
    pub deposited: [f64; 2],
}

impl SeldomEvent {
    /// What was compacted on pin and disc of what resin ahead lost, m.
    pub fn deposited(row: usize, deposited: [f64; 2]) -> Self {
        Self { deposited, ..Self::in_row(row) }
    }

    /// Nothing yet, in a row.
    fn in_row(row: usize) -> Self {
        Self { row: row as u32, returned: 0.0, worn_through: 0.0, gap: 0.0, deposited: [0.0; 2] }
    }
}

impl Moved {
    /// Nothing moved; what a scene does not need has no rows.
    pub fn new(strips: usize, forms: bool, distinct: bool) -> Self {
        let rows = |needed| RowIntegers::new(if needed { strips } else { 0 });
        Self {
            deposited_pin: rows(forms),
            deposited_disc: rows(forms),
            lost_pin: [rows(distinct), rows(distinct)],
            lost_disc: [rows(distinct), rows(distinct)],
            limited: vec![0; if forms { strips } else { 0 }],
            seldom: Vec::new(),
        }
    }

    /// Starts a new step.
    pub fn clear(&mut self) {
        self.deposited_pin.clear();
        self.deposited_disc.clear();
        self.lost_pin.iter_mut().chain(&mut self.lost_disc).for_each(RowIntegers::clear);
        self.limited.fill(0);
        self.seldom.clear();
    }

    /// Whether some open cell of these rows had no room for the whole share.
    pub fn is_limited(&self, rows: Range<usize>) -> bool {
        (rows.start / LANES..rows.end.div_ceil(LANES)).any(|strip| {
            let first = strip * LANES;
            let of_strip = (rows.start.max(first)..rows.end.min(first + LANES)).map(|row| 1_u8 << (row - first));
            self.limited[strip] != 0 && of_strip.fold(0, |bits, bit| bits | bit) & self.limited[strip] != 0
        })
    }
}

/// The sums of [`Moved`] of a strip while it is swept.
#[derive(Clone, Copy)]
pub(super) struct StripMoved<L: Lanes> {
    pub deposited_pin: L::Integers,
    pub deposited_disc: L::Integers,
    pub lost_pin: [L::Integers; 2],
    pub lost_disc: [L::Integers; 2],
    /// Rows in which an open cell had no room for the whole share.
    pub limited: L::Mask,
}

impl<L: Lanes> StripMoved<L> {
    /// Nothing yet.
    #[inline(always)]
    pub fn new() -> Self {
        let zero = L::Integers::splat(0);
        Self {
            deposited_pin: zero,
            deposited_disc: zero,
            lost_pin: [zero; 2],
            lost_disc: [zero; 2],
            limited: L::Mask::of_byte(0),
        }
    }

    /// Adds the sums of the strip to the others.
    #[inline(always)]
    pub fn store<const DISTINCT: bool, const FORMS: bool>(self, strip: usize, moved: &mut Moved) {
        if FORMS {
            add::<L>(&mut moved.deposited_pin.0[strip], self.deposited_pin);
            add::<L>(&mut moved.deposited_disc.0[strip], self.deposited_disc);
            moved.limited[strip] |= self.limited.byte();
        }
        if DISTINCT {
            let mut size = 0;
            while size < 2 {
                add::<L>(&mut moved.lost_pin[size].0[strip], self.lost_pin[size]);
                add::<L>(&mut moved.lost_disc[size].0[strip], self.lost_disc[size]);
                size += 1;
            }
        }
    }
}

#[inline(always)]
fn add<L: Lanes>(chunk: &mut IntegerChunk, sum: L::Integers) {
    L::Integers::load(chunk).plus(sum).store(chunk);
}

/// Notes, for some of eight cells on resin whose build-up ends, its height: where the plateau falls, and where it is worn
/// through, there with the gap of the pair.
#[cold]
#[inline(never)]
pub(super) fn note_seldom(
    seldom: &mut Vec<SeldomEvent>,
    build_up: &Chunk,
    gap: &Chunk,
    fallen: u8,
    worn_through: u8,
    strip: usize,
) {
    let event = |lane: usize| SeldomEvent::in_row(strip * LANES + lane);
    seldom.extend(lanes_of(fallen).map(|lane| SeldomEvent { returned: build_up.0[lane], ..event(lane) }));
    let through = |lane: usize| SeldomEvent { worn_through: build_up.0[lane], gap: gap.0[lane], ..event(lane) };
    seldom.extend(lanes_of(worn_through).map(through));
}
