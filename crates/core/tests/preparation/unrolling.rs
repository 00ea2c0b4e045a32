//! Sectors of a ring as arc and radius.

use plateau_core::surface::{Crop, Unroll};

use super::*;

const PITCH: f64 = 0.1e-3;
/// Centre of the ring: below the middle of a patch of 12 mm by 8 mm, whose points then are at 20.05 to 27.95 mm from it in
/// y, and at -5.95 to 5.95 mm in x.
const CENTRE: [f64; 2] = [6e-3, -20e-3];
/// Columns of the part from 21 mm to 27 mm. An arc column is 0.1/24 rad; the outermost row, at 26.95 mm, leaves the patch at
/// asin(5.95/26.95) = 53.4 of these on either side, the innermost at acos(20.05/21.05), further out.
const COLUMNS: usize = 107;

/// Cells of 0.1 mm by 0.1 mm.
fn fine_ring(columns: usize, rows: usize, pin_columns: usize) -> Mesh {
    let mean_radius = PITCH * columns as f64 / TAU;
    let half = 0.5 * PITCH * rows as f64;
    Mesh::new(rows, columns, pin_columns, mean_radius - half, mean_radius + half).unwrap()
}

/// A patch by the place of its points from the centre, m.
fn measured(columns: usize, rows: usize, centre: [f64; 2], height: impl Fn(f64, f64) -> f64) -> Patch {
    let place = |index: usize, centre: f64| (index as f64 + 0.5) * PITCH - centre;
    patch(columns, rows, PITCH, |column, row| height(place(column, centre[0]), place(row, centre[1])))
}

fn unroll(centre: [f64; 2], radii: Option<[f64; 2]>) -> Preparation {
    Preparation { unroll: Some(Unroll { centre, radii }), ..Preparation::default() }
}

#[test]
fn heights_that_depend_on_the_radius_have_columns_that_are_alike() {
    // Cubic convolution errs by 0.096/6 h³ z''' along a line, in two directions by 1 + 1.25 times that (1.25 being the
    // largest sum of weights' sizes), for this wave 3.3e-4 of it, and by terms of higher order. The first and the last
    // columns run along the edge of the patch, where interpolation is bilinear: h²/8 (z_xx + z_yy), 5.5e-3 of it.
    let (wavelength, amplitude) = (3e-3, 1e-6);
    let wave = |radius: f64| amplitude * (TAU * radius / wavelength).sin();
    let pixels = measured(120, 80, CENTRE, |x, y| wave(x.hypot(y)));
    let radii = Some([21e-3, 27e-3]);
    let mesh = fine_ring(1500, 60, COLUMNS);
    let heights = apply(unroll(CENTRE, radii), RawHeights::Patch(pixels.clone()), Body::Pin, &mesh).unwrap();
    let expected = patch(COLUMNS, 60, PITCH, |_, row| wave(21e-3 + (row as f64 + 0.5) * PITCH)).heights;
    close(&heights, &expected, 6e-3 * amplitude);
    let inner = 10 * 60..(COLUMNS - 10) * 60;
    close(&heights[inner.clone()], &expected[inner.clone()], 5e-4 * amplitude);
    // The centre counts from the first corner before the patch is cropped.
    let cropped = Preparation {
        crop: Some(Crop { along: Some([0.5e-3, 11e-3]), across: Some([0.3e-3, 7.5e-3]) }),
        ..unroll(CENTRE, radii)
    };
    let mesh = fine_ring(1500, 60, 90);
    let heights = apply(cropped, RawHeights::Patch(pixels), Body::Pin, &mesh).unwrap();
    close(&heights, &expected[..90 * 60], 6e-3 * amplitude);
}

#[test]
fn x_runs_clockwise_and_y_outward() {
    // A plane a x + b y is interpolated exactly: at the angle t from the y axis, clockwise, and the radius r it is
    // a r sin t + b r cos t. Rounding of heights of 1 mm in some tens of operations.
    let (a, b) = (0.03, -0.02);
    let pixels = measured(120, 80, CENTRE, |x, y| a * x + b * y);
    let mesh = fine_ring(1500, 60, COLUMNS);
    let radii = Some([21e-3, 27e-3]);
    let prepared = unroll(CENTRE, radii).apply(RawHeights::Patch(pixels.clone()), false, Body::Pin, &mesh).unwrap();
    let expected = patch(COLUMNS, 60, PITCH, |column, row| {
        let angle = (column as f64 - 53.0) * PITCH / 24e-3;
        let radius = 21e-3 + (row as f64 + 0.5) * PITCH;
        radius * (a * angle.sin() + b * angle.cos())
    });
    close(&prepared.heights, &expected.heights, 2e-17);
    let says = "unrolled about 6 mm, -20 mm: radii from 21 mm to 27 mm, 25.54 deg clockwise, x the arc at the mean radius of \
                24 mm; 107 x 60 points of 100 um by 100 um interpolated from 9600, 0 missing";
    assert!(prepared.report[0].starts_with(says), "{}", prepared.report[0]);
    // The same turned by a quarter, the centre then being at the right.
    let turned = patch(80, 120, PITCH, |column, row| pixels.heights[row * 80 + 79 - column]);
    let centre = [28e-3, 6e-3];
    let found = apply(unroll(centre, radii), RawHeights::Patch(turned), Body::Pin, &mesh).unwrap();
    close(&found, &expected.heights, 2e-17);
}

