//! The preparation chain against hand computation and closed forms.

mod filling;
mod filtering;
mod implausible;
mod levelling;
mod reporting;
mod resampling;
mod slope_outliers;
mod straightening;
mod tiling;
mod unrolling;

use std::f64::consts::TAU;

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{Body, Fill, Length, Level, Patch, Preparation, PreparationError, RawHeights, level};

/// Cells of 1 mm by 1 mm at the mean radius.
pub(crate) fn ring(columns: usize, rows: usize, pin_columns: usize) -> Mesh {
    let mean_radius = 1e-3 * columns as f64 / TAU;
    let half = 0.5e-3 * rows as f64;
    Mesh::new(rows, columns, pin_columns, mean_radius - half, mean_radius + half).unwrap()
}

fn patch(columns: usize, rows: usize, pitch: f64, height: impl Fn(usize, usize) -> f64) -> Patch {
    let heights = (0..columns * rows).map(|index| height(index / rows, index % rows)).collect();
    Patch { columns, rows, column_pitch: pitch, row_pitch: pitch, heights }
}

/// Rough enough to tell every pixel from every other.
fn rough(column: usize, row: usize) -> f64 {
    ((column * 7919 + row * 104_729) % 1009) as f64 * 1e-9
}

fn apply(preparation: Preparation, raw: RawHeights, body: Body, mesh: &Mesh) -> Result<Vec<f64>, PreparationError> {
    preparation.apply(raw, false, body, mesh).map(|prepared| prepared.heights)
}

fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() <= tolerance, "{index}: {found}, expected {expected}");
    }
}

#[test]
fn heights_on_the_mesh_come_through_bit_for_bit() {
    let mesh = ring(12, 3, 4);
    for (body, cells) in [(Body::Disc, 36), (Body::Pin, 12)] {
        let heights: Vec<f64> = (0..cells).map(|i| (f64::from(i) * 0.7).sin() * 1e-6 - 0.0).collect();
        for repeat in [false, true] {
            let preparation = Preparation { repeat, ..Preparation::default() };
            let prepared = preparation.apply(RawHeights::OnMesh(heights.clone()), false, body, &mesh).unwrap();
            let bits = |heights: &[f64]| heights.iter().map(|height| height.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&prepared.heights), bits(&heights));
            assert!(prepared.report.is_empty());
        }
    }
}

#[test]
fn mean_cutoff_and_scale_follow_the_hand_computation() {
    // Mean of 0, 1, 2, 9 is 3: cut at 3 + 2 = 5, then taken half.
    let mesh = ring(40, 2, 2);
    let heights = vec![0.0, 1.0, 2.0, 9.0];
    let preparation = Preparation { cutoff: Some(2.0), scale: 0.5, ..Preparation::default() };
    let prepared = preparation.apply(RawHeights::OnMesh(heights.clone()), false, Body::Pin, &mesh).unwrap();
    assert_eq!(prepared.heights, [0.0, 0.5, 1.0, 2.5]);
    assert!(prepared.report[0].contains("25.000 % of points"), "{:?}", prepared.report);
    // Levelled first, the same cut lies at 2.
    let preparation = Preparation { level: Level::Mean, ..preparation };
    let levelled = apply(preparation, RawHeights::OnMesh(heights), Body::Pin, &mesh).unwrap();
    assert_eq!(levelled, [-1.5, -1.0, -0.5, 1.0]);
}

#[test]
fn a_field_with_a_pixel_is_taken_as_a_patch() {
    let mesh = ring(40, 4, 8);
    let heights = patch(8, 4, 1e-3, rough).heights;
    let preparation = Preparation { pixel: Some(2e-3), ..Preparation::default() };
    let found = apply(preparation, RawHeights::OnMesh(heights.clone()), Body::Pin, &mesh).unwrap();
    let twice = Patch { columns: 8, rows: 4, column_pitch: 2e-3, row_pitch: 2e-3, heights };
    assert_eq!(found, apply(Preparation::default(), RawHeights::Patch(twice), Body::Pin, &mesh).unwrap());
}

