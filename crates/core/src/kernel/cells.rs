//! Wear, destruction and formation in eight cells, whatever happens to them (model 4.2 to 4.4), and their pairs of the
//! next step (4.1).

use super::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use super::moved::{SeldomEvent, StripMoved, note_seldom};
use super::pairs::Pairs;
use super::reading::{Reading, StripReading};
use super::rules::StripRules;
use crate::strips::PinStrip;
use crate::{plateau, wear};

/// A strip of the columns that are swept.
#[derive(Debug)]
pub(super) struct Strip<'a> {
    /// Which, of the worker's.
    pub index: usize,
    /// The pin, with the column that is ahead of the last.
    pub pin: PinStrip<'a>,
    /// z_d, m.
    pub disc_height: &'a mut [Chunk],
    /// b_d, m; empty where it is not kept.
    pub disc_substrate: &'a mut [Chunk],
    /// z_d of the column behind the first, m; infinitely low where that is not to be read.
    pub behind_height: Chunk,
    /// Which of its cells are secondary, one bit each.
    pub behind_secondary: u8,
}

/// The disc cells that the pin cells of a column lie over in the next step.
#[derive(Clone, Copy)]
pub(super) struct Behind<L: Lanes> {
    pub height: L,
    pub secondary: L::Mask,
}

impl Strip<'_> {
    /// What lies behind a column.
    #[inline(always)]
    pub fn behind<L: Lanes, const DISTINCT: bool>(&self, column: usize) -> Behind<L> {
        if column == 0 {
            return Behind { height: L::load(&self.behind_height), secondary: L::Mask::of_byte(self.behind_secondary) };
        }
        let height = L::load(&self.disc_height[column - 1]);
        let substrate = if DISTINCT { L::load(&self.disc_substrate[column - 1]) } else { height };
        Behind { height, secondary: substrate.below(height) }
    }
}

/// Updates the eight cells of a column, and reads what they do with what lies behind; returns what lies behind the next.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "what is summed stays in registers")]
pub(super) fn update<
    L: Lanes,
    const DISTINCT: bool,
    const DISC_WEARS: bool,
    const FORMS: bool,
    const DESTROYS: bool,
>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    column: usize,
    behind: Behind<L>,
    moved: &mut StripMoved<L>,
    seldom: &mut Vec<SeldomEvent>,
    next: &mut StripReading<L, DISTINCT>,
    reading: &mut Reading,
) -> Behind<L> {
    let nothing = L::Mask::of_byte(0);
    let on_resin = L::Mask::of_byte(strip.pin.resin[column]);
    // Statuses are those of the start of the step; the neighbour in the sliding direction is the next column.
    let supported = L::Mask::of_byte(strip.pin.plateau[column + 1]);

    // 4.1 The pair, and how far its cells are apart at the displacement: γ, or −u where they touch.
    let z_start = L::load(&strip.pin.height[column]);
    let mut z_p = z_start;
    let mut b_p = if FORMS { L::load(&strip.pin.substrate[column]) } else { z_p };
    let mut z_d = L::load(&strip.disc_height[column]);
    let mut b_d = if FORMS && (DISTINCT || DISC_WEARS) { L::load(&strip.disc_substrate[column]) } else { z_d };
    let pairs = Pairs::<L> {
        on_resin,
        pin_secondary: if FORMS { z_p.below(b_p) } else { nothing },
        disc_secondary: if DISTINCT { b_d.below(z_d) } else { nothing },
    };
    let mut clearance = z_p - z_d - rules.displacement;
    let touches = clearance.below(rules.zero);

    // 4.2 Resin loses its wear height at once, all else wears by its coefficient times the overlap.
    let raw = (clearance * pairs.pick::<DISTINCT>(&rules.pin_loss())).only(touches & !pairs.resin());
    if DISTINCT {
        let below = L::select(on_resin, rules.zero, pairs.pick::<true>(&rules.fibre()));
        let worn = wear::pin(z_p, b_p, raw, below);
        z_p = worn.height;
        moved.spared_pin = moved.spared_pin.plus(rules.loss(worn.spared));
    } else {
        z_p = z_p + raw;
    }
    z_p = z_p.plus_where(touches & pairs.resin(), rules.wear_height());
    if DISC_WEARS {
        let raw = (clearance * pairs.pick::<DISTINCT>(&rules.disc_loss())).only(touches);
        if DISTINCT {
            let worn = wear::disc(z_d, b_d, raw, pairs.pick::<true>(&rules.coating()));
            z_d = worn.height;
            moved.spared_disc = moved.spared_disc.plus(rules.loss(worn.spared));
        } else {
            z_d = z_d - raw;
        }
        b_d = b_d.lesser(z_d);
    }

    if FORMS {
        // 4.2 and 4.3 Build-up on resin that is worn through, or falls for want of support.
        let remains = z_p.below(b_p);
        let build_up = on_resin & pairs.pin_secondary;
        let falls = if DESTROYS { plateau::falls::<L>(build_up & remains, supported) } else { nothing };
        let worn_through = build_up & !remains;
        if (falls | worn_through).any() {
            let mut heights = Chunk([0.0; LANES]);
            let mut raw_losses = Chunk([0.0; LANES]);
            (b_p - L::select(falls, z_p, z_start)).store(&mut heights);
            raw.store(&mut raw_losses);
            let spared = if DISTINCT { nothing } else { worn_through };
            note_seldom(seldom, &heights, &raw_losses, falls.byte(), spared.byte(), rules.strip);
            z_p = L::select(falls | worn_through, b_p, z_p);
            clearance = L::select(falls, z_p - z_d - rules.displacement, clearance);
        }
        b_p = b_p.greater(z_p);

        // 4.4 Debris at hand fills the clearance of open cells, wholly or in part.
        let filled = plateau::fill(clearance, rules.share).only(!touches);
        moved.limited = moved.limited | (filled.below(rules.share) & !touches);
        let on_pin = plateau::on_pin(filled, supported, rules.pad_share());
        let on_disc = filled - on_pin;
        z_p = z_p - on_pin;
        z_d = z_d + on_disc;
        let (beyond_pin, beyond_disc) =
            (rules.beyond(on_pin, rules.even_on_pin), rules.beyond(on_disc, rules.even_on_disc));
        moved.deposited_pin = moved.deposited_pin.plus_where(!touches, beyond_pin);
        moved.deposited_disc = moved.deposited_disc.plus_where(!touches, beyond_disc);
        b_p.store(&mut strip.pin.substrate[column]);
        if DISC_WEARS {
            b_d.store(&mut strip.disc_substrate[column]);
        }
    }
    z_p.store(&mut strip.pin.height[column]);
    if FORMS || DISC_WEARS {
        z_d.store(&mut strip.disc_height[column]);
    }

    // 4.1 of the next step.
    let pin_secondary = if FORMS { z_p.below(b_p) } else { nothing };
    if FORMS {
        strip.pin.plateau[column] = (pin_secondary | !on_resin).byte();
    }
    let pairs = Pairs { on_resin, pin_secondary, disc_secondary: behind.secondary };
    next.add(z_p - behind.height, pairs, &rules.bracket, strip.index, reading);
    Behind { height: z_d, secondary: if DISTINCT { b_d.below(z_d) } else { nothing } }
}
