//! Heights that a pass moved, row by row.

use super::edge::Edges;
use super::pairs::lanes_of;
use super::rules::StripRules;
use super::worn::Worn;
use crate::engine::exact::RowIntegers;
use crate::engine::lanes::{Chunk, IntegerChunk, Integers, LANES, Lanes};
use crate::engine::parts::build_up;

/// Heights that a step took off and put on, as far as they do not follow from its load balance alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Heights compacted on the pin, in quanta of the deposits.
    pub deposited_pin: RowIntegers,
    /// Heights compacted on the disc, in quanta of the deposits.
    pub deposited_disc: RowIntegers,
    /// Heights that plateaus of the pin lost, in coarse quanta of the losses and, of the rest, in fine ones; only where build-up
    /// has properties of its own.
    pub lost_pin: [RowIntegers; 2],
    /// Heights that the disc lost, in the same quanta.
    pub lost_disc: [RowIntegers; 2],
    /// Events that happen in few cells.
    pub seldom: Vec<SeldomEvent>,
    /// Edges of the strip that is being filled.
    pub(super) edges: Edges,
}

/// Event in the build-up of one cell on resin, or behind one of resin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeldomEvent {
    /// Row of the cell.
    pub row: u32,
    /// Build-up that broke away, m.
    pub returned: f64,
    /// Build-up on resin that was worn through, m: it lost that instead of its raw loss.
    pub worn_through: f64,
    /// Gap of the pair whose build-up was worn through, m.
    pub gap: f64,
    /// Deposits on pin and disc of what resin ahead lost, m.
    pub deposited: [f64; 2],
}

impl SeldomEvent {
    /// Returns the event of deposits (m) on pin and disc of what resin ahead lost.
    pub fn deposited(row: usize, deposited: [f64; 2]) -> Self {
        Self { deposited, ..Self::in_row(row) }
    }

    /// Returns an event of a row in which nothing happened yet.
    fn in_row(row: usize) -> Self {
        Self { row: row as u32, returned: 0.0, worn_through: 0.0, gap: 0.0, deposited: [0.0; 2] }
    }
}

impl Moved {
    /// Creates sums in which nothing has moved; what a scene does not need has no rows.
    pub fn new(strips: usize, forms: bool, distinct: bool) -> Self {
        let rows = |needed| RowIntegers::new(if needed { strips } else { 0 });
        Self {
            deposited_pin: rows(forms),
            deposited_disc: rows(forms),
            lost_pin: [rows(distinct), rows(distinct)],
            lost_disc: [rows(distinct), rows(distinct)],
            seldom: Vec::new(),
            edges: Edges::default(),
        }
    }

    /// Starts a new step.
    pub fn clear(&mut self) {
        self.deposited_pin.clear();
        self.deposited_disc.clear();
        self.lost_pin.iter_mut().chain(&mut self.lost_disc).for_each(RowIntegers::clear);
        self.seldom.clear();
    }
}

/// The losses of a strip while it wears, anchored; only where build-up has properties of its own.
#[derive(Clone, Copy)]
pub(super) struct StripMoved<L: Lanes> {
    pub lost_pin: [L::Integers; 2],
    pub lost_disc: [L::Integers; 2],
}

impl<L: Lanes> StripMoved<L> {
    /// Returns empty sums.
    #[inline(always)]
    pub fn new() -> Self {
        let zero = L::Integers::splat(0);
        Self { lost_pin: [zero; 2], lost_disc: [zero; 2] }
    }

    /// Adds what eight cells lost, where build-up has properties of its own; else it follows from the overlaps.
    #[inline(always)]
    pub fn add<const BUILD_UP: u8, const DISC_WEARS: bool>(&mut self, rules: &StripRules<L>, worn: &Worn<L>) {
        if BUILD_UP == build_up::DISTINCT {
            self.lost_pin = rules.plus_loss(self.lost_pin, worn.lost_pin);
            if DISC_WEARS {
                self.lost_disc = rules.plus_loss(self.lost_disc, worn.lost_disc);
            }
        }
    }

    /// Adds the sums of the strip, with a term for each of so many columns, to the others.
    #[inline(always)]
    pub fn store<const BUILD_UP: u8, const DISC_WEARS: bool>(
        self,
        rules: &StripRules<L>,
        strip: usize,
        columns: usize,
        moved: &mut Moved,
    ) {
        if BUILD_UP == build_up::DISTINCT {
            let (pin, disc) = (rules.losses(self.lost_pin, columns), rules.losses(self.lost_disc, columns));
            let mut size = 0;
            while size < 2 {
                add::<L>(&mut moved.lost_pin[size].0[strip], pin[size]);
                if DISC_WEARS {
                    add::<L>(&mut moved.lost_disc[size].0[strip], disc[size]);
                }
                size += 1;
            }
        }
    }
}

#[inline(always)]
pub(super) fn add<L: Lanes>(chunk: &mut IntegerChunk, sum: L::Integers) {
    L::Integers::load(chunk).plus(sum).store(chunk);
}

/// Notes, for some of eight cells on resin whose build-up breaks away, what wear left of it.
#[cold]
#[inline(never)]
pub(super) fn note_broken(seldom: &mut Vec<SeldomEvent>, build_up: &Chunk, broken: u8, strip: usize) {
    let event = |lane: usize| SeldomEvent { returned: build_up.0[lane], ..SeldomEvent::in_row(strip * LANES + lane) };
    seldom.extend(lanes_of(broken).map(event));
}

/// Notes, for some of eight cells on resin whose build-up is worn through, its height and the gap of the pair.
#[cold]
#[inline(never)]
pub(super) fn note_worn_through(
    seldom: &mut Vec<SeldomEvent>,
    build_up: &Chunk,
    gap: &Chunk,
    worn_through: u8,
    strip: usize,
) {
    seldom.extend(lanes_of(worn_through).map(|lane| SeldomEvent {
        worn_through: build_up.0[lane],
        gap: gap.0[lane],
        ..SeldomEvent::in_row(strip * LANES + lane)
    }));
}
