//! Reads columns of pairs against a bracket, without changing them (model 4.1).

use super::instructions::{InstructionSet, kernel};
use super::pairs::Pairs;
use super::reading::{Bracket, BracketLanes, Reading, StripReading};
use crate::engine::lanes::{Chunk, Lanes, Mask};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, NextStrip, PinStrips};
use std::ops::Range;

/// Columns of pairs: the pin's from `first` on lie over the sector's from `over` on.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// First column of the pin.
    pub first: usize,
    /// First column of the sector.
    pub over: usize,
    /// Number of columns.
    pub columns: usize,
}

impl Span {
    /// Span of some of its pin columns over the disc columns that they lie over in the next step; `joined` tells whether that of the
    /// first is to be read, too.
    pub(super) fn turned(self, some: Range<usize>, joined: bool) -> Self {
        let start = if joined { some.start } else { some.start.max(1) };
        Self { first: self.first + start, over: self.over + start - 1, columns: some.end.saturating_sub(start) }
    }
}

/// Reads the pairs of a span against a bracket.
pub type Read = fn(InstructionSet, &mut PinStrips, &DiscSector, Span, &Bracket, &mut Reading);

/// The reading that looks at what a scene needs and nothing else; chosen once per run.
pub fn read(needs: Needs) -> Read {
    match needs.build_up() {
        build_up::NONE => read_all::<{ build_up::NONE }>,
        build_up::DISTINCT => read_all::<{ build_up::DISTINCT }>,
        _ => read_all::<{ build_up::ALIKE }>,
    }
}

/// Reads all strips of a span.
fn read_all<const BUILD_UP: u8>(
    set: InstructionSet,
    pin: &mut PinStrips,
    disc: &DiscSector,
    span: Span,
    bracket: &Bracket,
    reading: &mut Reading,
) {
    let strips = 0..pin.height.strips();
    read_span::<BUILD_UP>(set, pin, disc, span, strips, bracket, reading);
}

kernel! {
    /// Reads some strips of a span.
    pub fn read_span<const BUILD_UP: u8>(
        pin: &mut PinStrips,
        disc: &DiscSector,
        span: Span,
        strips: Range<usize>,
        bracket: &Bracket,
        reading: &mut Reading,
    ) = read_strips
}

#[inline(always)]
fn read_strips<L: Lanes, const BUILD_UP: u8>(
    pin: &mut PinStrips,
    disc: &DiscSector,
    span: Span,
    strips: Range<usize>,
    bracket: &Bracket,
    reading: &mut Reading,
) {
    let bracket = BracketLanes::<L>::new(bracket);
    let nothing = L::Mask::of_byte(0);
    for strip in strips {
        let next = NextStrip::of(strip, pin, disc);
        let pin = pin.strip_mut(strip, span.first, span.columns);
        let disc_height = &disc.height.strip(strip)[span.over..][..span.columns];
        let disc_substrate = disc.substrate.as_ref().map(|field| &field.strip(strip)[span.over..][..span.columns]);
        let mut sums = StripReading::<L, BUILD_UP>::new();
        let mut column = 0;
        while column < span.columns {
            // With a transport length this comes last on a strip.
            let fields = ([&*pin.height, &*pin.substrate], [disc_height, &[]]);
            let end = NextStrip::fetch(next, column, span.columns, fields.0, fields.1);
            for column in column..end {
                let (z_p, z_d) = (L::load(&pin.height[column]), L::load(&disc_height[column]));
                let pairs = Pairs {
                    on_resin: L::Mask::of_byte(pin.resin[column]),
                    pin_secondary: match pin.substrate.get(column) {
                        Some(substrate) => z_p.below(L::load(substrate)),
                        None => nothing,
                    },
                    disc_secondary: match disc_substrate {
                        Some(substrate) if BUILD_UP == build_up::DISTINCT => L::load(&substrate[column]).below(z_d),
                        _ => nothing,
                    },
                };
                let place = [strip, span.first + column];
                pin.touches[column] = sums.add(z_p - z_d, !pin.plateau[column], pairs, &bracket, place, reading);
            }
            column = end;
        }
        sums.store(strip, reading);
    }
}

kernel! {
    /// Tells which rows of a strip have gaps below a displacement, column by column, one bit each.
    pub fn gaps_below<>(pin: &[Chunk], disc: &[Chunk], displacement: f64, rows: &mut [u8]) = columns_below
}

#[inline(always)]
fn columns_below<L: Lanes>(pin: &[Chunk], disc: &[Chunk], displacement: f64, rows: &mut [u8]) {
    let displacement = L::splat(displacement);
    for column in 0..rows.len() {
        rows[column] = (L::load(&pin[column]) - L::load(&disc[column])).below(displacement).byte();
    }
}
