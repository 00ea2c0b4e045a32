//! Roughness of disc and pin with every sample.

use plateau_core::model::mesh::{Mesh, Outline};
use plateau_core::model::parameters::Parameters;
use plateau_core::observe::extra::ROUGHNESS;

/// Sa, Sq, Ssk and Sku of the disc and of the pin.
fn roughness(mesh: &Mesh, disc: &[f64], pin: &[f64]) -> [[f64; 4]; 2] {
    let parameters = Parameters { mesh: mesh.clone(), ..Parameters::paper() };
    let found = (ROUGHNESS.request.unwrap().measure)(&parameters, &[disc.to_vec(), pin.to_vec()]);
    [0, 4].map(|first| found[first..first + 4].try_into().unwrap())
}

/// Those of heights of the disc, or of the pin, whose peaks are negative.
fn height_parameters(mesh: &Mesh, heights: &[f64]) -> [f64; 4] {
    if heights.len() == mesh.disc_cells() {
        return roughness(mesh, heights, &vec![0.0; mesh.pin_cells()])[0];
    }
    let [sa, sq, ssk, sku] = roughness(mesh, &vec![0.0; mesh.disc_cells()], heights)[1];
    [sa, sq, -ssk, sku]
}

#[test]
fn cells_count_with_their_areas() {
    // Two rows with areas as 3 : 5 (radii 1.5 and 2.5), heights 0 and 1: a Bernoulli distribution with p = 5/8, of
    // which mean absolute deviation 2pq, variance pq, skewness (q − p)/√(pq), kurtosis (1 − 3pq)/(pq).
    let mesh = Mesh::new(2, 6, 3, 1.0, 3.0).unwrap();
    let heights: Vec<f64> = (0..12).map(|cell| f64::from(cell % 2)).collect();
    let (p, q) = (0.625_f64, 0.375_f64);
    let expected = [2.0 * p * q, (p * q).sqrt(), (q - p) / (p * q).sqrt(), (1.0 - 3.0 * p * q) / (p * q)];
    for (found, expected) in height_parameters(&mesh, &heights).into_iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-14, "{found}, {expected}");
    }
}

#[test]
fn cells_beyond_the_outline_do_not_count() {
    // One row, so that all areas are equal, of which the middle two cells are there: heights 1 and 3.
    let mesh = Mesh::new(1, 1000, 4, 20.0, 20.2).unwrap();
    let mesh = mesh.with_outline(Outline::Disc { radius: 0.1 }).unwrap();
    let [sa, sq, ssk, sku] = height_parameters(&mesh, &[f64::NAN, 1.0, 3.0, f64::NAN]);
    assert_eq!(mesh.present_cells(), 2);
    assert!([sa, sq, sku].iter().all(|one| (one - 1.0).abs() < 1e-12) && ssk.abs() < 1e-12, "{sa} {sq} {ssk} {sku}");
    assert!(height_parameters(&mesh, &[f64::NAN, 2.0, 2.0, f64::NAN])[2].is_nan());
}

#[test]
fn a_large_offset_takes_no_digits_but_those_of_the_heights() {
    let mesh = Mesh::new(4, 10, 3, 1.0, 1.5).unwrap();
    let heights: Vec<f64> = (0..40).map(|cell| f64::from(cell * cell % 7)).collect();
    let shifted: Vec<f64> = heights.iter().map(|height| height + 1e6).collect();
    let ([_, near_sq, near_ssk, _], [_, far_sq, far_ssk, _]) =
        (height_parameters(&mesh, &heights), height_parameters(&mesh, &shifted));
    assert!((near_sq / far_sq - 1.0).abs() < 1e-14);
    assert!((near_ssk / far_ssk - 1.0).abs() < 1e-13);
}

#[test]
fn a_flat_body_has_no_skewness() {
    let mesh = Mesh::new(3, 7, 3, 1.0, 1.5).unwrap();
    let [_, sq, ssk, sku] = height_parameters(&mesh, &[0.1; 21]);
    assert!(sq < 1e-16 && ssk.is_nan() && sku.is_nan());
}
