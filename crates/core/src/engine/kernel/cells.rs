//! Wear and pooled debris in eight cells, whatever happens to them (model 4.2 and 4P), and their pairs of the next step
//! (4.1).

use super::instructions::InstructionSet;
use super::moved::{Moved, SeldomEvent, StripMoved, note_seldom};
use super::pairs::Pairs;
use super::read::Span;
use super::reading::{Reading, StripReading};
use super::rules::{Conditions, Rules, StripRules};
use super::worn::{Cells, Worn, wear};
use crate::engine::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use crate::engine::pin_strips::{PinStrip, PinStrips};
use crate::engine::plateau;
use crate::engine::presence::Extent;
use crate::engine::strips::DiscSector;

/// Columns of a strip with something out of the ordinary after which it is not looked for any more.
pub(super) const MOST_UNUSUAL: usize = 12;

/// A sweep over a span; the flag tells whether the pair of its first pin column with the disc column before its first
/// is to be read for the next step.
pub type Sweep =
    fn(InstructionSet, &Rules, &Conditions, &mut PinStrips, &mut DiscSector, Span, bool, &mut Moved, &mut Reading);

/// A strip of the columns that are swept.
#[derive(Debug)]
pub(super) struct Strip<'a> {
    /// Which, of the worker's.
    pub index: usize,
    /// The first column of the pin.
    pub first: usize,
    /// The pin, with the column that is ahead of the last.
    pub pin: PinStrip<'a>,
    /// Which of the columns have cells of the pin.
    pub extent: Extent,
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

impl<'a> Strip<'a> {
    /// A strip of a span; `joined` tells whether what lies behind its first column is to be read.
    #[inline(always)]
    pub fn new<L: Lanes, const DISTINCT: bool, const FORMS: bool>(
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
        if FORMS {
            let (before, substrate) = disc_substrate.split_at_mut(over);
            if DISTINCT && let (true, Some(before)) = (joined, before.last()) {
                strip.behind_secondary = L::load(before).below(L::load(&strip.behind_height)).byte();
            }
            strip.disc_substrate = &mut substrate[..columns];
        }
        strip
    }

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
    // Statuses are those of the start of the step; the neighbour in the sliding direction is the next column.
    let supported = L::Mask::of_byte(strip.pin.plateau[column + 1]);
    let fields = [&*strip.pin.height, &*strip.pin.substrate, &*strip.disc_height, &*strip.disc_substrate];
    let cells = Cells::load::<DISTINCT, DISC_WEARS, FORMS>(fields, strip.pin.resin[column], [column, column]);
    let worn = wear::<L, DISTINCT, DISC_WEARS, FORMS>(rules, cells);
    let Worn { mut z_p, mut b_p, mut z_d, b_d, on_resin, mut clearance, touches, build_up, worn_through, .. } = worn;
    if DISTINCT {
        moved.lost_pin = rules.plus_loss(moved.lost_pin, worn.lost_pin);
        if DISC_WEARS {
            moved.lost_disc = rules.plus_loss(moved.lost_disc, worn.lost_disc);
        }
    }

    if FORMS {
        // 4.2 and 4P Build-up on resin that is worn through, or falls for want of support.
        let falls = if DESTROYS { plateau::falls::<L>(build_up & !worn_through, supported) } else { nothing };
        if (falls | worn_through).any() {
            let mut heights = Chunk([0.0; LANES]);
            let mut gaps = Chunk([0.0; LANES]);
            (b_p - L::select(falls, z_p, cells.z_p)).store(&mut heights);
            (cells.z_p - cells.z_d).store(&mut gaps);
            let through = if DISTINCT { nothing } else { worn_through };
            note_seldom(seldom, &heights, &gaps, falls.byte(), through.byte(), rules.strip);
            z_p = L::select(falls | worn_through, b_p, z_p);
            clearance = L::select(falls, z_p - z_d - rules.displacement, clearance);
        }
        b_p = b_p.greater(z_p);

        // 4P Debris at hand fills the clearance of open cells, wholly or in part.
        let open = match strip.pin.present.get(column) {
            Some(present) => !touches & L::Mask::of_byte(*present),
            None => !touches,
        };
        let filled = plateau::fill(clearance, rules.share).only(open);
        moved.limited = moved.limited | (filled.below(rules.share) & open);
        let on_pin = plateau::on_pin(filled, supported, rules.pad_share());
        let on_disc = filled - on_pin;
        z_p = z_p - on_pin;
        z_d = z_d + on_disc;
        let (beyond_pin, beyond_disc) =
            (rules.beyond(on_pin, rules.even_on_pin), rules.beyond(on_disc, rules.even_on_disc));
        moved.deposited_pin = moved.deposited_pin.plus_where(open, beyond_pin);
        moved.deposited_disc = moved.deposited_disc.plus_where(open, beyond_disc);
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
    next.add(z_p - behind.height, pairs, &rules.bracket, [strip.index, strip.first + column], reading);
    Behind { height: z_d, secondary: if DISTINCT { b_d.below(z_d) } else { nothing } }
}
