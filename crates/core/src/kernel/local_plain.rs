//! The sweep with local debris of cells to which nothing out of the ordinary happens.
//!
//! Where build-up has the properties of what it lies on, it is ordinary
//! - to touch as a plateau and wear, or to be open;
//! - to get debris of plateaus ahead, if one is open and something ahead wears;
//! - to keep one's status where it matters: built-up resin stays built up, and bare resin stays bare;
//! - to be read for the next step as touching, as a plateau, or as open, but not as near.
//!
//! This takes a part of the instructions of [`super::local`], and gives the same bits.

use super::cells::Strip;
use super::lanes::{Chunk, Integers, Lanes, Mask};
use super::moved::{Moved, StripMoved};
use super::reading::{Reading, StripReading};
use super::rules::StripRules;

/// Sweeps the columns of a strip from `start` on, up to the last of the span or to the first with a cell to which anything
/// else happens; returns that column.
#[inline(always)]
pub(super) fn sweep_plain_locally<L: Lanes, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    start: usize,
    moved: &mut Moved,
    reading: &mut Reading,
) -> usize {
    let columns = strip.disc_height.len();
    let z_behind = strip.behind::<L, false>(start).height;
    let mut plain = Plain::<L> {
        rules,
        pin_height: &mut strip.pin.height[..columns],
        pin_substrate: &mut strip.pin.substrate[..columns],
        resin: &strip.pin.resin[..columns],
        plateau: &strip.pin.plateau[..columns],
        disc_height: &mut strip.disc_height[..columns],
        disc_substrate: if DISC_WEARS { &mut strip.disc_substrate[..columns] } else { &mut [] },
        z_behind,
        pin_loss: rules.pin_loss().plateau(),
        disc_loss: rules.disc_loss().plateau(),
        reference: rules.reference_height(),
        moved: StripMoved::new(),
        next: StripReading::new(),
    };
    let mut column = start;
    if let Some(mut worn) = plain.wear::<DISC_WEARS>(start) {
        while column + 1 < columns {
            let Some(ahead) = plain.wear::<DISC_WEARS>(column + 1) else { break };
            if !plain.finish::<DISC_WEARS>(column, &worn, &ahead) {
                break;
            }
            worn = ahead;
            column += 1;
        }
    }
    let Plain { moved: strip_moved, next, .. } = plain;
    strip_moved.store::<false, true>(strip.index, moved);
    next.store(strip.index, reading);
    column
}

/// A strip while its ordinary cells are swept.
struct Plain<'a, L: Lanes> {
    rules: &'a StripRules<'a, L>,
    pin_height: &'a mut [Chunk],
    pin_substrate: &'a mut [Chunk],
    resin: &'a [u8],
    plateau: &'a [u8],
    disc_height: &'a mut [Chunk],
    disc_substrate: &'a mut [Chunk],
    /// z_d behind the column.
    z_behind: L,
    pin_loss: L,
    disc_loss: L,
    /// z_ref, m.
    reference: L,
    moved: StripMoved<L>,
    next: StripReading<L, false>,
}

/// Eight plateaus or open cells after wear.
#[derive(Clone, Copy)]
struct Worn<L: Lanes> {
    z_p: L,
    b_p: L,
    z_d: L,
    clearance: L,
    touches: L::Mask,
    /// Raw losses of pin and disc, m.
    raw_pin: L,
    raw_disc: L,
}

impl<L: Lanes> Plain<'_, L> {
    /// Wears the eight cells of a column (model 4.1 and 4.2) without changing them; none where resin touches, bare or below
    /// a build-up that is worn through.
    #[inline(always)]
    fn wear<const DISC_WEARS: bool>(&self, column: usize) -> Option<Worn<L>> {
        let (start, mut z_d) = (L::load(&self.pin_height[column]), L::load(&self.disc_height[column]));
        let clearance = start - z_d - self.rules.displacement;
        let touches = clearance.below(self.rules.zero);
        let raw_pin = (clearance * self.pin_loss).only(touches);
        let mut raw_disc = self.rules.zero;
        let z_p = start + raw_pin;
        if DISC_WEARS {
            raw_disc = (clearance * self.disc_loss).only(touches);
            z_d = z_d - raw_disc;
        }
        let b_p = L::load(&self.pin_substrate[column]);
        let resin = touches & L::Mask::of_byte(self.resin[column]);
        if z_p.at_least_where(resin, b_p).any() {
            return None;
        }
        Some(Worn { z_p, b_p: b_p.greater(z_p), z_d, clearance, touches, raw_pin, raw_disc })
    }

    /// Compacts debris of the column ahead in the eight cells of a worn column, and reads their pairs of the next step, if
    /// nothing out of the ordinary happens to any; else changes nothing.
    #[inline(always)]
    fn finish<const DISC_WEARS: bool>(&mut self, column: usize, worn: &Worn<L>, ahead: &Worn<L>) -> bool {
        let rules = self.rules;
        let (mut z_p, mut z_d) = (worn.z_p, worn.z_d);
        let (mut deposited_pin, mut deposited_disc) = (self.moved.deposited_pin, self.moved.deposited_disc);
        let mut unusual = L::Mask::of_byte(0);

        // 4L
        let takes = !worn.touches & ahead.touches;
        let any_takes = takes.any();
        if any_takes {
            let supported = L::Mask::of_byte(self.plateau[column + 1]);
            let lost = if DISC_WEARS { ahead.raw_pin + ahead.raw_disc } else { ahead.raw_pin };
            let flush = L::select(supported, z_p.lesser(ahead.z_p), z_p);
            let (to_plateau, to_reference) = (z_p - flush, self.reference - z_d);
            let room = worn.clearance.lesser(to_plateau + to_reference);
            let deposit = room.lesser(rules.caught_of_plateaus(lost)).only(takes);
            let on_pin = deposit.lesser(to_plateau);
            let on_disc = deposit - on_pin;
            z_p = (z_p - on_pin).greater(flush);
            z_d = (z_d + on_disc).lesser(self.reference);
            deposited_pin = deposited_pin.plus(rules.deposit(on_pin));
            deposited_disc = deposited_disc.plus(rules.deposit(on_disc));
            let bare = !L::Mask::of_byte(self.plateau[column]);
            unusual = bare & z_p.below(worn.b_p);
        }

        // 4.1 of the next step
        let mut next = self.next;
        let (touches, near) = next.add_plateaus(z_p - self.z_behind, &rules.bracket);
        unusual = unusual | near | (touches & !L::Mask::of_byte(self.plateau[column]));
        if unusual.any() {
            return false;
        }

        z_p.store(&mut self.pin_height[column]);
        worn.b_p.store(&mut self.pin_substrate[column]);
        if DISC_WEARS || any_takes {
            z_d.store(&mut self.disc_height[column]);
        }
        if DISC_WEARS {
            L::load(&self.disc_substrate[column]).lesser(worn.z_d).store(&mut self.disc_substrate[column]);
        }
        (self.moved.deposited_pin, self.moved.deposited_disc) = (deposited_pin, deposited_disc);
        self.next = next;
        self.z_behind = z_d;
        true
    }
}
