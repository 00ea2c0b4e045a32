//! One pass over the pin: wear, destruction and formation of a step, and the pairs of the next step against a bracket
//! (model 4.2 to 4.4, and 4.1 of the next step).
//!
//! In the next step the disc column under pin column j lies under column j + 1. So when column j + 1 has been updated,
//! the new heights of that pair are at hand, and are read on the way.
//!
//! In most steps nothing out of the ordinary happens to most cells: those that touch are plateaus and wear, those that
//! are open get the even deposit, and statuses stay. Eight such cells at a time are done with few instructions, which
//! also show where something else happens; those eight are then done by all rules.

use std::ops::Range;

use super::cells::{Strip, update};
use super::instructions::{InstructionSet, kernel};
use super::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use super::moved::{Moved, StripMoved};
use super::read::Span;
use super::reading::{Reading, StripReading};
use super::rules::{Conditions, Rules, StripRules};
use crate::parts::Needs;
use crate::strips::{DiscSector, PinStrip, PinStrips};

/// Columns of a strip to which something out of the ordinary happened before the rest is swept without expecting anything.
const MOST_UNUSUAL: usize = 12;

/// A sweep over a span; the flag tells whether the pair of its first pin column with the disc column before its first
/// is to be read for the next step.
pub type Sweep =
    fn(InstructionSet, &Rules, &Conditions, &mut PinStrips, &mut DiscSector, Span, bool, &mut Moved, &mut Reading);

/// The sweep that does what a scene needs and nothing else; chosen once per run.
pub fn sweep(needs: Needs) -> Sweep {
    let Needs { distinct, disc_wears, forms, destroys } = needs;
    macro_rules! choose {
        ([$($chosen:literal),*]) => { sweep_span::<$($chosen),*> };
        ([$($chosen:literal),*] $flag:ident $($rest:ident)*) => {
            if $flag { choose!([$($chosen,)* true] $($rest)*) } else { choose!([$($chosen,)* false] $($rest)*) }
        };
    }
    choose!([] distinct disc_wears forms destroys)
}

kernel! {
    /// Sweeps a span.
    pub fn sweep_span<const DISTINCT, const DISC_WEARS, const FORMS, const DESTROYS>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        joined: bool,
        moved: &mut Moved,
        reading: &mut Reading,
    ) = sweep_strips
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the kernel's own")]
fn sweep_strips<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    joined: bool,
    moved: &mut Moved,
    reading: &mut Reading,
) {
    let Span { first, over, columns } = span;
    for index in 0..pin.height.strips() {
        let PinStrip { height, substrate, resin, plateau } = pin.strip_mut(index, first..first + columns + 1);
        let (disc_height, disc_substrate) = disc.strip_mut(index);
        let mut strip = Strip {
            index,
            pin: PinStrip { height, substrate, resin, plateau },
            behind_height: if joined { disc_height[over - 1] } else { Chunk([f64::NEG_INFINITY; LANES]) },
            behind_secondary: 0,
            disc_height: &mut disc_height[over..][..columns],
            disc_substrate: &mut [],
        };
        if FORMS {
            let (before, substrate) = disc_substrate.split_at_mut(over);
            if DISTINCT && let (true, Some(before)) = (joined, before.last()) {
                strip.behind_secondary = L::load(before).below(L::load(&strip.behind_height)).byte();
            }
            strip.disc_substrate = &mut substrate[..columns];
        }
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        let (mut column, mut unusual) = (0, 0);
        while column < columns {
            if !DISTINCT && unusual <= MOST_UNUSUAL {
                column = sweep_plain::<L, DISC_WEARS, FORMS, DESTROYS>(&strip_rules, &mut strip, column, moved, reading);
            }
            let end = if !DISTINCT && unusual <= MOST_UNUSUAL { columns.min(column + 1) } else { columns };
            sweep_any::<L, DISTINCT, DISC_WEARS, FORMS, DESTROYS>(
                &strip_rules,
                &mut strip,
                column..end,
                moved,
                reading,
            );
            (column, unusual) = (end, unusual + 1);
        }
    }
}

/// Sweeps some columns of a strip, whatever happens to their cells.
#[inline(always)]
fn sweep_any<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    columns: Range<usize>,
    moved: &mut Moved,
    reading: &mut Reading,
) {
    if columns.is_empty() {
        return;
    }
    let mut strip_moved = StripMoved::<L>::new();
    let mut next = StripReading::<L, DISTINCT>::new();
    let mut behind = strip.behind::<L, DISTINCT>(columns.start);
    for column in columns {
        behind = update::<L, DISTINCT, DISC_WEARS, FORMS, DESTROYS>(
            rules,
            strip,
            column,
            behind,
            &mut strip_moved,
            &mut moved.seldom,
            &mut next,
            reading,
        );
    }
    strip_moved.store::<DISTINCT, FORMS>(strip.index, moved);
    next.store(strip.index, reading);
}

