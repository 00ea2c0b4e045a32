use super::*;
use crate::engine::lanes::{Lanes, Portable};

type Wear = fn(Portable, Portable, Portable, Portable) -> SurfaceLoss<Portable>;

/// Height and loss of one cell.
fn worn(wear: Wear, cell: [f64; 4]) -> [f64; 2] {
    let [height, substrate, raw, below] = cell.map(Portable::splat);
    let worn = wear(height, substrate, raw, below);
    [worn.height, worn.lost].map(|lanes| lanes.chunk().0[5])
}

#[test]
fn cells_wear_as_by_hand() {
    let film = 2.0_f64.powi(-80);
    // Height, substrate, raw loss and that below a build-up; height and loss after the step.
    let cases: [(&str, Wear, [f64; 4], [f64; 2]); 9] = [
        ("a thick build-up wears like any plateau", pin, [1.0, 3.0, 0.5, 9.0], [1.5, 0.5]),
        // Half of the step wears off the build-up of 1; the other half takes half of the fibre's raw loss of 0.25, an
        // eighth of the build-up's raw loss of 2.
        ("the rest of the step goes on to the fibre", pin, [2.0, 3.0, 2.0, 0.125], [3.125, 1.125]),
        ("below a worn-through build-up resin stays", pin, [2.0, 3.0, 2.0, 0.0], [3.0, 1.0]),
        ("what is just worn through has no rest", pin, [2.0, 3.0, 1.0, 0.5], [3.0, 1.0]),
        // 2^-80 of a raw loss of 1.
        ("a film far thinner than the raw loss", pin, [-film, 0.0, 1.0, 0.0], [0.0, film]),
        ("such a film on the disc", disc, [film, 0.0, 1.0, 0.0], [0.0, film]),
        ("bare fibre loses all", pin, [3.0, 3.0, 0.5, 9.0], [3.5, 0.5]),
        ("the disc wears the other way", disc, [3.0, 2.0, 2.0, 0.25], [1.75, 1.25]),
        ("a bare disc", disc, [1.75, 1.75, 0.25, 0.5], [1.5, 0.25]),
    ];
    for (what, wear, cell, expected) in cases {
        assert_eq!(worn(wear, cell), expected, "{what}");
    }
    // A disc at height 0 that does not wear keeps its bits.
    assert_eq!(worn(disc, [0.0, 0.0, 0.0, 0.5])[0].to_bits(), 0.0_f64.to_bits());
}
