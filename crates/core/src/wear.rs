//! Wear of cells (model 4.2; paper 2.3, Eqs. 6 and 7).

use crate::kernel::Lanes;

/// Some cells after wear.
#[derive(Debug, Clone, Copy)]
pub struct Worn {
    /// New surface height, m.
    pub height: Lanes,
    /// New substrate height, m.
    pub substrate: Lanes,
    /// Height lost, m.
    pub loss: Lanes,
}

/// Wears cells of the pin by their raw loss (m): the build-up t first, then what lies below.
///
/// A build-up is worn through where the raw loss Δh reaches it; the substrate then loses (1 − t/Δh) Δh_sub =
/// (Δh − t) `below`, with `below` = Δh_sub/Δh, and surface and substrate coincide. Else the surface takes a substrate
/// that it reaches along. `BUILD_UP` is false where no cell can have any.
#[inline(always)]
pub fn pin<const BUILD_UP: bool>(height: Lanes, substrate: Lanes, raw: Lanes, below: Lanes) -> Worn {
    let mut worn = Worn { height: height + raw, substrate, loss: raw };
    if BUILD_UP {
        let build_up = substrate - height;
        let through = build_up.exceeds(Lanes::splat(0.0)).and_not(build_up.exceeds(raw));
        let deeper = (raw - build_up) * below;
        worn.height = through.select(substrate + deeper, worn.height);
        worn.loss = through.select(build_up + deeper, worn.loss);
    }
    worn.substrate = substrate.max(worn.height);
    worn
}

/// Wears cells of the disc by their raw loss (m), which lowers them; else as [`pin`].
#[inline(always)]
pub fn disc<const BUILD_UP: bool>(height: Lanes, substrate: Lanes, raw: Lanes, below: Lanes) -> Worn {
    // The disc is the pin upside down.
    let worn = pin::<BUILD_UP>(-height, -substrate, raw, below);
    Worn { height: -worn.height, substrate: -worn.substrate, loss: worn.loss }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worn(height: f64, substrate: f64, raw: f64, below: f64) -> (f64, f64, f64) {
        let [height, substrate, raw, below] = [height, substrate, raw, below].map(Lanes::splat);
        let worn = pin::<true>(height, substrate, raw, below);
        (worn.height.first(), worn.substrate.first(), worn.loss.first())
    }

    #[test]
    fn a_thick_build_up_wears_like_any_plateau() {
        assert_eq!(worn(1.0, 3.0, 0.5, 9.0), (1.5, 3.0, 0.5));
    }

    #[test]
    fn a_worn_through_build_up_passes_the_rest_of_the_step_on_to_the_fibre() {
        // Half of the step wears off the build-up of 1; the other half takes half of the fibre's raw loss of 0.25,
        // an eighth of the build-up's raw loss of 2.
        assert_eq!(worn(2.0, 3.0, 2.0, 0.125), (3.125, 3.125, 1.125));
    }

    #[test]
    fn below_a_worn_through_build_up_resin_stays() {
        assert_eq!(worn(2.0, 3.0, 2.0, 0.0), (3.0, 3.0, 1.0));
        assert_eq!(worn(2.0, 3.0, 1.0, 0.5), (3.0, 3.0, 1.0));
    }

    #[test]
    fn fibre_takes_its_substrate_along() {
        assert_eq!(worn(3.0, 3.0, 0.5, 9.0), (3.5, 3.5, 0.5));
    }

    #[test]
    fn the_disc_wears_the_other_way() {
        let [height, substrate, raw, below] = [3.0, 2.0, 2.0, 0.25].map(Lanes::splat);
        let worn = disc::<true>(height, substrate, raw, below);
        assert_eq!((worn.height.first(), worn.substrate.first(), worn.loss.first()), (1.75, 1.75, 1.25));
    }
}