/// Sweeps the columns of a strip from `start` on, up to the first with a cell to which anything out of the ordinary
/// happens; returns that column.
///
/// Where build-up has the properties of what it lies on, it is ordinary
/// - to touch as a plateau and wear, or to be open and get the even deposit: as much as there is a plateau ahead for, and
///   no more than there is room for;
/// - to keep one's status where it matters: resin that is built up stays so, and bare resin stays bare;
/// - to be read for the next step as touching, as a plateau, or as open, but not as near.
#[inline(always)]
fn sweep_plain<L: Lanes, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    start: usize,
    moved: &mut Moved,
    reading: &mut Reading,
) -> usize {
    let mut strip_moved = StripMoved::<L>::new();
    let mut next = StripReading::<L, false>::new();
    let pin_loss = rules.pin_loss.plateau();
    let disc_loss = rules.disc_loss.plateau();
    // What an open cell gets that has no plateau ahead, beyond the even deposit.
    let unsupported_pin = rules.beyond(rules.zero, rules.even_on_pin);
    let unsupported_disc = rules.beyond(rules.share, rules.even_on_disc);

    let mut z_behind = strip.behind::<L, false>(start).height;
    let columns = strip.disc_height.len();
    let PinStrip { height, substrate, resin, plateau } = &mut strip.pin;
    let (height, resin, plateau) = (&mut height[..columns], &resin[..columns], &plateau[..=columns]);
    let substrate = if FORMS { &mut substrate[..columns] } else { &mut [] };
    let disc_height = &mut *strip.disc_height;
    let disc_substrate = if FORMS && DISC_WEARS { &mut strip.disc_substrate[..columns] } else { &mut [] };

    let mut column = start;
    while column < columns {
        let (z_p, z_d) = (L::load(&height[column]), L::load(&disc_height[column]));
        let (plateau, ahead) = (plateau[column], plateau[column + 1]);

        // 4.1 and 4.2
        let clearance = z_p - z_d - rules.displacement;
        let open = clearance.at_least(rules.zero);
        let worn = z_p + clearance * pin_loss;
        let b_p = if FORMS { L::load(&substrate[column]).greater(worn) } else { worn };
        let mut z_worn = z_d;
        let mut b_d = z_d;
        if DISC_WEARS {
            z_worn = L::select(open, z_d, z_d - clearance * disc_loss);
            b_d = if FORMS { L::load(&disc_substrate[column]).lesser(z_worn) } else { z_worn };
        }

        let (new_z_p, new_z_d, mut unusual);
        let mut with_these = strip_moved;
        if !FORMS {
            (new_z_p, new_z_d) = (L::select(open, z_p, worn), z_worn);
            unusual = !open & L::Mask::of_byte(resin[column]);
        } else {
            // 4.4
            unusual = clearance.within(rules.share);
            let on_resin = L::Mask::of_byte(resin[column]);
            if plateau & ahead == u8::MAX {
                new_z_p = L::select(open, z_p - rules.even_on_pin, worn);
                new_z_d = L::select(open, z_d + rules.even_on_disc, z_worn);
                unusual = unusual | new_z_p.at_least_where(on_resin, b_p);
            } else {
                let (is_plateau, supported) = (L::Mask::of_byte(plateau), L::Mask::of_byte(ahead));
                new_z_p = L::select(open, z_p - rules.even_on_pin.only(supported), worn);
                new_z_d = L::select(open, z_d + L::select(supported, rules.even_on_disc, rules.share), z_worn);
                let unsupported = open & !supported;
                with_these.deposited_pin = with_these.deposited_pin.plus_where(unsupported, unsupported_pin);
                with_these.deposited_disc = with_these.deposited_disc.plus_where(unsupported, unsupported_disc);
                let built_up = new_z_p.below(b_p);
                let changes = on_resin & ((built_up & !is_plateau) | (!built_up & is_plateau));
                let falls = if DESTROYS { L::Mask::of_byte(resin[column] & plateau & !ahead) } else { !open & open };
                unusual = unusual | changes | falls | (!open & !is_plateau);
            }
        }

        // 4.1 of the next step
        let mut next_with_these = next;
        unusual = unusual | next_with_these.add_plain(new_z_p - z_behind, &rules.bracket, plateau);
        if unusual.any() {
            break;
        }
        (next, strip_moved) = (next_with_these, with_these);
        new_z_p.store(&mut height[column]);
        if FORMS {
            b_p.store(&mut substrate[column]);
        }
        if FORMS || DISC_WEARS {
            new_z_d.store(&mut disc_height[column]);
        }
        if FORMS && DISC_WEARS {
            b_d.store(&mut disc_substrate[column]);
        }
        z_behind = new_z_d;
        column += 1;
    }
    strip_moved.store::<false, FORMS>(strip.index, moved);
    next.store(strip.index, reading);
    column
}
