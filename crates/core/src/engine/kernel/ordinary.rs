//! Wear of cells to which nothing out of the ordinary happens.
//!
//! Where build-up has the properties of what it lies on, it is ordinary to touch as a plateau and wear, but not through build-up on
//! resin, which does not break away either, or to be open.
//!
//! This takes a part of the instructions of [`super::pass`], and gives the same bits: b_p of fibres follows z_p up only
//! when debris comes upon them, as is said at [`crate::engine::strips::PinStrips::substrate`].

use std::ops::Range;

use super::reading::StripReading;
use super::rules::StripRules;
use super::strip::Strip;
use crate::engine::lanes::{Chunk, Lanes, Mask};
use crate::engine::parts::build_up;

/// Passes over columns of a strip, not the first one of it, up to the first with a cell to which anything else happens; returns that
/// column.
#[inline(always)]
pub(super) fn pass_over_ordinary<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    columns: Range<usize>,
    next: &mut StripReading<L, BUILD_UP>,
    reached: &mut [u8],
) -> usize {
    let Range { start, end } = columns;
    let mut ordinary = Ordinary::<L, BUILD_UP> {
        rules,
        resin_touches: strip.resin_touches,
        pin_height: &mut strip.pin.height[start..end],
        pin_substrate: if BUILD_UP == build_up::NONE { &[] } else { &strip.pin.substrate[start..end] },
        resin: &strip.pin.resin[start..end],
        touches: &mut strip.pin.touches[start..end],
        disc_height: &mut strip.disc_height[start - 1..end],
        disc_substrate: if DISC_WEARS && BUILD_UP != build_up::NONE {
            &mut strip.disc_substrate[start..end]
        } else {
            &mut []
        },
        strength: L::splat(rules.rules.strength.map_or(f64::INFINITY, |[on_coating, _]| -on_coating)),
        pin_loss: rules.zero - rules.pin_loss.plateau(),
        disc_loss: rules.zero - rules.disc_loss.plateau(),
        next: *next,
        reached: &mut reached[start..end],
    };
    let mut column = 0;
    while column < end - start && ordinary.column::<DISC_WEARS>(column) {
        column += 1;
    }
    *next = ordinary.next;
    start + column
}

/// A strip while its ordinary cells wear.
struct Ordinary<'a, L: Lanes, const BUILD_UP: u8> {
    rules: &'a StripRules<'a, L>,
    /// True if a cell of the strip touches whose base is resin: b_p is looked at only then.
    resin_touches: bool,
    pin_height: &'a mut [Chunk],
    pin_substrate: &'a [Chunk],
    resin: &'a [u8],
    touches: &'a mut [u8],
    /// Of the columns behind, and of the last.
    disc_height: &'a mut [Chunk],
    disc_substrate: &'a mut [Chunk],
    /// Overlap above which build-up on resin breaks away, m.
    strength: L,
    /// Raw losses per overlap.
    pin_loss: L,
    disc_loss: L,
    next: StripReading<L, BUILD_UP>,
    reached: &'a mut [u8],
}

impl<L: Lanes, const BUILD_UP: u8> Ordinary<'_, L, BUILD_UP> {
    /// Wears the eight cells of a column, and reads their pairs of the next step, if nothing out of the ordinary happens
    /// to any; else changes nothing.
    #[inline(always)]
    fn column<const DISC_WEARS: bool>(&mut self, column: usize) -> bool {
        let (z_p, z_d) = (L::load(&self.pin_height[column]), L::load(&self.disc_height[column + 1]));

        // 4.2
        let overlap = (self.rules.displacement - (z_p - z_d)).greater(self.rules.zero);
        let worn = z_p + overlap * self.pin_loss;
        // Bare resin, or build-up on resin that is worn through or breaks away.
        if self.resin_touches {
            let mut on_ground = u8::MAX;
            if BUILD_UP != build_up::NONE {
                on_ground = worn.at_least(L::load(&self.pin_substrate[column])).byte();
            }
            if BUILD_UP == build_up::BRITTLE {
                on_ground |= self.strength.below(overlap).byte();
            }
            if on_ground & self.resin[column] & self.touches[column] != 0 {
                return false;
            }
        }
        worn.store(&mut self.pin_height[column]);

        // 4.1 of the next step
        let gap = worn - L::load(&self.disc_height[column]);
        [self.touches[column], self.reached[column]] = self.next.add_alike(gap, &self.rules.bracket);
        if DISC_WEARS {
            let z_d = z_d - overlap * self.disc_loss;
            z_d.store(&mut self.disc_height[column + 1]);
            if BUILD_UP != build_up::NONE {
                L::load(&self.disc_substrate[column]).lesser(z_d).store(&mut self.disc_substrate[column]);
            }
        }
        true
    }
}