#[test]
fn missing_points_are_an_error_that_says_how_many() {
    let mesh = ring(40, 2, 4);
    let mut heights = vec![1.0, 2.0, 3.0, 6.0, 1.0, 2.0, 3.0, 6.0];
    heights[0] = f64::NAN;
    heights[4] = f64::NAN;
    let raw = RawHeights::OnMesh(heights);
    let error = apply(Preparation::default(), raw.clone(), Body::Pin, &mesh).unwrap_err();
    assert_eq!(
        error.to_string(),
        "2 of 8 points are missing; fill = \"level\" gives them the mean of the levelled surface, \
         fill = \"interpolate\" heights between those around them"
    );
    let filled = Preparation { fill: Some(Fill::Level), ..Preparation::default() };
    let mean = 22.0 / 6.0;
    let found = apply(filled, raw, Body::Pin, &mesh).unwrap();
    close(&found, &[mean, 2.0, 3.0, 6.0, mean, 2.0, 3.0, 6.0], 1e-15);
    let none = RawHeights::OnMesh(vec![f64::NAN; 8]);
    assert_eq!(apply(filled, none, Body::Pin, &mesh), Err(PreparationError::AllMissing { outliers: 0, points: 8 }));
}

#[test]
fn refuses_patches_that_do_not_cover_the_body() {
    let mesh = ring(100, 8, 20);
    let error =
        |pixels, body| apply(Preparation::default(), RawHeights::Patch(pixels), body, &mesh).unwrap_err().to_string();
    let advice = "repeat = true tiles the patch at its own scale without a step at the seams, extend = \"statistics\" \
                  makes heights with its statistics";
    for (pixels, body, found) in [
        (patch(30, 10, 1e-3, rough), Body::Disc, "the patch is 30 mm long, the ring 100 mm at the mean radius"),
        (patch(10, 10, 1e-3, rough), Body::Pin, "the patch is 10 mm long, the pin 20 mm at the mean radius"),
        (patch(200, 4, 1e-3, rough), Body::Disc, "the patch is 4 mm wide in r, the track 8 mm"),
    ] {
        assert_eq!(error(pixels, body), format!("{found}: {advice}"));
    }
}

#[test]
fn refuses_numbers_that_make_no_sense() {
    let mesh = ring(40, 2, 2);
    let error = |preparation: Preparation, raw| apply(preparation, raw, Body::Pin, &mesh).unwrap_err();
    let good = || RawHeights::OnMesh(vec![1.0; 4]);
    let nothing = Preparation::default();
    // Four heights, three of them alike: their median absolute deviation is 0.
    let alike = RawHeights::OnMesh(vec![1.0, 1.0, 1.0, 2.0]);
    let preparation = Preparation { outliers: Some(5.0), ..nothing };
    assert_eq!(error(preparation, alike), PreparationError::NoDeviation);
    let mut wrong = vec![
        ("cutoff", Preparation { cutoff: Some(f64::NAN), ..nothing }),
        ("scale", Preparation { scale: f64::INFINITY, ..nothing }),
    ];
    wrong.extend([f64::NAN, f64::INFINITY].map(|rotate| ("rotate", Preparation { rotate, ..nothing })));
    for number in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        wrong.extend([
            ("pixel", Preparation { pixel: Some(number), ..nothing }),
            ("outliers", Preparation { outliers: Some(number), ..nothing }),
            ("outlier_slope", Preparation { outlier_slope: Some(number), ..nothing }),
        ]);
    }
    for (expected, preparation) in wrong {
        let found = error(preparation, good());
        assert!(matches!(found, PreparationError::Value { key, .. } if key == expected), "{expected}: {found}");
    }
    for level in [Level::None, Level::Plane] {
        let infinite = RawHeights::OnMesh(vec![1.0, f64::INFINITY, 1.0, 1.0]);
        let preparation = Preparation { level, ..nothing };
        assert!(matches!(error(preparation, infinite), PreparationError::NotFinite { count: 1, .. }));
    }
    let short = RawHeights::OnMesh(vec![1.0; 3]);
    assert!(matches!(error(nothing, short), PreparationError::Grid { points: 3, .. }));
    let empty = Patch { columns: 0, rows: 0, column_pitch: 1.0, row_pitch: 1.0, heights: vec![] };
    assert!(matches!(error(nothing, RawHeights::Patch(empty)), PreparationError::Grid { .. }));
}

#[test]
fn a_length_is_told_in_the_unit_that_suits_it() {
    for (metres, text) in [
        (0.0, "0 m"),
        (1.953125e-9, "1.953 nm"),
        (1e-300, "1.000e-291 nm"),
        (-2e-13, "-2.000e-4 nm"),
        (1e308, "1.000e308 m"),
        (5e-5, "50 um"),
        (-3e-6, "-3 um"),
        (0.13823, "138.2 mm"),
        (1e-3, "1 mm"),
        (12.5, "12.5 m"),
    ] {
        assert_eq!(Length(metres).to_string(), text);
    }
}
