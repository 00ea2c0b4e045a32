//! Wear of eight pairs, whatever happens to them (model 4.1 and 4.2).

use super::pairs::Pairs;
use super::rules::StripRules;
use crate::engine::lanes::{Chunk, Lanes, Mask};
use crate::engine::parts::build_up;
use crate::engine::wear;

/// Eight pairs as they are at the start of a step.
#[derive(Clone, Copy)]
pub(super) struct Cells<L: Lanes> {
    pub z_p: L,
    pub b_p: L,
    pub z_d: L,
    pub b_d: L,
    pub on_resin: L::Mask,
}

impl<L: Lanes> Cells<L> {
    /// From memory, as far as a scene keeps and needs the fields: without substrates b = z.
    #[inline(always)]
    pub fn load<const BUILD_UP: u8, const DISC_WEARS: bool>(
        [pin_height, pin_substrate, disc_height, disc_substrate]: [&[Chunk]; 4],
        resin: u8,
        [column, over]: [usize; 2],
    ) -> Self {
        let (z_p, z_d) = (L::load(&pin_height[column]), L::load(&disc_height[over]));
        Self {
            z_p,
            b_p: if BUILD_UP == build_up::NONE { z_p } else { L::load(&pin_substrate[column]) },
            z_d,
            b_d: if BUILD_UP == build_up::DISTINCT || (BUILD_UP != build_up::NONE && DISC_WEARS) {
                L::load(&disc_substrate[over])
            } else {
                z_d
            },
            on_resin: L::Mask::of_byte(resin),
        }
    }
}

/// Eight pairs after wear.
#[derive(Clone, Copy)]
pub(super) struct Worn<L: Lanes> {
    pub z_p: L,
    /// b_p before wear; that after it is no less than z_p.
    pub b_p: L,
    pub z_d: L,
    pub b_d: L,
    pub on_resin: L::Mask,
    /// Build-up on resin that is worn through.
    pub worn_through: L::Mask,
    /// Build-up on resin that breaks away, and is not worn through.
    pub broken: L::Mask,
    /// What plateaus of the pin and what the disc really lost, m; only where build-up has properties of its own.
    pub lost_pin: L,
    pub lost_disc: L,
}

/// Wears eight pairs.
#[inline(always)]
pub(super) fn wear<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    cells: Cells<L>,
) -> Worn<L> {
    let nothing = L::Mask::of_byte(0);
    let Cells { mut z_p, b_p, mut z_d, mut b_d, on_resin } = cells;

    // 4.1 The pair, and how far its cells are apart at the displacement.
    let pairs = Pairs::<L> {
        on_resin,
        pin_secondary: if BUILD_UP == build_up::NONE { nothing } else { z_p.below(b_p) },
        disc_secondary: if BUILD_UP == build_up::DISTINCT { b_d.below(z_d) } else { nothing },
    };
    let clearance = z_p - z_d - rules.displacement;
    let touches = clearance.below(rules.zero);

    // 4.2 Resin loses its wear height at once, all else wears by its coefficient times the overlap.
    let raw_pin = (clearance * pairs.pick::<BUILD_UP>(&rules.pin_loss())).only(touches & !pairs.resin());
    let mut lost_pin = rules.zero;
    if BUILD_UP == build_up::DISTINCT {
        let below = L::select(on_resin, rules.zero, pairs.pick::<{ build_up::DISTINCT }>(&rules.fibre()));
        let worn = wear::pin(z_p, b_p, raw_pin, below);
        (z_p, lost_pin) = (worn.height, worn.lost);
    } else {
        z_p = z_p + raw_pin;
    }
    let resin = touches & pairs.resin();
    z_p = z_p.plus_where(resin, rules.wear_height());
    let mut lost_disc = rules.zero;
    if DISC_WEARS {
        let raw_disc = (clearance * pairs.pick::<BUILD_UP>(&rules.disc_loss())).only(touches);
        if BUILD_UP == build_up::DISTINCT {
            let worn = wear::disc(z_d, b_d, raw_disc, pairs.pick::<{ build_up::DISTINCT }>(&rules.coating()));
            (z_d, lost_disc) = (worn.height, worn.lost);
        } else {
            z_d = z_d - raw_disc;
        }
        b_d = b_d.lesser(z_d);
    }

    // 4.2 Build-up on resin that is worn through leaves the resin.
    let worn_through = match BUILD_UP {
        build_up::NONE => nothing,
        _ => on_resin & pairs.pin_secondary & !z_p.below(b_p),
    };
    // 4.2a
    let mut broken = nothing;
    if (BUILD_UP == build_up::BRITTLE || BUILD_UP == build_up::DISTINCT)
        && let Some([on_coating, on_secondary]) = rules.rules.strength
    {
        let least = L::select(pairs.disc_secondary, L::splat(on_secondary), L::splat(on_coating));
        broken = on_resin & pairs.pin_secondary & clearance.below(least) & !worn_through;
    }
    Worn { z_p, b_p, z_d, b_d, on_resin, worn_through, broken, lost_pin, lost_disc }
}
