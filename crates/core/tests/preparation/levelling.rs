//! Levelling and outliers.

use super::*;

#[test]
fn a_plane_is_taken_out_whatever_its_offset() {
    // Roughness of the pattern + − − + in both directions has no mean and no slope, so it is what must be left. The
    // heights themselves are rounded to half an ulp of 76 mm, 7e-18 m, in each of a few operations.
    let mesh = ring(400, 32, 32);
    let sign = |index: usize| if matches!(index % 4, 0 | 3) { 1.0 } else { -1.0 };
    let roughness = |column: usize, row: usize| 0.2e-6 * sign(column) * sign(row);
    let tilted =
        patch(32, 32, 1e-3, |column, row| 76e-3 + 3e-4 * column as f64 - 2e-4 * row as f64 + roughness(column, row));
    let preparation = Preparation { level: Level::Plane, ..Preparation::default() };
    let expected = patch(32, 32, 1e-3, roughness).heights;
    let heights = apply(preparation, RawHeights::OnMesh(tilted.heights.clone()), Body::Pin, &mesh).unwrap();
    close(&heights, &expected, 5e-17);

    // Missing points take no part: those that are left follow the plane exactly, and the filled ones get the mean 0.
    let mut holed = patch(32, 32, 1e-3, |column, row| 76e-3 + 3e-4 * column as f64 - 2e-4 * row as f64);
    holed.heights[5..300].fill(f64::NAN);
    let preparation = Preparation { fill: Some(Fill::Level), ..preparation };
    let heights = apply(preparation, RawHeights::OnMesh(holed.heights), Body::Pin, &mesh).unwrap();
    close(&heights, &[0.0; 1024], 5e-17);
}

/// Roughness of a Thue-Morse pattern has no moments of order 0, 1 and 2, so that a surface of second order leaves it.
fn without_moments(column: usize, row: usize) -> f64 {
    let sign = |index: usize| if index.count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
    0.2e-6 * sign(column % 8) * sign(row % 8)
}

#[test]
fn a_surface_of_second_order_is_taken_out_whatever_its_offset() {
    // Rounding as for the plane, of heights up to 90 mm.
    let mesh = ring(400, 32, 32);
    let form = |column: usize, row: usize| {
        let (x, y) = (column as f64, row as f64);
        76e-3 + 3e-4 * x - 2e-4 * y + 4e-6 * x * x - 3e-6 * x * y + 1e-6 * y * y
    };
    let preparation = Preparation { level: Level::Quadratic, ..Preparation::default() };
    let curved = patch(32, 32, 1e-3, |column, row| form(column, row) + without_moments(column, row));
    let heights = apply(preparation, RawHeights::OnMesh(curved.heights), Body::Pin, &mesh).unwrap();
    close(&heights, &patch(32, 32, 1e-3, without_moments).heights, 5e-17);
    // Missing points take no part.
    let mut holed = patch(32, 32, 1e-3, form);
    holed.heights[5..300].fill(f64::NAN);
    let preparation = Preparation { fill: Some(Fill::Level), ..preparation };
    close(&apply(preparation, RawHeights::OnMesh(holed.heights), Body::Pin, &mesh).unwrap(), &[0.0; 1024], 5e-17);
}

#[test]
fn levelling_leaves_nothing_of_what_it_takes_out() {
    // The residuals of least squares are orthogonal to every term, here with points missing at random and on a grid of
    // 3000 columns: rounding of sums of 12000 terms of 1e-6 and 3000² each.
    let mesh = ring(4000, 4, 3000);
    let mut rugged = patch(3000, 4, 1e-3, |column, row| rough(column, row) + 1e-9 * (column * column) as f64);
    let missing: Vec<bool> = (0..12_000).map(|index| index * 7919 % 11 == 0).collect();
    rugged.heights.iter_mut().zip(&missing).filter(|(_, missing)| **missing).for_each(|(z, _)| *z = f64::NAN);
    let preparation = Preparation { level: Level::Quadratic, fill: Some(Fill::Level), ..Preparation::default() };
    let found = apply(preparation, RawHeights::OnMesh(rugged.heights), Body::Pin, &mesh).unwrap();
    let product = |term: fn(f64, f64) -> f64| -> f64 {
        let points = found.iter().zip(&missing).enumerate().filter(|(_, (_, missing))| !**missing);
        points.map(|(index, (z, _))| z * term((index / 4) as f64 / 3000.0, (index % 4) as f64 / 4.0)).sum()
    };
    let terms: [fn(f64, f64) -> f64; 6] = [|_, _| 1.0, |x, _| x, |_, y| y, |x, _| x * x, |x, y| x * y, |_, y| y * y];
    for (index, term) in terms.into_iter().enumerate() {
        assert!(product(term).abs() < 12_000.0 * f64::EPSILON * 1e-2, "term {index}: {}", product(term));
    }
}

#[test]
fn points_on_one_line_are_levelled_along_it() {
    let mesh = ring(40, 4, 4);
    let diagonal = patch(4, 4, 1e-3, |column, row| if column == row { 1.0 + column as f64 } else { f64::NAN });
    let preparation = Preparation { level: Level::Plane, fill: Some(Fill::Level), ..Preparation::default() };
    close(&apply(preparation, RawHeights::Patch(diagonal), Body::Pin, &mesh).unwrap(), &[0.0; 16], 1e-15);
}

