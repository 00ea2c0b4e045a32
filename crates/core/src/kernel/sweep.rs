//! One pass over the pin: wear, destruction and formation of a step, and the pairs of the next step against a bracket
//! (model 4.2 to 4.4, and 4.1 of the next step).
//!
//! In the next step the disc column under pin column j lies under column j + 1. So when column j + 1 has been updated,
//! the new heights of that pair are at hand, and are read on the way.

use super::instructions::{InstructionSet, kernel};
use super::lanes::{Chunk, LANES, Lanes, Mask};
use super::moved::{Moved, StripSum};
use super::pairs::{ChunkTable, Pairs};
use super::read::Span;
use super::reading::{Bracket, BracketLanes, Reading, StripReading};
use crate::exact::Quantum;
use crate::pair::Coefficients;
use crate::parameters::Parameters;
use crate::parts::Needs;
use crate::strips::{DiscSector, PinStrips};
use crate::{plateau, wear};

/// What stays the same in every step.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules {
    /// Raw loss of the pin per overlap, negative: the kernel has −u at hand.
    pin_loss: ChunkTable,
    /// Raw loss of the disc per overlap, negative.
    disc_loss: ChunkTable,
    fibre: ChunkTable,
    coating: ChunkTable,
    /// h_m, m.
    wear_height: f64,
    /// β.
    pad_share: f64,
}

impl Rules {
    /// The rules of a scene.
    pub fn new(parameters: &Parameters, coefficients: &Coefficients) -> Self {
        Self {
            pin_loss: ChunkTable::new(&coefficients.pin, -1.0),
            disc_loss: ChunkTable::new(&coefficients.disc, -1.0),
            fibre: ChunkTable::new(&coefficients.fibre, 1.0),
            coating: ChunkTable::new(&coefficients.coating, 1.0),
            wear_height: parameters.materials.wear_height,
            pad_share: parameters.plateaus.pad_share,
        }
    }
}

