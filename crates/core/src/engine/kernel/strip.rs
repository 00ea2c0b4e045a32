//! A strip of the columns that a pass goes over, and what lies behind them.

use super::read::Span;
use super::worn::Cells;
use crate::engine::lanes::{Chunk, LANES, Lanes, Mask};
use crate::engine::parts::build_up;
use crate::engine::strips::{DiscSector, PinStrip, PinStrips};
use std::ops::Range;

/// A strip of a span.
#[derive(Debug)]
pub(super) struct Strip<'a> {
    /// Its number among those of the worker.
    pub index: usize,
    /// The first column of the pin.
    pub first: usize,
    /// The pin, with the column that is ahead of the last.
    pub pin: PinStrip<'a>,
    /// Columns outside of which no cell of the pin is there.
    pub extent: Range<usize>,
    /// z_d, m.
    pub disc_height: &'a mut [Chunk],
    /// b_d, m; empty where it is not kept.
    pub disc_substrate: &'a mut [Chunk],
    /// z_d of the column behind the first, m; infinitely low where that is not to be read.
    behind_height: Chunk,
    /// Which of its cells are secondary, one bit each.
    behind_secondary: u8,
}

/// The disc cells that the pin cells of a column lie over in the next step.
#[derive(Clone, Copy)]
pub(super) struct Behind<L: Lanes> {
    pub height: L,
    pub secondary: L::Mask,
}

impl<'a> Strip<'a> {
    /// A strip of a span; `joined` tells whether what lies behind its first column is to be read.
    #[inline(always)]
    pub fn new<L: Lanes, const BUILD_UP: u8>(
        index: usize,
        pin: &'a mut PinStrips,
        disc: &'a mut DiscSector,
        Span { first, over, columns }: Span,
        joined: bool,
    ) -> Self {
        let (disc_height, disc_substrate) = disc.strip_mut(index);
        let mut strip = Self {
            index,
            first,
            extent: pin.extent(index, first..first + columns),
            pin: pin.strip_mut(index, first..first + columns + 1),
            behind_height: if joined { disc_height[over - 1] } else { Chunk([f64::NEG_INFINITY; LANES]) },
            behind_secondary: 0,
            disc_height: &mut disc_height[over..][..columns],
            disc_substrate: &mut [],
        };
        if BUILD_UP != build_up::NONE {
            let (before, substrate) = disc_substrate.split_at_mut(over);
            if BUILD_UP == build_up::DISTINCT
                && let (true, Some(before)) = (joined, before.last())
            {
                strip.behind_secondary = L::load(before).below(L::load(&strip.behind_height)).byte();
            }
            strip.disc_substrate = &mut substrate[..columns];
        }
        strip
    }

    /// A strip of the columns of a span alone, of which what lies behind is not to be read: of fields of one length it is seen that
    /// each has a column that one has.
    #[inline(always)]
    pub fn alone<L: Lanes, const BUILD_UP: u8>(
        index: usize,
        pin: &'a mut PinStrips,
        disc: &'a mut DiscSector,
        span: Span,
    ) -> Self {
        let mut strip = Self::new::<L, BUILD_UP>(index, pin, disc, span, false);
        strip.shorten(span.columns);
        strip
    }

    /// Leaves out the columns from `end` on.
    #[inline(always)]
    fn shorten(&mut self, end: usize) {
        let PinStrip { height, substrate, resin, plateau, touches, present } = &mut self.pin;
        *height = &mut std::mem::take(height)[..end];
        *substrate = &mut std::mem::take(substrate)[..end];
        *resin = &resin[..end];
        *plateau = &mut std::mem::take(plateau)[..end];
        *touches = &mut std::mem::take(touches)[..end];
        *present = &present[..present.len().min(end)];
        self.disc_height = &mut std::mem::take(&mut self.disc_height)[..end];
        self.disc_substrate = &mut std::mem::take(&mut self.disc_substrate)[..end];
    }

    /// The pairs of a column, as far as a scene keeps and needs the fields: without substrates b = z.
    #[inline(always)]
    pub fn cells<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(&self, column: usize) -> Cells<L> {
        let (z_p, z_d) = (L::load(&self.pin.height[column]), L::load(&self.disc_height[column]));
        Cells {
            z_p,
            b_p: if BUILD_UP == build_up::NONE { z_p } else { L::load(&self.pin.substrate[column]) },
            z_d,
            b_d: if BUILD_UP == build_up::DISTINCT || (BUILD_UP != build_up::NONE && DISC_WEARS) {
                L::load(&self.disc_substrate[column])
            } else {
                z_d
            },
            on_resin: L::Mask::of_byte(self.pin.resin[column]),
        }
    }

    /// What lies behind a column.
    #[inline(always)]
    pub fn behind<L: Lanes, const BUILD_UP: u8>(&self, column: usize) -> Behind<L> {
        if column == 0 {
            return Behind { height: L::load(&self.behind_height), secondary: L::Mask::of_byte(self.behind_secondary) };
        }
        let height = L::load(&self.disc_height[column - 1]);
        let substrate = if BUILD_UP == build_up::DISTINCT { L::load(&self.disc_substrate[column - 1]) } else { height };
        Behind { height, secondary: substrate.below(height) }
    }
}
