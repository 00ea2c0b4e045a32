//! Patches cropped, turned and flipped.

use plateau_core::surface::{Crop, Flip};

use super::*;

/// What the chain makes of a patch that then has so many columns and rows, point by point.
fn points(preparation: Preparation, pixels: &Patch, columns: usize, rows: usize) -> Vec<f64> {
    let preparation = Preparation { pixel: Some(1e-3), ..preparation };
    let mesh = ring(10 * columns + 10 * rows, rows, columns);
    apply(preparation, RawHeights::Patch(pixels.clone()), Body::Pin, &mesh).unwrap()
}

fn refused(preparation: Preparation, pixels: Patch) -> String {
    apply(preparation, RawHeights::Patch(pixels), Body::Pin, &ring(100, 2, 2)).unwrap_err().to_string()
}

#[test]
fn a_crop_keeps_the_points_in_its_range() {
    // Points lie at 0.5, 1.5, ... mm along and at 1, 3, ... mm across.
    let mut pixels = patch(12, 9, 1e-3, rough);
    pixels.row_pitch = 2e-3;
    let crop = Crop { along: Some([2e-3, 7e-3]), across: Some([1.5e-3, 13.5e-3]) };
    let kept = points(Preparation { crop: Some(crop), ..Preparation::default() }, &pixels, 5, 6);
    close(&kept, &patch(5, 6, 1e-3, |column, row| rough(column + 2, row + 1)).heights, 1e-19);
    // One direction alone; parts side by side share no point and leave none out.
    for (from, to, first, count) in [(0.0, 4.5e-3, 0, 4), (4.5e-3, 12e-3, 4, 8)] {
        let crop = Crop { along: Some([from, to]), across: None };
        let kept = points(Preparation { crop: Some(crop), ..Preparation::default() }, &pixels, count, 9);
        close(&kept, &patch(count, 9, 1e-3, |column, row| rough(column + first, row)).heights, 1e-19);
    }
    let message = |along| {
        let crop = Some(Crop { along: Some(along), across: None });
        refused(Preparation { crop, ..Preparation::default() }, pixels.clone())
    };
    for (along, shown) in
        [([0.0, 13e-3], "0 m to 13 mm"), ([-1e-3, 5e-3], "-1 mm to 5 mm"), ([5e-3, 4e-3], "5 mm to 4 mm")]
    {
        let bounds = "expected two lengths from 0 m to the patch's 12 mm, the smaller one first";
        assert_eq!(message(along), format!("crop.along goes from {shown}, {bounds}"));
    }
    assert!(message([f64::NAN, 1e-3]).contains("crop.along"));
    assert_eq!(
        message([0.6e-3, 1.4e-3]),
        "crop.along from 600 um to 1.4 mm has no point of the patch, whose points are 1 mm apart, the first at half of that"
    );
}

#[test]
fn a_flip_reverses_columns_and_rows() {
    let pixels = patch(6, 4, 1e-3, rough);
    for (flip, expected) in [
        (Flip::Along, patch(6, 4, 1e-3, |column, row| rough(5 - column, row))),
        (Flip::Across, patch(6, 4, 1e-3, |column, row| rough(column, 3 - row))),
        (Flip::Both, patch(6, 4, 1e-3, |column, row| rough(5 - column, 3 - row))),
    ] {
        let flipped = points(Preparation { flip: Some(flip), ..Preparation::default() }, &pixels, 6, 4);
        close(&flipped, &expected.heights, 1e-19);
    }
    // Heights that are on the mesh stay there, bit for bit.
    let mesh = ring(15, 4, 2);
    let preparation = Preparation { flip: Some(Flip::Along), ..Preparation::default() };
    let heights = patch(15, 4, 1e-3, rough).heights;
    let flipped = apply(preparation, RawHeights::OnMesh(heights), Body::Disc, &mesh).unwrap();
    assert_eq!(flipped, patch(15, 4, 1e-3, |column, row| rough(14 - column, row)).heights);
}

fn turned(degrees: f64) -> Preparation {
    Preparation { rotate: degrees.to_radians(), ..Preparation::default() }
}

#[test]
fn quarters_of_a_turn_move_points() {
    // y is up in a patch and down in numpy.rot90([[1, 2, 3], [4, 5, 6]], k), so the rows are told from the last.
    let from_lines = |lines: &[&[f64]]| -> Vec<f64> {
        (0..lines[0].len()).flat_map(|x| lines.iter().rev().map(move |line| line[x])).collect()
    };
    let pixels = Patch {
        columns: 3,
        rows: 2,
        column_pitch: 1e-3,
        row_pitch: 1e-3,
        heights: from_lines(&[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]]),
    };
    for (degrees, columns, expected) in [
        (90.0, 2, from_lines(&[&[3.0, 6.0], &[2.0, 5.0], &[1.0, 4.0]])),
        (180.0, 3, from_lines(&[&[6.0, 5.0, 4.0], &[3.0, 2.0, 1.0]])),
        (270.0, 2, from_lines(&[&[4.0, 1.0], &[5.0, 2.0], &[6.0, 3.0]])),
        (-90.0, 2, from_lines(&[&[4.0, 1.0], &[5.0, 2.0], &[6.0, 3.0]])),
        (360.0, 3, pixels.heights.clone()),
    ] {
        close(&points(turned(degrees), &pixels, columns, 6 / columns), &expected, 1e-14);
    }
    // Four times a quarter is the identity.
    let pixels = patch(7, 4, 1e-3, rough);
    let mut heights = pixels.heights.clone();
    for (columns, rows) in [(7, 4), (4, 7), (7, 4), (4, 7)] {
        let pixels = Patch { columns, rows, column_pitch: 1e-3, row_pitch: 1e-3, heights };
        heights = points(turned(90.0), &pixels, rows, columns);
    }
    close(&heights, &pixels.heights, 1e-18);
    // The pitches are exchanged.
    let wide = Patch { column_pitch: 2e-3, ..patch(2, 4, 1e-3, rough) };
    let prepared = turned(90.0).apply(RawHeights::Patch(wide), false, Body::Pin, &ring(100, 3, 2)).unwrap();
    let report = prepared.report.join("\n");
    assert!(report.contains("patch of 4 mm by 4 mm"), "{report}");
    assert!(
        report.contains("points 1 mm apart (about a cell) along sliding")
            && report.contains("points 2 mm apart across it"),
        "{report}"
    );
}

