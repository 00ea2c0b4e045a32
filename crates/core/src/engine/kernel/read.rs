//! Reads columns of pairs against a bracket, without changing them (model 4.1).

use super::instructions::{InstructionSet, kernel};
use super::pairs::Pairs;
use super::reading::{Bracket, BracketLanes, Reading, SeldomColumns, StripReading};
use crate::engine::lanes::{Chunk, Lanes, Mask};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, NextStrip, PinStrip, PinStrips};
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
    for index in strips {
        let next = NextStrip::of(index, pin, disc);
        let strip = Facing {
            pin: pin.strip_mut(index, span.first, span.columns),
            disc_height: &disc.height.strip(index)[span.over..][..span.columns],
            disc_substrate: match &disc.substrate {
                Some(field) if BUILD_UP == build_up::DISTINCT => &field.strip(index)[span.over..][..span.columns],
                _ => &[],
            },
        };
        let mut sums = StripReading::<L, BUILD_UP>::new();
        reading.begin_strip(span.columns);
        let mut column = 0;
        while column < span.columns {
            // With a transport length this comes last on a strip.
            let fields = ([&*strip.pin.height, &*strip.pin.substrate], [strip.disc_height, &[]]);
            let end = NextStrip::fetch(next, column, span.columns, fields.0, fields.1);
            while column < end {
                let (gap, pairs) = strip.pairs::<L, BUILD_UP>(column);
                [strip.pin.touches[column], reading.reached[column]] =
                    sums.add(gap, pairs, &bracket, index, &mut reading.overlap);
                column += 1;
            }
        }
        sums.store(index, reading);
        let mut seldom = SeldomColumns::of(&mut reading.reached, strip.pin.touches, strip.pin.plateau);
        while let Some(column) = seldom.next::<L>(&reading.reached) {
            let ((gap, pairs), bare) = (strip.pairs::<L, BUILD_UP>(column), !strip.pin.plateau[column]);
            let place = [index, span.first + column];
            StripReading::<L, BUILD_UP>::note_seldom(gap, bare, pairs, &bracket, place, reading);
        }
    }
}

/// Some columns of a strip of the pin, and the disc under them.
struct Facing<'a> {
    pin: PinStrip<'a>,
    /// Surface height z_d, m.
    disc_height: &'a [Chunk],
    /// Substrate height b_d, m; empty where statuses of the disc are not looked at.
    disc_substrate: &'a [Chunk],
}

impl Facing<'_> {
    /// Gaps g = z_p − z_d of a column, m, and the statuses of its pairs as far as they are looked at.
    #[inline(always)]
    fn pairs<L: Lanes, const BUILD_UP: u8>(&self, column: usize) -> (L, Pairs<L>) {
        let (z_p, z_d) = (L::load(&self.pin.height[column]), L::load(&self.disc_height[column]));
        let nothing = L::Mask::of_byte(0);
        let mut pairs = Pairs { on_resin: nothing, pin_secondary: nothing, disc_secondary: nothing };
        if BUILD_UP == build_up::DISTINCT {
            pairs = Pairs {
                on_resin: L::Mask::of_byte(self.pin.resin[column]),
                pin_secondary: z_p.below(L::load(&self.pin.substrate[column])),
                disc_secondary: L::load(&self.disc_substrate[column]).below(z_d),
            };
        }
        (z_p - z_d, pairs)
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
