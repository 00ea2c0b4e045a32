//! The chain from picture to fibre map.

use super::*;
use crate::surface::fibre_fraction;

/// Square cells of 100 µm at the mean radius, pin of 3 mm by 2 mm.
fn mesh() -> Mesh {
    let mean_radius = 100e-6 * 1400.0 / std::f64::consts::TAU;
    Mesh::new(20, 1400, 30, mean_radius - 1e-3, mean_radius + 1e-3).unwrap()
}

fn settings() -> Micrograph {
    Micrograph {
        pixel: 20e-6,
        quarters: 0,
        smooth: None,
        threshold: Threshold::Otsu,
        fibres: Fibres::Bright,
        despeckle: None,
    }
}

/// Bright to the right of x = 0, a bright bar along the top, dark elsewhere.
fn picture() -> Picture<f32> {
    let (width, height) = (160, 120);
    let bright = |x: usize, y: usize| x >= 80 || y < 30;
    let pixels = (0..width * height).map(|i| if bright(i % width, i / width) { 0.8 } else { 0.2 }).collect();
    Picture { width, height, pixels }
}

/// Base of the cell whose centre has this place in the plane.
fn at(map: &FibreMap, x: f64, y: f64) -> Base {
    map.base[PinPlane::new(&mesh()).cell(x, y).unwrap()]
}

#[test]
fn the_picture_lies_with_its_top_outward_and_its_right_in_sliding_direction() {
    let map = settings().fibre_map(picture(), &mesh()).unwrap();
    // The bar covers y > 30 · 20 µm.
    for (x, y, base) in [
        (0.5e-3, -0.5e-3, Base::Primary),
        (-0.5e-3, -0.5e-3, Base::Resin),
        (-0.5e-3, 0.8e-3, Base::Primary),
        (-0.5e-3, 0.4e-3, Base::Resin),
    ] {
        assert_eq!(at(&map, x, y), base, "{x} {y}");
    }
    // A quarter turn counterclockwise puts what was right on top.
    let turned = Micrograph { quarters: 1, pixel: 30e-6, ..settings() }.fibre_map(picture(), &mesh()).unwrap();
    assert_eq!((at(&turned, 0.5e-3, 0.5e-3), at(&turned, 0.5e-3, -0.5e-3)), (Base::Primary, Base::Resin));
    assert_eq!(turned.report[0], "turned counterclockwise by 90 deg");
    let dark = Micrograph { fibres: Fibres::Dark, ..settings() }.fibre_map(picture(), &mesh()).unwrap();
    assert!(dark.base.iter().zip(&map.base).all(|(a, b)| a != b));
}

#[test]
fn the_fractions_are_told() {
    let map = settings().fibre_map(picture(), &mesh()).unwrap();
    // Half of the picture, and a quarter of the other half.
    assert_eq!(map.report[1], "fibre fraction of the picture 0.6250");
    // On the pin the bar covers the outer 0.4 mm of 2 mm: 0.5 + 0.5 · 0.2, but for the curvature of the rows, at most
    // 1.5²/(2 · 22.3) mm = 50 µm of 2 mm, and for the larger share of the outer rows.
    let found: f64 = map.report[2].rsplit(' ').next().unwrap().parse().unwrap();
    assert!((found - 0.6).abs() < 0.0125, "{found}");
    assert!((fibre_fraction(&map.base, &mesh()) - found).abs() < 0.03);
}

#[test]
fn specks_go_and_a_smoothed_picture_has_fewer() {
    let mut speckled = picture();
    for (x, y, level) in [(20, 60, 0.9), (21, 60, 0.9), (100, 60, 0.1), (40, 80, 0.9)] {
        speckled.pixels[y * 160 + x] = level;
    }
    let clean = settings().fibre_map(picture(), &mesh()).unwrap();
    let kept = settings().fibre_map(speckled.clone(), &mesh()).unwrap();
    assert_ne!(kept.fibre, clean.fibre);
    // 3 pixels of 20 µm squared.
    let despeckled = Micrograph { despeckle: Some(1.2e-9), ..settings() }.fibre_map(speckled.clone(), &mesh()).unwrap();
    assert_eq!(despeckled.fibre, clean.fibre);
    assert_eq!(
        despeckled.report[2],
        "2 specks of fibre and 1 holes of fewer than 3 pixels removed, fibre fraction of the picture then 0.6250"
    );
    let some = Micrograph { despeckle: Some(0.8e-9), ..settings() }.fibre_map(speckled.clone(), &mesh()).unwrap();
    assert_ne!(some.fibre, clean.fibre, "two pixels are not fewer than two");
    let smoothed = Micrograph { smooth: Some(40e-6), ..settings() }.fibre_map(speckled, &mesh()).unwrap();
    assert_eq!(smoothed.base, clean.base);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let error = |settings: Micrograph| settings.fibre_map(picture(), &mesh()).unwrap_err().to_string();
    assert_eq!(
        error(Micrograph { smooth: Some(1e-3), ..settings() }),
        "smooth = 1 mm is 50.0 pixels, expected at most a quarter of the picture's shorter side of 120 pixels"
    );
    assert_eq!(
        error(Micrograph { threshold: Threshold::Level(1.5), ..settings() }),
        "threshold is 1.5, expected a grey level from 0 to 1"
    );
    let small = error(Micrograph { pixel: 10e-6, ..settings() });
    assert!(small.starts_with("the picture is 1.6 mm by 1.2 mm, the pin 3."), "{small}");
    for pixel in [0.0, f64::NAN, f64::INFINITY, -1.0] {
        assert!(error(Micrograph { pixel, ..settings() }).starts_with("pixel is "));
    }
    for area in [f64::NAN, -1.0] {
        assert!(error(Micrograph { despeckle: Some(area), ..settings() }).starts_with("despeckle is "));
    }
    let grey = Picture { width: 160, height: 120, pixels: vec![0.5; 160 * 120] };
    assert_eq!(settings().fibre_map(grey.clone(), &mesh()), Err(MicrographError::Uniform));
    let all = Micrograph { threshold: Threshold::Level(0.4), ..settings() }.fibre_map(grey, &mesh()).unwrap();
    assert!(all.base.iter().all(|base| *base == Base::Primary));
    for (width, height, level) in
        [(160, 119, 0.5), (usize::MAX, 2, 0.5), (0, 0, 0.5), (160, 120, f32::NAN), (160, 120, 1.1)]
    {
        let grey = Picture { width, height, pixels: vec![level; 160 * 120] };
        assert!(matches!(settings().fibre_map(grey, &mesh()), Err(MicrographError::Picture { .. })));
    }
}
