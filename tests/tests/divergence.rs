//! Two simulations that part are found to, and where: what the tests of determinism rely on.

use std::cell::Cell;

use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::{Base, InitialSurfaces};

use plateau_core::simulation::Simulation;
use plateau_tests::divergence::{Difference, Divergence, first_divergence};
use plateau_tests::scenes::{random_surfaces, wear_only};

const STEPS: u64 = 350;

/// A small scene with plateaus.
fn scene() -> (Parameters, InitialSurfaces) {
    let mut parameters = wear_only(11, 40, 9);
    parameters.plateaus.formation = true;
    parameters.plateaus.captured_fraction = 0.5;
    let surfaces = random_surfaces(&parameters.mesh, 1);
    (parameters, surfaces)
}

fn start((parameters, surfaces): (Parameters, InitialSurfaces)) -> Simulation {
    Simulation::new(parameters, surfaces).expect("a scene")
}

fn names(divergence: &Divergence) -> Vec<&str> {
    let name = |difference: &Difference| match difference {
        Difference::Quantity { name, .. } => *name,
        Difference::Cells { map, .. } => *map,
        Difference::End(_) => "end",
    };
    divergence.differences.iter().map(name).collect()
}

#[test]
fn one_bit_of_one_height_is_found() {
    let other = || {
        let (parameters, mut surfaces) = scene();
        let height = &mut surfaces.disc_height[11 * 23 + 4];
        *height = f64::from_bits(height.to_bits() + 1);
        start((parameters, surfaces))
    };
    let mut divergence = first_divergence(STEPS, || start(scene()), other).expect("a difference");
    let height = scene().1.disc_height[11 * 23 + 4];
    let values = [height, f64::from_bits(height.to_bits() + 1)];
    let cells = |map| Difference::Cells { map, count: [1, 440], first: (4, 23), values };
    let expected =
        Divergence { step: 0, repeatable: true, differences: vec![cells("disc_height"), cells("disc_substrate")] };
    // After the maps there may be the roughness of that disc, as far as its last bits tell.
    let is_roughness = |difference: &Difference| match difference {
        Difference::Quantity { name, .. } => name.starts_with("disc_s"),
        _ => false,
    };
    assert!(divergence.differences.iter().skip(2).all(is_roughness), "{divergence}");
    divergence.differences.truncate(2);
    assert_eq!(divergence, expected);
    let text = divergence.to_string();
    assert!(
        text.contains("after step 0:\n  disc_height differs in 1 of 440 cells, first in row 4 of column 23: "),
        "{text}"
    );
}

#[test]
fn the_first_step_is_found_between_two_comparisons() {
    // A column of fibre and one of resin, 3 µm behind it, over a flat disc: the fibre's overlap is p/k = 0.9 µm, and
    // it wears 3 nm a step. Only a peak of 5 µm in disc column 7 reaches the resin, which loses its wear height then.
    // Step n faces disc column 1 − (n − 1) mod 40 there: n = 35.
    let make = |wear_height: f64| {
        move || {
            let mut parameters = wear_only(3, 40, 2);
            parameters.materials.wear_height = wear_height;
            let mut disc_height = vec![0.0; parameters.mesh.disc_cells()];
            disc_height[3 * 7 + 2] = 5e-6;
            let pin_height = [[0.0; 3], [3e-6; 3]].concat();
            let pin_base = [[Base::Primary; 3], [Base::Resin; 3]].concat();
            start((parameters, InitialSurfaces { disc_height, pin_height, pin_base }))
        }
    };
    let divergence = first_divergence(STEPS, make(5e-6), make(6e-6)).expect("a difference");
    assert_eq!((divergence.step, divergence.repeatable), (35, true));
    assert!(divergence.differences.contains(&Difference::Cells {
        map: "pin_height",
        count: [1, 6],
        first: (2, 1),
        values: [3e-6 + 5e-6, 3e-6 + 6e-6],
    }));
}

#[test]
fn another_captured_fraction_shows_when_something_was_worn() {
    let other = || {
        let (mut parameters, surfaces) = scene();
        parameters.plateaus.captured_fraction = 0.25;
        start((parameters, surfaces))
    };
    let divergence = first_divergence(STEPS, || start(scene()), other).expect("a difference");
    // What is worn in step 1 is shared out in step 2 (model 4P).
    assert_eq!((divergence.step, &names(&divergence)[..2]), (1, &["pool", "emitted"][..]));
    assert!(!divergence.to_string().contains("height"), "{divergence}");
}

#[test]
fn a_difference_that_does_not_come_again_is_told_as_such() {
    let made = Cell::new(0);
    let other = || {
        let (mut parameters, surfaces) = scene();
        parameters.plateaus.captured_fraction = if made.replace(made.get() + 1) == 0 { 0.25 } else { 0.5 };
        start((parameters, surfaces))
    };
    let divergence = first_divergence(STEPS, || start(scene()), other).expect("a difference");
    assert_eq!((divergence.step, divergence.repeatable), (100, false));
    assert!(divergence.to_string().contains("timing decides"), "{divergence}");
}

#[test]
fn an_end_that_the_reference_does_not_have_is_told() {
    let other = || {
        let (mut parameters, surfaces) = scene();
        parameters.normal_force = f64::INFINITY;
        start((parameters, surfaces))
    };
    let divergence = first_divergence(STEPS, || start(scene()), other).expect("a difference");
    assert_eq!((divergence.step, names(&divergence)), (1, vec!["end"]));
    assert!(divergence.to_string().ends_with(" instead of no error"), "{divergence}");
}
