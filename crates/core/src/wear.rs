//! Wear of a cell (model 4.2; paper 2.3, Eqs. 6 and 7).

/// A cell after wear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worn {
    /// New surface height, m.
    pub height: f64,
    /// New substrate height, m.
    pub substrate: f64,
    /// Height lost, m.
    pub loss: f64,
}

/// Wears a cell of the pin by its raw loss (m): the build-up t first, then what lies below.
///
/// A build-up is worn through where the raw loss Δh reaches it; the substrate then loses (1 − t/Δh) Δh_sub =
/// (Δh − t) `below`, with `below` = Δh_sub/Δh, and surface and substrate coincide. Else a surface that goes past its
/// substrate takes it along. `BUILD_UP` is false where no cell can have any.
#[inline(always)]
pub fn pin<const BUILD_UP: bool>(height: f64, substrate: f64, raw: f64, below: f64) -> Worn {
    let mut worn = Worn { height: height + raw, substrate, loss: raw };
    if BUILD_UP {
        let build_up = substrate - height;
        let through = (build_up > 0.0) & (raw >= build_up);
        let deeper = (raw - build_up) * below;
        worn.height = if through { substrate + deeper } else { worn.height };
        worn.loss = if through { build_up + deeper } else { worn.loss };
    }
    worn.substrate = if worn.height > substrate { worn.height } else { substrate };
    worn
}

/// Wears a cell of the disc by its raw loss (m), which lowers it; else as [`pin`].
#[inline(always)]
pub fn disc<const BUILD_UP: bool>(height: f64, substrate: f64, raw: f64, below: f64) -> Worn {
    // The disc is the pin upside down.
    let worn = pin::<BUILD_UP>(-height, -substrate, raw, below);
    Worn { height: -worn.height, substrate: -worn.substrate, loss: worn.loss }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thick_build_up_wears_like_any_plateau() {
        assert_eq!(pin::<true>(1.0, 3.0, 0.5, 9.0), Worn { height: 1.5, substrate: 3.0, loss: 0.5 });
    }

    #[test]
    fn a_worn_through_build_up_passes_the_rest_of_the_step_on_to_the_fibre() {
        // Half of the step wears off the build-up of 1; the other half takes half of the fibre's raw loss of 0.25,
        // an eighth of the build-up's raw loss of 2.
        assert_eq!(pin::<true>(2.0, 3.0, 2.0, 0.125), Worn { height: 3.125, substrate: 3.125, loss: 1.125 });
    }

    #[test]
    fn below_a_worn_through_build_up_resin_stays() {
        assert_eq!(pin::<true>(2.0, 3.0, 2.0, 0.0), Worn { height: 3.0, substrate: 3.0, loss: 1.0 });
        assert_eq!(pin::<true>(2.0, 3.0, 1.0, 0.5), Worn { height: 3.0, substrate: 3.0, loss: 1.0 });
    }

    #[test]
    fn fibre_takes_its_substrate_along() {
        assert_eq!(pin::<true>(3.0, 3.0, 0.5, 9.0), Worn { height: 3.5, substrate: 3.5, loss: 0.5 });
    }

    #[test]
    fn the_disc_wears_the_other_way() {
        assert_eq!(disc::<true>(3.0, 2.0, 2.0, 0.25), Worn { height: 1.75, substrate: 1.75, loss: 1.25 });
        assert_eq!(disc::<true>(1.75, 1.75, 0.25, 0.5), Worn { height: 1.5, substrate: 1.5, loss: 0.25 });
    }
}
