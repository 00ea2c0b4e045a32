//! What a sweep moved, row by row.

use super::lanes::{Chunk, Integers, Lanes};
use super::pairs::lanes_of;
use crate::exact::{Exact, Quantum, RowIntegers};

/// What a step took off and put on, less what follows from its load balance alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Heights compacted on the pin, in quanta of the deposits.
    pub deposited_pin: RowIntegers,
    /// Heights compacted on the disc, in quanta of the deposits.
    pub deposited_disc: RowIntegers,
    /// What pin cells did not lose of their raw loss because their build-up was worn through, in quanta of the losses;
    /// only where build-up has properties of its own.
    pub spared_pin: RowIntegers,
    /// The same for disc cells.
    pub spared_disc: RowIntegers,
    /// What happens seldom.
    pub seldom: Seldom,
}

/// What happens in few cells of a step, row by row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Seldom {
    /// Whether anything did.
    pub happened: bool,
    /// Build-up of plateaus that fell, m.
    pub returned: Vec<Exact>,
    /// What resin did not lose because the build-up on it was worn through, m.
    pub spared: Vec<Exact>,
}

impl Moved {
    /// Nothing moved; what a scene does not need has no rows.
    pub fn new(strips: usize, forms: bool, distinct: bool) -> Self {
        let rows = |needed| RowIntegers::new(if needed { strips } else { 0 });
        let seldom = vec![Exact::default(); if forms { strips * 8 } else { 0 }];
        Self {
            deposited_pin: rows(forms),
            deposited_disc: rows(forms),
            spared_pin: rows(distinct),
            spared_disc: rows(distinct),
            seldom: Seldom { happened: false, returned: seldom.clone(), spared: seldom },
        }
    }

    /// Starts a new step.
    pub fn clear(&mut self) {
        for rows in [&mut self.deposited_pin, &mut self.deposited_disc, &mut self.spared_pin, &mut self.spared_disc] {
            rows.clear();
        }
        if self.seldom.happened {
            self.seldom.happened = false;
            self.seldom.returned.fill(Exact::default());
            self.seldom.spared.fill(Exact::default());
        }
    }
}

/// A sum of heights along a strip.
#[derive(Clone, Copy)]
pub(super) struct StripSum<L: Lanes> {
    anchor: L,
    sum: L::Integers,
}

impl<L: Lanes> StripSum<L> {
    /// Nothing yet.
    #[inline(always)]
    pub fn new(quantum: Quantum) -> Self {
        Self { anchor: L::splat(quantum.anchor()), sum: L::Integers::zero() }
    }

    /// Adds eight heights.
    #[inline(always)]
    pub fn add(&mut self, heights: L) {
        self.sum = self.sum.plus((self.anchor + heights).bits());
    }

    /// Adds the sum of `columns` columns to the others.
    #[inline(always)]
    pub fn store(self, strip: usize, columns: usize, quantum: Quantum, rows: &mut RowIntegers) {
        let mut sum = super::lanes::IntegerChunk([0; 8]);
        self.sum.store(&mut sum);
        let anchors = quantum.anchor_bits().wrapping_mul(columns as i64);
        for (row, sum) in rows.0[strip].0.iter_mut().zip(sum.0) {
            *row = row.wrapping_add(sum.wrapping_sub(anchors));
        }
    }
}

impl Seldom {
    /// Books, for some of eight cells on resin whose build-up ends, its height: returned where the plateau falls; where
    /// it is worn through, what the resin is spared of the raw loss.
    #[cold]
    #[inline(never)]
    pub(super) fn book(&mut self, build_up: &Chunk, raw: &Chunk, fallen: u8, worn_through: u8, strip: usize) {
        self.happened = true;
        for lane in lanes_of(fallen) {
            self.returned[strip * 8 + lane].add(Exact::of(build_up.0[lane]));
        }
        for lane in lanes_of(worn_through) {
            let spared = &mut self.spared[strip * 8 + lane];
            spared.add(Exact::of(raw.0[lane]));
            spared.subtract(Exact::of(build_up.0[lane]));
        }
    }
}

