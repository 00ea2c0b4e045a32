//! Wear of cells to which nothing out of the ordinary happens.
//!
//! Where build-up has the properties of what it lies on, it is ordinary
//! - to touch as a plateau and wear, but not through build-up on resin, which does not break away either, or to be open;
//! - to be read for the next step as touching, as a plateau, or as open, but not as near.
//!
//! This takes a part of the instructions of [`super::pass`], and gives the same bits: b_p of fibres follows z_p up only
//! when debris comes upon them, as is said at [`crate::engine::strips::PinStrips::substrate`].

use std::ops::Range;

use super::reading::StripReading;
use super::rules::StripRules;
use super::strip::{Behind, Strip};
use crate::engine::lanes::{Chunk, Lanes, Mask};
use crate::engine::parts::build_up;

/// Passes over columns of a strip, up to the first with a cell to which anything else happens; returns that column.
#[inline(always)]
pub(super) fn pass_over_ordinary<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    columns: Range<usize>,
    behind: &mut Behind<L>,
    next: &mut StripReading<L, BUILD_UP>,
) -> usize {
    let Range { start, end } = columns;
    let mut ordinary = Ordinary::<L, BUILD_UP> {
        rules,
        pin_height: &mut strip.pin.height[start..end],
        pin_substrate: if BUILD_UP == build_up::NONE { &[] } else { &strip.pin.substrate[start..end] },
        resin: &strip.pin.resin[start..end],
        plateau: &strip.pin.plateau[start..end],
        touches: &mut strip.pin.touches[start..end],
        disc_height: &mut strip.disc_height[start..end],
        disc_substrate: if DISC_WEARS && BUILD_UP != build_up::NONE {
            &mut strip.disc_substrate[start..end]
        } else {
            &mut []
        },
        z_behind: behind.height,
        strength: L::splat(rules.rules.strength.map_or(f64::NEG_INFINITY, |[on_coating, _]| on_coating)),
        pin_loss: rules.pin_loss().plateau(),
        disc_loss: rules.disc_loss().plateau(),
        next: *next,
    };
    let mut column = 0;
    while column < end - start && ordinary.column::<DISC_WEARS>(column) {
        column += 1;
    }
    *next = ordinary.next;
    behind.height = ordinary.z_behind;
    start + column
}

/// A strip while its ordinary cells wear.
struct Ordinary<'a, L: Lanes, const BUILD_UP: u8> {
    rules: &'a StripRules<'a, L>,
    pin_height: &'a mut [Chunk],
    pin_substrate: &'a [Chunk],
    resin: &'a [u8],
    plateau: &'a [u8],
    touches: &'a mut [u8],
    disc_height: &'a mut [Chunk],
    disc_substrate: &'a mut [Chunk],
    /// z_d behind the column.
    z_behind: L,
    /// Clearance below which build-up on resin breaks away, m.
    strength: L,
    pin_loss: L,
    disc_loss: L,
    next: StripReading<L, BUILD_UP>,
}

impl<L: Lanes, const BUILD_UP: u8> Ordinary<'_, L, BUILD_UP> {
    /// Wears the eight cells of a column, and reads their pairs of the next step, if nothing out of the ordinary happens
    /// to any; else changes nothing.
    #[inline(always)]
    fn column<const DISC_WEARS: bool>(&mut self, column: usize) -> bool {
        let (z_p, mut z_d) = (L::load(&self.pin_height[column]), L::load(&self.disc_height[column]));

        // 4.2
        let clearance = z_p - z_d - self.rules.displacement;
        let touches = clearance.below(self.rules.zero);
        let worn = z_p + (clearance * self.pin_loss).only(touches);
        if DISC_WEARS {
            z_d = z_d - (clearance * self.disc_loss).only(touches);
        }
        // Bare resin, or build-up on resin that is worn through or breaks away.
        let mut on_ground = self.resin[column] & self.touches[column];
        if BUILD_UP != build_up::NONE {
            on_ground &= worn.at_least(L::load(&self.pin_substrate[column])).byte();
        }
        if BUILD_UP == build_up::BRITTLE {
            on_ground |= clearance.below(self.strength).byte() & self.resin[column] & self.touches[column];
        }

        // 4.1 of the next step
        let mut next = self.next;
        let (touches, near) = next.add_plateaus(worn - self.z_behind, &self.rules.bracket);
        let touching = touches.byte();
        if (on_ground | (touching & !self.plateau[column]) != 0) | near.any() {
            return false;
        }

        worn.store(&mut self.pin_height[column]);
        self.touches[column] = touching;
        if DISC_WEARS {
            z_d.store(&mut self.disc_height[column]);
            if BUILD_UP != build_up::NONE {
                L::load(&self.disc_substrate[column]).lesser(z_d).store(&mut self.disc_substrate[column]);
            }
        }
        self.next = next;
        self.z_behind = z_d;
        true
    }
}