#[test]
fn heights_on_the_mesh_stay_there_when_they_are_turned_by_half_a_turn() {
    let mesh = ring(12, 3, 4);
    let heights = patch(12, 3, 1e-3, rough).heights;
    let found = apply(turned(180.0), RawHeights::OnMesh(heights.clone()), Body::Disc, &mesh).unwrap();
    assert_eq!(found, heights.iter().rev().copied().collect::<Vec<_>>());
    // By a quarter they are a patch of 3 by 12.
    let error = apply(turned(90.0), RawHeights::OnMesh(heights), Body::Disc, &mesh).unwrap_err().to_string();
    assert!(error.starts_with("the patch is 3 mm long, the ring 12 mm"), "{error}");
}

#[test]
fn a_plane_turned_by_any_angle_is_a_plane() {
    // Turned by t, slopes (a, b) become (a cos t - b sin t, a sin t + b cos t). Both ways of interpolation give back a plane,
    // to rounding of heights of 2 mm (1e-18 m) in some ten operations, over a pitch of 1 mm.
    let (a, b) = (0.03, -0.02);
    for row_pitch in [1e-3, 0.8e-3] {
        let mut plane = patch(40, 60, 1e-3, |column, row| a * 1e-3 * column as f64 + b * row_pitch * row as f64 + 1e-3);
        plane.row_pitch = row_pitch;
        for degrees in [0.5, 3.0, -20.0, 30.0, 45.0, 70.0, 100.0, 135.0, 190.0, -100.0, 285.0] {
            // The pitches are those of the nearest quarter of a turn.
            let exchanged = (degrees / 90.0_f64).round() as i32 % 2 != 0;
            let (width, height) = if exchanged { (row_pitch, 1e-3) } else { (1e-3, row_pitch) };
            let heights = points(turned(degrees), &plane, 10, 10);
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let (along, across) = (width * (a * cosine - b * sine), height * (a * sine + b * cosine));
            for column in heights.windows(11).step_by(10).take(9) {
                assert!(
                    (column[10] - column[0] - along).abs() < 2e-17,
                    "{degrees}: {} {along}",
                    column[10] - column[0]
                );
            }
            for pair in heights[..10].windows(2) {
                assert!((pair[1] - pair[0] - across).abs() < 2e-17, "{degrees}: {} {across}", pair[1] - pair[0]);
            }
        }
    }
}

#[test]
fn the_largest_rectangle_within_the_turned_patch_is_kept() {
    // A square whose outermost points are s apart, turned by 45 deg: the largest upright one within has the side s/√2, here
    // 40/√2 = 28.3 pitches: 29 points. By 30 deg: (cos - sin)/(cos² - sin²) = 0.732 s, 29.3 pitches.
    for (degrees, count) in [(45.0, 29), (30.0, 30), (-30.0, 30), (120.0, 30)] {
        let prepared = turned(degrees).apply(
            RawHeights::Patch(patch(41, 41, 1e-3, rough)),
            false,
            Body::Pin,
            &ring(100, count, count),
        );
        let report = prepared.unwrap().report;
        assert!(
            report[0].contains(&format!(" {count} x {count} of 41 x 41 points, 0 missing (0 before)")),
            "{report:?}"
        );
    }
}

#[test]
fn turning_makes_points_round_a_missing_one_missing() {
    let mut holed = patch(21, 21, 1e-3, |_, _| 1.0);
    holed.heights[10 * 21 + 10] = f64::NAN;
    let missing = |pixels: Patch| match apply(turned(45.0), RawHeights::Patch(pixels), Body::Pin, &ring(100, 3, 3)) {
        Err(PreparationError::Missing { missing, .. }) => missing,
        other => panic!("{other:?}"),
    };
    // The places that have the point among their four are in the square of two pitches about it, without its edge. Turned
    // by 45 deg, of a grid with a point on the middle these are that point and its eight neighbours but for the four at
    // √2 pitches, which come to lie on the old rows and columns.
    assert_eq!(missing(holed.clone()), 5);
    // All others have a height.
    let filled = Preparation { fill: Some(Fill::Level), ..turned(45.0) };
    let heights = points(filled, &holed, 15, 15);
    close(&heights, &[1.0; 225], 1e-14);
    holed.heights.fill(f64::NAN);
    holed.heights[0] = 1.0;
    let error = apply(turned(45.0), RawHeights::Patch(holed), Body::Pin, &ring(100, 3, 3)).unwrap_err();
    assert!(matches!(error, PreparationError::AllMissing { .. }), "{error}");
}
