//! The sweep of cells to which nothing out of the ordinary happens.
//!
//! Where build-up has the properties of what it lies on, it is ordinary
//! - to touch as a plateau and wear, or to be open and get the even deposit: the pin's part of it if there is a plateau
//!   ahead, and the whole of it, for there is room;
//! - to keep one's status where it matters: built-up resin stays built up, and bare resin stays bare;
//! - to be read for the next step as touching, as a plateau, or as open, but not as near.
//!
//! This takes a third of the instructions of [`super::cells`], and gives the same bits.

use std::ops::Range;

use super::cells::Strip;
use super::moved::{Moved, StripMoved};
use super::reading::{Reading, StripReading};
use super::rules::StripRules;
use crate::engine::lanes::{Chunk, Integers, Lanes, Mask};

/// Sweeps some columns of a strip, all cells of which are there, up to the first with a cell to which anything else happens;
/// returns that column.
#[inline(always)]
pub(super) fn sweep_ordinary<L: Lanes, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    Range { start, end: columns }: Range<usize>,
    moved: &mut Moved,
    reading: &mut Reading,
) -> usize {
    let z_behind = strip.behind::<L, false>(start).height;
    let mut ordinary = Ordinary {
        pin_height: &mut strip.pin.height[..columns],
        pin_substrate: if FORMS { &mut strip.pin.substrate[..columns] } else { &mut [] },
        resin: &strip.pin.resin[..columns],
        plateau: &strip.pin.plateau[..=columns],
        disc_height: &mut strip.disc_height[..columns],
        disc_substrate: if FORMS && DISC_WEARS { &mut strip.disc_substrate[..columns] } else { &mut [] },
        z_behind,
        pin_loss: rules.pin_loss().plateau(),
        disc_loss: rules.disc_loss().plateau(),
        unsupported_pin: rules.beyond(rules.zero, rules.even_on_pin),
        unsupported_disc: rules.beyond(rules.share, rules.even_on_disc),
        moved: StripMoved::new(),
        next: StripReading::new(),
        rules,
    };
    let mut column = start;
    while column < columns {
        // Nearly all cells are plateaus with a plateau ahead: they need not be told from others.
        let all_plateaus = ordinary.plateau[column] & ordinary.plateau[column + 1] == u8::MAX;
        let ordinary = if !FORMS || all_plateaus {
            ordinary.column::<false, DISC_WEARS, FORMS, DESTROYS>(column)
        } else {
            ordinary.column::<true, DISC_WEARS, FORMS, DESTROYS>(column)
        };
        if !ordinary {
            break;
        }
        column += 1;
    }
    let Ordinary { moved: strip_moved, next, .. } = ordinary;
    strip_moved.store::<false, FORMS>(strip.index, moved);
    next.store(strip.index, reading);
    column
}

/// A strip while its ordinary cells are swept.
struct Ordinary<'a, L: Lanes> {
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
    /// What an open cell gets that has no plateau ahead, beyond the even deposit.
    unsupported_pin: L::Integers,
    unsupported_disc: L::Integers,
    moved: StripMoved<L>,
    next: StripReading<L, false>,
}

impl<L: Lanes> Ordinary<'_, L> {
    /// Updates the eight cells of a column, and reads their pairs of the next step, if nothing out of the ordinary
    /// happens to any; else changes nothing. `MIXED` tells whether not all of them are plateaus with a plateau ahead.
    #[inline(always)]
    fn column<const MIXED: bool, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
        &mut self,
        column: usize,
    ) -> bool {
        let rules = self.rules;
        let (z_p, z_d) = (L::load(&self.pin_height[column]), L::load(&self.disc_height[column]));
        let on_resin = L::Mask::of_byte(self.resin[column]);

        // 4.1 and 4.2
        let clearance = z_p - z_d - rules.displacement;
        let open = clearance.at_least(rules.zero);
        let worn = z_p + clearance * self.pin_loss;
        let mut z_worn = z_d;
        let mut b_d = z_d;
        if DISC_WEARS {
            z_worn = L::select(open, z_d, z_d - clearance * self.disc_loss);
            b_d = if FORMS { L::load(&self.disc_substrate[column]).lesser(z_worn) } else { z_worn };
        }

        // 4P
        let (b_p, new_z_p, new_z_d, mut unusual);
        let (mut deposited_pin, mut deposited_disc) = (self.moved.deposited_pin, self.moved.deposited_disc);
        if !FORMS {
            (b_p, new_z_p, new_z_d) = (worn, L::select(open, z_p, worn), z_worn);
            unusual = on_resin & !open;
        } else if !MIXED {
            b_p = L::load(&self.pin_substrate[column]).greater(worn);
            new_z_p = L::select(open, z_p - rules.even_on_pin, worn);
            new_z_d = L::select(open, z_d + rules.even_on_disc, z_worn);
            unusual = clearance.within(rules.share) | new_z_p.at_least_where(on_resin, b_p);
        } else {
            let (plateau, ahead) = (self.plateau[column], self.plateau[column + 1]);
            let (is_plateau, supported) = (L::Mask::of_byte(plateau), L::Mask::of_byte(ahead));
            b_p = L::load(&self.pin_substrate[column]).greater(worn);
            new_z_p = L::select(open, z_p - rules.even_on_pin.only(supported), worn);
            new_z_d = L::select(open, z_d + L::select(supported, rules.even_on_disc, rules.share), z_worn);
            let unsupported = open & !supported;
            deposited_pin = deposited_pin.plus_where(unsupported, self.unsupported_pin);
            deposited_disc = deposited_disc.plus_where(unsupported, self.unsupported_disc);
            let built_up = new_z_p.below(b_p);
            let changes = on_resin & ((built_up & !is_plateau) | (!built_up & is_plateau));
            unusual = clearance.within(rules.share) | changes | (!open & !is_plateau);
            if DESTROYS {
                unusual = unusual | L::Mask::of_byte(self.resin[column] & plateau & !ahead);
            }
        }

        // 4.1 of the next step
        let mut next = self.next;
        let (touches, near) = next.add_plateaus(new_z_p - self.z_behind, &rules.bracket);
        unusual = unusual | near;
        if !FORMS {
            unusual = unusual | (touches & on_resin);
        } else if MIXED {
            unusual = unusual | (touches & !L::Mask::of_byte(self.plateau[column]));
        }
        if unusual.any() {
            return false;
        }

        new_z_p.store(&mut self.pin_height[column]);
        if FORMS {
            b_p.store(&mut self.pin_substrate[column]);
        }
        if FORMS || DISC_WEARS {
            new_z_d.store(&mut self.disc_height[column]);
        }
        if FORMS && DISC_WEARS {
            b_d.store(&mut self.disc_substrate[column]);
        }
        (self.moved.deposited_pin, self.moved.deposited_disc) = (deposited_pin, deposited_disc);
        self.next = next;
        self.z_behind = new_z_d;
        true
    }
}