/// What a sweep must know of its step.
#[derive(Debug, Clone, Copy)]
pub struct Conditions<'a> {
    /// δ, m.
    pub displacement: f64,
    /// s of every row, m.
    pub share: &'a [Chunk],
    /// Of which deposits are counted as multiples.
    pub deposits: Quantum,
    /// Of which losses that were spared are counted as multiples.
    pub losses: Quantum,
    /// Where the next load balance is expected.
    pub bracket: Bracket,
}

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
    let zero = L::splat(0.0);
    let nothing = L::Mask::of_byte(0);
    let displacement = L::splat(conditions.displacement);
    let wear_height = L::splat(rules.wear_height);
    let pad_share = L::splat(rules.pad_share);
    let bracket = BracketLanes::<L>::new(&conditions.bracket);

    for strip in 0..pin.height.strips() {
        let share = L::load(&conditions.share[strip]);
        let pin_loss = rules.pin_loss.strip::<L>(strip);
        let disc_loss = rules.disc_loss.strip::<L>(strip);
        let fibre = rules.fibre.strip::<L>(strip);
        let coating = rules.coating.strip::<L>(strip);

        let (pin_height, pin_substrate, resin) = pin.strip_mut(strip, first, columns + 1);
        let (disc_height, disc_substrate) = disc.strip_mut(strip);
        let mut z_behind = if joined { L::load(&disc_height[over - 1]) } else { L::splat(f64::NEG_INFINITY) };
        let mut secondary_behind = nothing;
        if DISTINCT && joined {
            secondary_behind = L::load(&disc_substrate[over - 1]).below(z_behind);
        }
        let disc_height = &mut disc_height[over..][..columns];
        let disc_substrate = if FORMS { &mut disc_substrate[over..][..columns] } else { &mut [] };

        let mut next = StripReading::<L, DISTINCT>::new();
        let mut deposited_pin = StripSum::<L>::new(conditions.deposits);
        let mut deposited_disc = StripSum::<L>::new(conditions.deposits);
        let mut spared_pin = StripSum::<L>::new(conditions.losses);
        let mut spared_disc = StripSum::<L>::new(conditions.losses);

        let mut z_ahead = L::load(&pin_height[0]);
        let mut b_ahead = if FORMS { L::load(&pin_substrate[0]) } else { z_ahead };
        let mut on_resin_ahead = L::Mask::of_byte(resin[0]);
        let mut secondary_ahead = if FORMS { z_ahead.below(b_ahead) } else { nothing };

        for column in 0..columns {
            // The neighbour in the sliding direction as it is at the start of the step.
            let (mut z_p, mut b_p) = (z_ahead, b_ahead);
            let (on_resin, pin_secondary) = (on_resin_ahead, secondary_ahead);
            z_ahead = L::load(&pin_height[column + 1]);
            on_resin_ahead = L::Mask::of_byte(resin[column + 1]);
            if FORMS {
                b_ahead = L::load(&pin_substrate[column + 1]);
                secondary_ahead = z_ahead.below(b_ahead);
            }
            let supported = secondary_ahead | !on_resin_ahead;

            // 4.1 The pair, and how far its cells are apart at the displacement: γ, or −u where they touch.
            let mut z_d = L::load(&disc_height[column]);
            let mut b_d = z_d;
            let mut disc_secondary = nothing;
            if DISTINCT || (DISC_WEARS && FORMS) {
                b_d = L::load(&disc_substrate[column]);
                disc_secondary = b_d.below(z_d);
            }
            let pairs: Pairs<L> = Pairs { on_resin, pin_secondary, disc_secondary };
            let mut clearance = z_p - z_d - displacement;
            let touches = clearance.below(zero);

            // 4.2 Resin loses its wear height at once, all else wears by its coefficient times the overlap.
            let resin_touches = touches & pairs.resin();
            let wears = touches & !pairs.resin();
            let loss_per_overlap = if DISTINCT { pairs.pick::<true>(&pin_loss) } else { pin_loss.plateau() };
            let raw = clearance * loss_per_overlap;
            if DISTINCT {
                let below = L::select(on_resin, zero, pairs.pick::<true>(&fibre));
                let worn = wear::pin(z_p, b_p, raw.only(wears), below);
                z_p = worn.height;
                spared_pin.add(worn.spared);
            } else {
                z_p = z_p.plus_where(wears, raw);
            }
            if resin_touches.any() {
                z_p = z_p.plus_where(resin_touches, wear_height);
            }
            if DISC_WEARS {
                let raw = (clearance * pairs.pick::<DISTINCT>(&disc_loss)).only(touches);
                if DISTINCT {
                    let worn = wear::disc(z_d, b_d, raw, pairs.pick::<true>(&coating));
                    z_d = worn.height;
                    spared_disc.add(worn.spared);
                } else {
                    z_d = z_d - raw;
                }
                b_d = b_d.lesser(z_d);
            }

            if FORMS {
                // 4.2 and 4.3 Build-up on resin that is worn through, or falls for want of support.
                let remains = z_p.below(b_p);
                let build_up = on_resin & pin_secondary;
                let falls = if DESTROYS { plateau::falls::<L>(build_up & remains, supported) } else { nothing };
                let worn_through = build_up & !remains;
                if (falls | worn_through).any() {
                    let mut heights = Chunk([0.0; LANES]);
                    let mut raw_losses = Chunk([0.0; LANES]);
                    let spared = if DISTINCT { nothing } else { worn_through };
                    // The build-up that fell is what wear left of it; the one worn through is that of the start.
                    let at_start = L::load(&pin_height[column]);
                    (b_p - L::select(falls, z_p, at_start)).store(&mut heights);
                    raw.store(&mut raw_losses);
                    moved.seldom.book(&heights, &raw_losses, falls.byte(), spared.byte(), strip);
                    z_p = L::select(falls | worn_through, b_p, z_p);
                    clearance = L::select(falls, z_p - z_d - displacement, clearance);
                }
                b_p = b_p.greater(z_p);

                // 4.4 Debris at hand fills the clearance of open cells, wholly or in part.
                let filled = plateau::fill(clearance, share).only(!touches);
                let on_pin = plateau::on_pin(filled, supported, pad_share);
                let on_disc = filled - on_pin;
                z_p = z_p - on_pin;
                z_d = z_d + on_disc;
                deposited_pin.add(on_pin);
                deposited_disc.add(on_disc);
                b_p.store(&mut pin_substrate[column]);
            }
            z_p.store(&mut pin_height[column]);
            if FORMS || DISC_WEARS {
                z_d.store(&mut disc_height[column]);
            }
            if DISC_WEARS && FORMS {
                b_d.store(&mut disc_substrate[column]);
            }

            // 4.1 of the next step: this pin column over the disc column before.
            let pin_secondary = if FORMS { z_p.below(b_p) } else { nothing };
            let pairs: Pairs<L> = Pairs { on_resin, pin_secondary, disc_secondary: secondary_behind };
            next.add(z_p - z_behind, pairs, &bracket, strip, reading);
            z_behind = z_d;
            if DISTINCT {
                secondary_behind = b_d.below(z_d);
            }
        }

        next.store(strip, reading);
        if FORMS {
            deposited_pin.store(strip, columns, conditions.deposits, &mut moved.deposited_pin);
            deposited_disc.store(strip, columns, conditions.deposits, &mut moved.deposited_disc);
        }
        if DISTINCT {
            spared_pin.store(strip, columns, conditions.losses, &mut moved.spared_pin);
            if DISC_WEARS {
                spared_disc.store(strip, columns, conditions.losses, &mut moved.spared_disc);
            }
        }
    }
}