#[test]
fn a_ring_is_levelled_of_radial_slope_and_curvature_without_a_step() {
    let mesh = ring(100, 10, 10);
    let wave = |column: usize| (TAU * column as f64 / 100.0).sin();
    for (level, curvature) in [(Level::Plane, 0.0), (Level::Quadratic, -0.04)] {
        let form = |row: usize| 5.0 + 0.3 * row as f64 + curvature * (row * row) as f64;
        let heights = patch(100, 10, 1e-3, |column, row| form(row) + wave(column)).heights;
        let preparation = Preparation { level, ..Preparation::default() };
        let levelled = apply(preparation, RawHeights::OnMesh(heights), Body::Disc, &mesh).unwrap();
        // A whole sine has no mean but does have a slope along the columns, which must be left.
        close(&levelled, &patch(100, 10, 1e-3, |column, _| wave(column)).heights, 1e-14);
    }
}

#[test]
fn outliers_are_taken_out_and_the_surface_is_levelled_again_without_them() {
    // A plane with the pattern + − − + of 1 um. Eight spikes of 1 mm raise the first plane by 8 um; without them the second
    // leaves the pattern. The 512th and 513th of 1024 heights, and so the median, are +1 um; 508 heights lie 2 um below
    // it: 10 robust standard deviations are 10 · 1.4826 · 2 um.
    let mesh = ring(400, 32, 32);
    let sign = |index: usize| if matches!(index % 4, 0 | 3) { 1e-6 } else { -1e-6 };
    let tilted = |column: usize, row: usize| 1e-5 * column as f64 + 1e6 * sign(column) * sign(row);
    let mut spiked = patch(32, 32, 1e-3, tilted);
    // Four where the pattern is + and four where it is −, symmetric: what is left of it has no mean and no slope.
    let spikes = [0, 31].into_iter().flat_map(|row| [0, 1, 30, 31].map(|column| (column, row))).collect::<Vec<_>>();
    spikes.iter().for_each(|(column, row)| spiked.heights[column * 32 + row] += 1e-3);
    let preparation =
        Preparation { level: Level::Plane, outliers: Some(10.0), fill: Some(Fill::Level), ..Preparation::default() };
    let prepared = preparation.apply(RawHeights::OnMesh(spiked.heights.clone()), false, Body::Pin, &mesh).unwrap();
    let left = |column, row| if spikes.contains(&(column, row)) { 0.0 } else { 1e6 * sign(column) * sign(row) };
    let expected = patch(32, 32, 1e-3, left);
    close(&prepared.heights, &expected.heights, 1e-18);
    let report = prepared.report.join("\n");
    assert!(report.contains("outliers: 8 of 1024 points lie more than 29.65 um from the median"), "{report}");
    assert_eq!(report.matches("levelled by the least-squares plane: rms ").count(), 2, "{report}");
    assert!(report.contains("8 of 1024 points were missing and got the mean of the others: rms 1 um -> "), "{report}");
    let refused = Preparation { fill: None, ..preparation };
    let error = apply(refused, RawHeights::OnMesh(spiked.heights), Body::Pin, &mesh).unwrap_err();
    assert!(error.to_string().starts_with("8 of 1024 points are missing, 8 of them as outliers; fill = "), "{error}");
}

#[test]
fn outliers_that_leave_no_point_are_refused_however_gaps_are_filled() {
    // Half of the heights at +1 um and half at -1 um: the median is 0, every deviation 1 um, and half a robust standard deviation
    // 0.74 um.
    let mesh = ring(400, 32, 32);
    let chessboard = patch(32, 32, 1e-3, |column, row| if (column + row) % 2 == 0 { 1e-6 } else { -1e-6 });
    let stripes = patch(32, 32, 1e-3, |column, _| if column % 2 == 0 { 1e-6 } else { -1e-6 });
    for fill in [None, Some(Fill::Level), Some(Fill::Interpolate)] {
        for (pixels, level) in [(&chessboard, Level::None), (&stripes, Level::Plane)] {
            let preparation = Preparation { level, outliers: Some(0.5), fill, ..Preparation::default() };
            let error = apply(preparation, RawHeights::OnMesh(pixels.heights.clone()), Body::Pin, &mesh).unwrap_err();
            assert_eq!(error, PreparationError::AllMissing { outliers: 1024, points: 1024 });
            assert!(error.to_string().contains("1024 of them as outliers: give outliers or outlier_slope a larger"));
        }
    }
}

#[test]
fn a_form_leaves_nothing_of_itself() {
    let shapes = [(12, 10), (300, 200), (1024, 33)];
    let planes =
        [(0.1, 0.0, 0.0), (0.0, 1e-7, 3e-7), (0.076, 1.3e-8, -7.7e-7), (-3e-6, 0.02, 1.0 / 3.0), (1e-9, -1e-9, 0.0)];
    for ((columns, rows), (offset, along, across)) in
        shapes.into_iter().flat_map(|shape| planes.map(|plane| (shape, plane)))
    {
        let plane = patch(columns, rows, 1e-3, |x, y| offset + along * x as f64 + across * y as f64).heights;
        for form in [Level::Plane, Level::Quadratic] {
            let mut heights = plane.clone();
            level(&mut heights, rows, form, false);
            assert!(heights.iter().all(|height| *height == 0.0), "{offset} + {along} x + {across} y, {form:?}");
        }
        // A billionth of the tilt is a surface.
        let bump = 1e-9 * (offset.abs() + along.abs() * columns as f64 + across.abs() * rows as f64);
        let mut heights = plane;
        heights[columns * rows / 2] += bump;
        level(&mut heights, rows, Level::Plane, false);
        assert!((heights[columns * rows / 2] / bump - 1.0).abs() < 0.1);
    }
}
