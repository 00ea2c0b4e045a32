//! A strip of the columns that a pass goes over, and what lies behind them.

use super::read::Span;
use super::worn::Cells;
use crate::engine::lanes::{Chunk, LANES, Lanes, Mask};
use crate::engine::parts::build_up;
use crate::engine::strips::{DiscSector, NextStrip, PinStrip, PinStrips};
use std::ops::Range;

/// A strip of a span.
#[derive(Debug)]
pub(super) struct Strip<'a> {
    /// Number among the strips of the worker.
    pub index: usize,
    /// The first column of the pin.
    pub first: usize,
    /// Columns of the pin.
    pub pin: PinStrip<'a>,
    /// Columns outside of which no cell of the pin is there.
    pub extent: Range<usize>,
    /// True if a cell of them touches whose base is resin: b_p means something to what wears only then.
    pub resin_touches: bool,
    /// Surface height z_d, m.
    pub disc_height: &'a mut [Chunk],
    /// Substrate height b_d, m; empty where it is not kept.
    pub disc_substrate: &'a mut [Chunk],
    /// Surface height z_d of the column behind the first, m; infinitely low where that is not to be read.
    behind_height: Chunk,
    /// Secondary cells of the column behind the first, one bit each.
    behind_secondary: u8,
    /// The next strip, where it is to be fetched.
    next: Option<NextStrip>,
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
        let (mut behind_height, mut behind_secondary) = (Chunk([f64::NEG_INFINITY; LANES]), 0);
        if joined {
            behind_height = *disc.height.chunk(index, over - 1);
            if BUILD_UP == build_up::DISTINCT {
                let substrate = L::load(disc.substrate().chunk(index, over - 1));
                behind_secondary = substrate.below(L::load(&behind_height)).byte();
            }
        }
        let extent = pin.extent(index, first..first + columns);
        let resin_touches = pin.resin_touches(index, first..first + columns);
        let next = NextStrip::of(index, pin, disc);
        let mut pin = pin.strip_mut(index, first, columns);
        let (disc_height, mut disc_substrate) = disc.strip_mut(index, over, columns);
        if BUILD_UP != build_up::NONE {
            // Fields that may not be kept are checked once for all columns.
            pin.substrate = &mut std::mem::take(&mut pin.substrate)[..columns];
            disc_substrate = &mut disc_substrate[..columns];
        }
        Self {
            index,
            first,
            extent,
            pin,
            resin_touches,
            disc_height,
            disc_substrate,
            behind_height,
            behind_secondary,
            next,
        }
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

    /// Has the next strip fetched from a column on, as far as a scene needs the fields, and returns up to which column, at most an end.
    #[inline(always)]
    pub fn fetch_next<const BUILD_UP: u8, const DISC_WEARS: bool>(&self, column: usize, end: usize) -> usize {
        let of_disc = if BUILD_UP == build_up::DISTINCT || DISC_WEARS { &*self.disc_substrate } else { &[] };
        let all = BUILD_UP == build_up::DISTINCT || self.next.is_some_and(|next| next.resin_touches);
        let of_pin = if all { &*self.pin.substrate } else { &[] };
        NextStrip::fetch(self.next, column, end, [self.pin.height, of_pin], [self.disc_height, of_disc])
    }

    /// Tells whether b_p of what debris comes upon is still to be fetched: [`Strip::fetch_next`] did not for the strip before.
    #[inline(always)]
    pub fn lacks_substrate<const BUILD_UP: u8>(&self) -> bool {
        BUILD_UP != build_up::DISTINCT && self.next.is_some() && !self.resin_touches
    }

    /// Returns which cells of a column of the pin are secondary; looked at only where build-up has properties of its own.
    #[inline(always)]
    pub fn pin_secondary<L: Lanes, const BUILD_UP: u8>(&self, column: usize) -> L::Mask {
        if BUILD_UP != build_up::DISTINCT {
            return L::Mask::of_byte(0);
        }
        L::load(&self.pin.height[column]).below(L::load(&self.pin.substrate[column]))
    }

    /// Returns the disc cells behind a column.
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
