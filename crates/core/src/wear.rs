//! Wear of one cell (model 4.2; paper 2.3, Eqs. 6 and 7).

/// Wears a plateau of the pin by its raw loss (m): the build-up first, then the fibre below by its own wear rate.
///
/// `below` is the raw loss of what the build-up lies on: the fibre, or 0 for resin. Returns the height lost, m.
#[inline]
pub fn wear_pin_plateau(height: &mut f64, substrate: &mut f64, raw: f64, below: f64) -> f64 {
    let build_up = *substrate - *height;
    if build_up > 0.0 && raw >= build_up {
        let deeper = past_build_up(raw, build_up, below);
        *substrate += deeper;
        *height = *substrate;
        return build_up + deeper;
    }
    *height += raw;
    *substrate = substrate.max(*height);
    raw
}

/// Wears resin: it loses the wear height h_m (m) at once. Returns the height lost, m.
#[inline]
pub fn wear_resin(height: &mut f64, substrate: &mut f64, wear_height: f64) -> f64 {
    *height += wear_height;
    *substrate = substrate.max(*height);
    wear_height
}

/// Wears a disc cell by its raw loss (m): the build-up first, then the coating below by its own wear rate.
///
/// `below` is the raw loss of the coating. Returns the height lost, m.
#[inline]
pub fn wear_disc(height: &mut f64, substrate: &mut f64, raw: f64, below: f64) -> f64 {
    let build_up = *height - *substrate;
    if build_up > 0.0 && raw >= build_up {
        let deeper = past_build_up(raw, build_up, below);
        *substrate -= deeper;
        *height = *substrate;
        return build_up + deeper;
    }
    *height -= raw;
    *substrate = substrate.min(*height);
    raw
}

/// What a substrate loses in the rest of a step whose raw loss went through the build-up: (1 − t/Δh) Δh_sub.
#[inline]
fn past_build_up(raw: f64, build_up: f64, below: f64) -> f64 {
    (1.0 - build_up / raw) * below
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thick_build_up_wears_like_any_plateau() {
        let (mut height, mut substrate) = (1.0, 3.0);
        assert_eq!(wear_pin_plateau(&mut height, &mut substrate, 0.5, 9.0), 0.5);
        assert_eq!((height, substrate), (1.5, 3.0));
    }

    #[test]
    fn a_worn_through_build_up_passes_the_rest_of_the_step_on_to_the_fibre() {
        // Half of the step wears off the build-up of 1, the other half takes half of the fibre's raw loss of 0.25.
        let (mut height, mut substrate) = (2.0, 3.0);
        assert_eq!(wear_pin_plateau(&mut height, &mut substrate, 2.0, 0.25), 1.125);
        assert_eq!((height, substrate), (3.125, 3.125));
    }

    #[test]
    fn below_a_worn_through_build_up_resin_stays() {
        let (mut height, mut substrate) = (2.0, 3.0);
        assert_eq!(wear_pin_plateau(&mut height, &mut substrate, 1.0, 0.0), 1.0);
        assert_eq!((height, substrate), (3.0, 3.0));
    }

    #[test]
    fn fibre_takes_its_substrate_along() {
        let (mut height, mut substrate) = (3.0, 3.0);
        assert_eq!(wear_pin_plateau(&mut height, &mut substrate, 0.5, 9.0), 0.5);
        assert_eq!((height, substrate), (3.5, 3.5));
        assert_eq!(wear_resin(&mut height, &mut substrate, 2.0), 2.0);
        assert_eq!((height, substrate), (5.5, 5.5));
    }

    #[test]
    fn the_disc_wears_the_other_way() {
        let (mut height, mut substrate) = (3.0, 2.0);
        assert_eq!(wear_disc(&mut height, &mut substrate, 2.0, 0.5), 1.25);
        assert_eq!((height, substrate), (1.75, 1.75));
        assert_eq!(wear_disc(&mut height, &mut substrate, 0.25, 0.5), 0.25);
        assert_eq!((height, substrate), (1.5, 1.5));
    }
}
