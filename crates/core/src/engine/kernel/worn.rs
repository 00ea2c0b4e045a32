//! Wear of eight pairs, whatever happens to them (model 4.1 and 4.2).

use super::pairs::Pairs;
use super::rules::StripRules;
use crate::engine::lanes::{Lanes, Mask};
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

/// Eight pairs after wear.
#[derive(Clone, Copy)]
pub(super) struct Worn<L: Lanes> {
    pub z_p: L,
    /// Substrate height b_p before wear, m; that after it is no less than z_p.
    pub b_p: L,
    pub z_d: L,
    pub b_d: L,
    pub on_resin: L::Mask,
    /// Resin without build-up before wear.
    pub resin: L::Mask,
    /// Build-up on resin that is worn through.
    pub worn_through: L::Mask,
    /// Build-up on resin that breaks away, and is not worn through.
    pub broken: L::Mask,
    /// Heights that plateaus of the pin and the disc really lost, m.
    pub lost_pin: L,
    pub lost_disc: L,
}

impl<L: Lanes> Worn<L> {
    /// Surface height z_p without the build-up that is worn through or breaks away, m.
    #[inline(always)]
    pub fn height(&self) -> L {
        L::select(self.worn_through | self.broken, self.b_p, self.z_p)
    }

    /// Surface height z_p without such build-up, m, out of reach where there was no plateau before wear.
    #[inline(always)]
    pub fn height_of_plateaus(&self) -> L {
        L::select(self.resin, L::splat(f64::INFINITY), self.height())
    }

    /// Height that plateaus and the disc really lost, m; the disc only under plateaus if that is asked for (v of model 4L).
    #[inline(always)]
    pub fn lost<const DISC_WEARS: bool>(&self, under_plateaus: bool) -> L {
        match (DISC_WEARS, under_plateaus) {
            (false, _) => self.lost_pin,
            (true, false) => self.lost_pin + self.lost_disc,
            (true, true) => self.lost_pin + self.lost_disc.only(!self.resin),
        }
    }
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
    let raw_pin = (clearance * pairs.pick::<BUILD_UP>(&rules.pin_loss)).only(touches & !pairs.resin());
    let before = z_p;
    let mut lost_pin = raw_pin;
    if BUILD_UP == build_up::DISTINCT {
        let below = L::select(on_resin, rules.zero, pairs.pick::<{ build_up::DISTINCT }>(&rules.fibre));
        let worn = wear::pin(z_p, b_p, raw_pin, below);
        (z_p, lost_pin) = (worn.height, worn.lost);
    } else {
        z_p = z_p + raw_pin;
    }
    let resin = touches & pairs.resin();
    z_p = z_p.plus_where(resin, rules.wear_height());
    let mut lost_disc = rules.zero;
    if DISC_WEARS {
        let raw_disc = (clearance * pairs.pick::<BUILD_UP>(&rules.disc_loss)).only(touches);
        if BUILD_UP == build_up::DISTINCT {
            let worn = wear::disc(z_d, b_d, raw_disc, pairs.pick::<{ build_up::DISTINCT }>(&rules.coating));
            (z_d, lost_disc) = (worn.height, worn.lost);
        } else {
            (z_d, lost_disc) = (z_d - raw_disc, raw_disc);
        }
        b_d = b_d.lesser(z_d);
    }

    // 4.2 Build-up on resin that is worn through leaves the resin.
    let worn_through = match BUILD_UP {
        build_up::NONE => nothing,
        _ => on_resin & pairs.pin_secondary & !z_p.below(b_p),
    };
    if BUILD_UP != build_up::DISTINCT {
        lost_pin = L::select(worn_through, b_p - before, lost_pin);
    }
    // 4.2a
    let mut broken = nothing;
    if (BUILD_UP == build_up::BRITTLE || BUILD_UP == build_up::DISTINCT)
        && let Some([on_coating, on_secondary]) = rules.rules.strength
    {
        let least = L::select(pairs.disc_secondary, L::splat(on_secondary), L::splat(on_coating));
        broken = on_resin & pairs.pin_secondary & clearance.below(least) & !worn_through;
    }
    Worn { z_p, b_p, z_d, b_d, on_resin, resin: pairs.resin(), worn_through, broken, lost_pin, lost_disc }
}

/// Wears eight pairs by [`wear`]'s rules, with fewer instructions; none where one of them is bare resin that touches, or loses
/// its build-up. `touching`, `plateau` and `resin` tell which touch, are plateaus, and lie on resin, one bit each; `resin_touches` whether
/// any of their strip does both.
#[inline(always)]
pub(super) fn wear_ordinary<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    cells: Cells<L>,
    [touching, plateau, resin]: [u8; 3],
    resin_touches: bool,
) -> Option<Worn<L>> {
    if !rules.rules.shortcut {
        return None;
    }
    let Cells { z_p, b_p, mut z_d, mut b_d, on_resin } = cells;
    let nothing = L::Mask::of_byte(0);
    // 0 where they do not touch.
    let clearance = (z_p - z_d - rules.displacement).lesser(rules.zero);
    let distinct = BUILD_UP == build_up::DISTINCT;
    let secondary = if distinct { [z_p.below(b_p), b_d.below(z_d)] } else { [nothing; 2] };
    let lost_pin = clearance * rules.pin_loss.plateaus::<BUILD_UP>(secondary);
    let worn = z_p + lost_pin;
    let mut unusual = 0;
    if distinct {
        let ends = worn.at_least(b_p) | lost_pin.at_least(b_p - z_p);
        unusual = (ends & secondary[0]).byte() | !plateau;
    } else if resin_touches {
        unusual = worn.at_least(b_p).byte() & resin;
    }
    if (BUILD_UP == build_up::BRITTLE || distinct)
        && let Some([on_coating, on_secondary]) = rules.rules.strength
    {
        let least = L::select(secondary[1], L::splat(on_secondary), L::splat(on_coating));
        unusual |= clearance.below(least).byte() & resin;
    }
    let mut lost_disc = rules.zero;
    if DISC_WEARS {
        lost_disc = clearance * rules.disc_loss.plateaus::<BUILD_UP>(secondary);
        if distinct {
            unusual |= (secondary[1] & lost_disc.at_least(z_d - b_d)).byte();
        }
        z_d = z_d - lost_disc;
        b_d = b_d.lesser(z_d);
    }
    // Without a closure or a call, which would be compiled without the instruction set.
    if unusual & touching != 0 {
        return None;
    }
    Some(Worn {
        z_p: worn,
        b_p,
        z_d,
        b_d,
        on_resin,
        resin: L::Mask::of_byte(!plateau),
        worn_through: nothing,
        broken: nothing,
        lost_pin,
        lost_disc,
    })
}
