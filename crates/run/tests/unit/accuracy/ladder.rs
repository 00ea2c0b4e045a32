use plateau_core::model::state;

use super::*;

fn base(sets: &[&str]) -> Base {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/scenes/quick.toml"));
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scene = scene::load(&path, &sets).unwrap();
    Base { path, sets, scene }
}

#[test]
fn a_scene_has_the_accelerations_that_its_revolutions_allow() {
    assert_eq!(time_accelerations(20.0, 850.0), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
    assert_eq!(time_accelerations(7.5, 16.0), [1.0, 2.0, 7.5]);
    assert_eq!(time_accelerations(1.0, 0.1), [1.0]);
}

#[test]
fn steps_are_coarser_than_the_reference() {
    let accelerations = [1.0, 5.0, 20.0, 50.0];
    let values = |ladder, own, reference| -> Vec<f64> {
        steps(&[ladder], &accelerations, own, reference, false).into_iter().map(|step| step.value).collect()
    };
    assert_eq!(values(Ladder::TimeAcceleration, None, 1.0), [5.0, 20.0, 50.0]);
    assert_eq!(values(Ladder::TimeAcceleration, None, 7.0), [20.0, 50.0]);
    assert!(values(Ladder::TimeAcceleration, None, 50.0).is_empty());
    assert_eq!(values(Ladder::Tolerance, Some(0.03), 1.0), [0.002, 0.005, 0.01, 0.02, 0.03, 0.05]);
    assert!(values(Ladder::Tolerance, Some(0.03), 2.0).is_empty());
    assert_eq!(values(Ladder::Perturbation, None, 7.0), PERTURBATIONS);
    assert!(values(Ladder::Mesh, None, 1.0).is_empty());
    let pairs = |ladder| -> Vec<(f64, Cells)> {
        let steps = steps(&[ladder], &accelerations, None, 5.0, true);
        steps.into_iter().map(|step| (step.value, step.cells)).collect()
    };
    assert_eq!(pairs(Ladder::TimeAcceleration), [5.0, 20.0, 50.0].map(|m| (m, Cells::Own)));
    let halved = [20.0, 50.0].map(|m| (m, Cells::Halved));
    assert_eq!(pairs(Ladder::Mesh), [&halved[..], &[5.0, 20.0, 50.0].map(|m| (m, Cells::Doubled))].concat());
}

#[test]
fn a_rung_is_the_scene_with_some_keys_set() {
    let base = base(&["disc.prepare.scale=0.5", "numerics.time_acceleration={ tolerance = 0.1, max = 30 }"]);
    let rung =
        |ladder, value, cells, reference| Rung::new(&base, LadderPoint { ladder, value, cells }, reference).unwrap();
    let fixed = rung(Ladder::TimeAcceleration, 7.5, Cells::Own, 1.0);
    assert_eq!(fixed.setting(), "time_acceleration = 7.5");
    assert!(fixed.scene.adaptive.is_none() && fixed.scene.parameters.time_acceleration == 7.5);
    let chosen = rung(Ladder::Tolerance, 0.02, Cells::Own, 1.0);
    assert_eq!(chosen.setting(), "time_acceleration = { tolerance = 0.02, max = 30 }");
    assert_eq!(chosen.scene.adaptive.unwrap().tolerance, 0.02);
    let perturbed = rung(Ladder::Perturbation, 1e-4, Cells::Own, 2.0);
    assert_eq!(perturbed.setting(), "time_acceleration = 2, disc.prepare.scale = 0.50005");
    assert_eq!(perturbed.scene.disc_surface.preparation.scale, 0.50005);
    let mesh = rung(Ladder::Mesh, 20.0, Cells::Doubled, 1.0);
    assert_eq!(mesh.setting(), "disc_columns = 345, pin_columns = 20, time_acceleration = 20");
    assert_eq!((mesh.value, mesh.scene.parameters.mesh.pin_columns()), (345.0, 20));
}

#[test]
fn runs_with_a_number_of_steps_are_as_long_as_the_scene() {
    let base = base(&["operation.steps=690"]);
    let step = |ladder, value| LadderPoint { ladder, value, cells: Cells::Own };
    let rung = Rung::new(&base, step(Ladder::TimeAcceleration, 10.0), 1.0).unwrap();
    // The scene has 20.
    assert_eq!((rung.scene.duration, rung.scene.steps), (base.scene.duration, 1380));
    let refused = Rung::new(&base, step(Ladder::Tolerance, 0.01), 1.0).unwrap_err();
    assert!(refused.to_string().contains("give operation.duration"), "{refused}");
    let half = rung.clone().lasting(0.5 * rung.scene.duration);
    assert!(half.scene.steps.abs_diff(rung.scene.steps / 2) <= 1, "{}", half.scene.steps);
}

#[test]
fn every_second_and_fourth_column_is_sampled() {
    let own = Mesh::new(2, 6, 3, 0.010, 0.011).unwrap();
    let columns = [Cells::Halved, Cells::Own, Cells::Doubled].map(|cells| cells.columns(&own));
    assert_eq!(columns, [Some([12, 6]), Some([6, 3]), Some([3, 2])]);
    assert_eq!(Cells::Doubled.columns(&Mesh::new(2, 7, 3, 0.010, 0.011).unwrap()), None);
    let numbers = |columns: usize| (0..2 * columns).map(|number| number as f64).collect();
    let finest =
        InitialSurfaces { disc_height: numbers(12), pin_height: numbers(6), pin_base: vec![state::Base::Primary; 12] };
    let doubled = Cells::Doubled.sample(&finest, 2);
    assert_eq!(doubled.disc_height, [0.0, 1.0, 8.0, 9.0, 16.0, 17.0]);
    assert_eq!((doubled.pin_height.as_slice(), doubled.pin_base.len()), ([0.0, 1.0, 8.0, 9.0].as_slice(), 4));
}
