use super::*;
use crate::engine::lanes::{Lanes, Portable};

/// Height and loss of one cell.
fn worn(wear: fn(Portable, Portable, Portable, Portable) -> SurfaceLoss<Portable>, cell: [f64; 4]) -> (f64, f64) {
    let [height, substrate, raw, below] = cell.map(Portable::splat);
    let worn = wear(height, substrate, raw, below);
    (worn.height.chunk().0[5], worn.lost.chunk().0[5])
}

#[test]
fn a_thick_build_up_wears_like_any_plateau() {
    assert_eq!(worn(pin, [1.0, 3.0, 0.5, 9.0]), (1.5, 0.5));
}

#[test]
fn a_worn_through_build_up_passes_the_rest_of_the_step_on_to_the_fibre() {
    // Half of the step wears off the build-up of 1; the other half takes half of the fibre's raw loss of 0.25,
    // an eighth of the build-up's raw loss of 2.
    assert_eq!(worn(pin, [2.0, 3.0, 2.0, 0.125]), (3.125, 1.125));
}

#[test]
fn below_a_worn_through_build_up_resin_stays() {
    assert_eq!(worn(pin, [2.0, 3.0, 2.0, 0.0]), (3.0, 1.0));
    assert_eq!(worn(pin, [2.0, 3.0, 1.0, 0.5]), (3.0, 1.0));
}

#[test]
fn a_film_far_thinner_than_the_raw_loss_keeps_its_digits() {
    // 2^-80 of a raw loss of 1.
    let film = 2.0_f64.powi(-80);
    assert_eq!(worn(pin, [-film, 0.0, 1.0, 0.0]), (0.0, film));
    assert_eq!(worn(disc, [film, 0.0, 1.0, 0.0]), (0.0, film));
}

#[test]
fn bare_fibre_loses_all() {
    assert_eq!(worn(pin, [3.0, 3.0, 0.5, 9.0]), (3.5, 0.5));
}

#[test]
fn a_disc_at_height_0_that_does_not_wear_keeps_its_bits() {
    let (height, _) = worn(disc, [0.0, 0.0, 0.0, 0.5]);
    assert_eq!(height.to_bits(), 0.0_f64.to_bits());
}

#[test]
fn the_disc_wears_the_other_way() {
    assert_eq!(worn(disc, [3.0, 2.0, 2.0, 0.25]), (1.75, 1.25));
    assert_eq!(worn(disc, [1.75, 1.75, 0.25, 0.5]), (1.5, 0.25));
}
