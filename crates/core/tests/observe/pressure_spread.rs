//! The spread of the pressure over the cells in contact.

use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::Parameters;
use plateau_core::observe::extra::PRESSURE_SPREAD;

/// Coefficient of variation and Gini coefficient.
fn spread(mesh: &Mesh, pressures: &[f64]) -> [f64; 2] {
    let parameters = Parameters { mesh: mesh.clone(), ..Parameters::paper() };
    let found = (PRESSURE_SPREAD.request.unwrap().measure)(&parameters, &[pressures.to_vec()]);
    found.try_into().unwrap()
}

/// One row, so that all cells have the same area.
fn of_one_row(pressures: &[f64]) -> [f64; 2] {
    let mesh = Mesh::new(1, 100, pressures.len(), 20e-3, 24e-3).unwrap();
    spread(&mesh, pressures)
}

#[test]
fn equal_pressures_have_no_spread() {
    let equal = of_one_row(&[3.0, 0.0, 3.0, 3.0]);
    assert!(equal.iter().all(|spread| spread.abs() < 1e-15), "{equal:?}");
    assert!(of_one_row(&[0.0, 0.0])[1].is_nan());
}

#[test]
fn spreads_of_closed_form() {
    // 1 to n: variance (n² − 1)/12, mean (n + 1)/2, Gini (n² − 1)/(3 n (n + 1)) = (n − 1)/(3 n).
    let ramp: Vec<f64> = (1..=50).rev().map(f64::from).collect();
    let [variation, gini] = of_one_row(&ramp);
    assert!((variation - (2499.0_f64 / 12.0).sqrt() / 25.5).abs() < 1e-14);
    assert!((gini - 49.0 / 150.0).abs() < 1e-14);
}

#[test]
fn cells_count_with_their_area() {
    // Two rows of areas in the ratio 21 : 23, pressures 1 and 2. By hand: mean 67/44, variance 21·23/44², and for two
    // parts the Gini coefficient is the smaller part of the area less its part of the force, 21/44 − 21/67.
    let mesh = Mesh::new(2, 100, 1, 20e-3, 24e-3).unwrap();
    let [variation, gini] = spread(&mesh, &[1.0, 2.0]);
    assert!((variation - (21.0_f64 * 23.0).sqrt() / 67.0).abs() < 1e-14);
    assert!((gini - (21.0 / 44.0 - 21.0 / 67.0)).abs() < 1e-14);
}
