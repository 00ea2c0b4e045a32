use super::*;
use crate::model::mesh::Mesh;
use crate::model::parameters::PlateauRules;

fn parameters(normal_force: f64) -> Parameters {
    let mesh = Mesh::new(7, 60, 11, 20e-3, 21e-3).unwrap();
    Parameters { mesh, normal_force, plateaus: PlateauRules::pool(0.5), ..Parameters::paper() }
}

#[test]
fn flat_bodies_share_the_load_over_the_whole_pin() {
    // Closed form: p = F_N/ΣA, u = p h/E*.
    let parameters = parameters(200.0);
    let mesh = &parameters.mesh;
    let surfaces = InitialSurfaces {
        disc_height: vec![1e-6; mesh.disc_cells()],
        pin_height: vec![3e-6; mesh.pin_cells()],
        pin_base: vec![Base::Primary; mesh.pin_cells()],
    };
    let first = FirstContact::of(&parameters, &surfaces).unwrap();
    let pressure = 200.0 / mesh.pin_area();
    let overlap = pressure * 50e-6 * (1.0 - 0.27 * 0.27) * (1e-9 + 1e-11);
    assert!((first.mean_pressure / pressure - 1.0).abs() < 1e-12);
    assert!((first.largest_overlap / overlap - 1.0).abs() < 1e-9, "{first:?}");
    assert!((first.displacement - 2e-6 - overlap).abs() < 1e-15);
}

#[test]
fn what_carries_nothing_has_no_contact() {
    let mut parameters = parameters(1.0);
    parameters.materials.pin_resin.youngs_modulus = 0.0;
    let mesh = &parameters.mesh;
    let surfaces = InitialSurfaces {
        disc_height: vec![0.0; mesh.disc_cells()],
        pin_height: vec![0.0; mesh.pin_cells()],
        pin_base: vec![Base::Resin; mesh.pin_cells()],
    };
    assert_eq!(FirstContact::of(&parameters, &surfaces), None);
}