#[test]
fn the_largest_rectangle_that_was_measured_is_kept() {
    // A whole ring of 4 mm to 6 mm, with missing points inside and outside of it, and a gap in it.
    let centre = [7e-3, 7e-3];
    let is_there = |x: f64, y: f64| (4e-3..6e-3).contains(&x.hypot(y)) && x.hypot(y - 5e-3) > 0.25e-3;
    let pixels = measured(140, 140, centre, |x, y| if is_there(x, y) { x.hypot(y) } else { f64::NAN });
    let mesh = fine_ring(1500, 16, 300);
    let filled = Preparation { fill: Some(Fill::Interpolate), pixel: Some(PITCH), ..unroll(centre, None) };
    let prepared = filled.apply(RawHeights::Patch(pixels.clone()), false, Body::Pin, &mesh).unwrap();
    let report = &prepared.report[0];
    assert!(report.contains("360.00 deg clockwise"), "{report}");
    // Round the ring of 2π times about 5 mm.
    let columns: usize = report.split("; ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((310..=320).contains(&columns), "{report}");
    assert!(!report.contains(" 0 missing"), "the gap is within: {report}");
    // Radii of the middle rows, whatever rows were kept: one pitch from row to row, to the error of interpolation and of
    // the membrane over the gap (a third of its width off at most, for it knows nothing of the slope's curvature).
    for column in prepared.heights.chunks_exact(16) {
        assert!((column[15] - column[0] - 15.0 * PITCH).abs() < 1e-6, "{column:?}");
        assert!((4e-3..6e-3).contains(&column[0]), "{column:?}");
    }
    // Without the gap's filling it is missing.
    let error = apply(unroll(centre, None), RawHeights::Patch(pixels), Body::Pin, &mesh).unwrap_err();
    assert!(matches!(error, PreparationError::Missing { outliers: 0, .. }), "{error}");
}

#[test]
fn what_is_no_ring_is_refused() {
    let mesh = fine_ring(1500, 20, 20);
    let error = |centre, radii, pixels: Patch| {
        apply(unroll(centre, radii), RawHeights::Patch(pixels), Body::Pin, &mesh).unwrap_err().to_string()
    };
    let pixels = || measured(120, 80, CENTRE, |x, _| x);
    assert_eq!(
        error(CENTRE, Some([19e-3, 27e-3]), pixels()),
        "in no direction the heights reach over unroll.radii, 19 mm to 27 mm, measured are radii from 20.05 mm to 28.58 mm: \
         check unroll.centre"
    );
    for radii in [[27e-3, 21e-3], [-1e-3, 21e-3], [21e-3, f64::INFINITY], [f64::NAN, 21e-3], [21e-3, 21e-3]] {
        assert!(error(CENTRE, Some(radii), pixels()).starts_with("unroll.radii are "), "{radii:?}");
    }
    for centre in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        assert!(error(centre, None, pixels()).starts_with("unroll.centre is "));
    }
    // Far away all is a patch as it is, or nothing at all; on the patch it is a ring of its own.
    for distance in [1e3, 1e6, 1e12, 1e100, 1e300] {
        let _ = apply(unroll([0.0, -distance], None), RawHeights::Patch(pixels()), Body::Pin, &mesh);
        let _ = apply(unroll([distance, distance], None), RawHeights::Patch(pixels()), Body::Pin, &mesh);
    }
    // A strip unrolled about its middle would be a circle of the strip's length.
    let strip = error([100e-3, 0.1e-3], None, patch(2000, 2, PITCH, rough));
    assert!(strip.starts_with("the ring round unroll.centre would have 3"), "{strip}");
    assert!(strip.contains(" points, the patch has 4000, at radii from "), "{strip}");
    let single = error([0.05e-3, 0.05e-3], None, patch(1, 1, PITCH, rough));
    assert!(single.contains("no four neighbouring points") || single.contains("would have"), "{single}");
    assert_eq!(error(CENTRE, None, patch(5, 5, PITCH, |_, _| f64::NAN)), "all 25 points are missing");
}
