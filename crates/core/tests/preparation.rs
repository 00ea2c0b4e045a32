//! The preparation chain against hand computation and closed forms.

use std::f64::consts::TAU;

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{Body, Fill, Level, Patch, Preparation, PreparationError, RawHeights};
use proptest::prelude::*;

/// Cells of 1 mm by 1 mm at the mean radius.
fn ring(columns: usize, rows: usize, pin_columns: usize) -> Mesh {
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
fn a_ring_is_levelled_without_a_step() {
    let mesh = ring(100, 10, 10);
    let wave = |column: usize| (TAU * column as f64 / 100.0).sin();
    let heights = patch(100, 10, 1e-3, |column, row| 5.0 + 0.3 * row as f64 + wave(column)).heights;
    let preparation = Preparation { level: Level::Plane, ..Preparation::default() };
    let levelled = apply(preparation, RawHeights::OnMesh(heights), Body::Disc, &mesh).unwrap();
    // A whole sine has no mean but does have a slope along the columns, which must be left.
    close(&levelled, &patch(100, 10, 1e-3, |column, _| wave(column)).heights, 1e-14);
}

#[test]
fn a_ring_is_levelled_of_radial_slope_and_curvature() {
    let mesh = ring(100, 10, 10);
    let wave = |column: usize| (TAU * column as f64 / 100.0).sin();
    let form = |row: usize| 5.0 + 0.3 * row as f64 - 0.04 * (row * row) as f64;
    let heights = patch(100, 10, 1e-3, |column, row| form(row) + wave(column)).heights;
    let preparation = Preparation { level: Level::Quadratic, ..Preparation::default() };
    let levelled = apply(preparation, RawHeights::OnMesh(heights), Body::Disc, &mesh).unwrap();
    close(&levelled, &patch(100, 10, 1e-3, |column, _| wave(column)).heights, 1e-14);
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
fn a_membrane_over_gaps_is_harmonic() {
    // Discrete Laplace: a + bx + cy + dxy and x² − (y/pitch ratio)² obey it exactly, so gaps inside them are filled with
    // them, to the residual of 1e-10 times the condition of the equations (some hundred for a gap of 12 points).
    let mesh = ring(400, 24, 30);
    for ratio in [1.0, 2.5] {
        let saddle = |column: usize, row: usize| {
            let (x, y) = (column as f64, ratio * row as f64);
            3.0 + 0.1 * x - 0.2 * y + 0.01 * x * y + 0.02 * (x * x - y * y)
        };
        let mut holed = patch(30, 24, 1e-3, saddle);
        // The pitch across is that along times the ratio, and the patch as wide as it must be.
        holed.row_pitch = ratio * 1e-3;
        for (column, row) in (5..17).flat_map(|column| (4..16).map(move |row| (column, row))).chain([(20, 3), (28, 22)])
        {
            holed.heights[column * 24 + row] = f64::NAN;
        }
        let missing: Vec<bool> = holed.heights.iter().map(|height| height.is_nan()).collect();
        // Onto pixels of 1 mm, which are cells.
        let preparation = Preparation { fill: Some(Fill::Interpolate), pixel: Some(1e-3), ..Preparation::default() };
        let filled = apply(preparation, RawHeights::Patch(holed), Body::Pin, &mesh).unwrap();
        close(&filled, &patch(30, 24, 1e-3, saddle).heights, 1e-6);
        assert_eq!(missing.iter().filter(|missing| **missing).count(), 146);
    }
}

#[test]
fn a_membrane_over_a_wide_gap_comes_near_the_harmonic_one() {
    // A gap of 300 by 300 points in a saddle from -2 to 2, more than the iterations on the finest grid reach. Without the
    // coarser grids the middle of the gap would stay where it started.
    let mesh = ring(4000, 401, 401);
    let place = |index: usize| index as f64 / 200.0 - 1.0;
    let saddle = patch(401, 401, 1e-3, |column, row| 2.0 * place(column) * place(row)).heights;
    let mut holed = saddle.clone();
    (50..350).for_each(|column| holed[column * 401 + 50..column * 401 + 350].fill(f64::NAN));
    let preparation = Preparation { fill: Some(Fill::Interpolate), ..Preparation::default() };
    let filled = apply(preparation, RawHeights::OnMesh(holed), Body::Pin, &mesh).unwrap();
    let largest = filled.iter().zip(&saddle).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(largest < 1e-3, "{largest}");
}

#[test]
fn a_membrane_closes_with_the_ring_and_is_free_at_the_edges() {
    // Every second column of a ring is missing, the last one too: halfway between its neighbours. Whole rows at the edge
    // get what lies next to them.
    let mesh = ring(40, 3, 10);
    let mut heights = patch(40, 3, 1e-3, |column, _| if column % 2 == 0 { column as f64 } else { f64::NAN }).heights;
    let preparation = Preparation { fill: Some(Fill::Interpolate), ..Preparation::default() };
    let found = apply(preparation, RawHeights::OnMesh(heights.clone()), Body::Disc, &mesh).unwrap();
    let expected = patch(40, 3, 1e-3, |column, _| if column == 39 { 19.0 } else { column as f64 });
    close(&found, &expected.heights, 1e-8);
    heights = patch(40, 3, 1e-3, |column, row| if row == 1 { column as f64 } else { f64::NAN }).heights;
    heights.truncate(30);
    let found = apply(preparation, RawHeights::OnMesh(heights), Body::Pin, &mesh).unwrap();
    assert_eq!(found[1], 0.0);
    // Symmetric rows have the same membrane, and it lies between the lowest and the highest.
    assert!(found.chunks(3).all(|column| (column[0] - column[2]).abs() < 1e-8 && (0.0..=9.0).contains(&column[0])));
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
fn pixels_as_large_as_cells_are_taken_one_by_one() {
    // A place is rounded to ε times the ring's 50 cells, a height thereby to that times the largest step of 1e-6.
    let mesh = ring(50, 8, 12);
    let pixels = patch(50, 8, 1e-3, rough);
    let disc = apply(Preparation::default(), RawHeights::Patch(pixels.clone()), Body::Disc, &mesh).unwrap();
    close(&disc, &pixels.heights, 1e-19);
    let pin = apply(Preparation::default(), RawHeights::Patch(pixels.clone()), Body::Pin, &mesh).unwrap();
    close(&pin, &pixels.heights[..96], 1e-19);
    // Mirrored, x runs from the other end.
    let mirrored = Preparation::default().apply(RawHeights::Patch(pixels), true, Body::Pin, &mesh).unwrap();
    close(&mirrored.heights, &patch(12, 8, 1e-3, |column, row| rough(49 - column, row)).heights, 1e-19);
}

#[test]
fn rows_are_centred_and_planes_are_interpolated_exactly() {
    // Bilinear interpolation reproduces a plane; the track's middle lies on the patch's middle.
    let mesh = ring(50, 4, 6);
    let pitch = 2.5e-3;
    let plane = patch(4, 5, pitch, |column, row| 3.0 * (column as f64 + 0.5) + 2.0 * (row as f64 + 0.5));
    let pin = apply(Preparation::default(), RawHeights::Patch(plane), Body::Pin, &mesh).unwrap();
    // In pixels: x = (c + ½)/2.5, beyond the outermost centres constant; y = 2.5 + (i − 1.5)/2.5.
    let expected = patch(6, 4, 1e-3, |column, row| {
        3.0 * ((column as f64 + 0.5) / 2.5).max(0.5) + 2.0 * (2.5 + (row as f64 - 1.5) / 2.5)
    });
    close(&pin, &expected.heights, 1e-13);
}

#[test]
fn finer_pixels_are_averaged() {
    let mesh = ring(20, 3, 5);
    let fine = patch(15, 9, 1e-3 / 3.0, rough);
    let pin = apply(Preparation::default(), RawHeights::Patch(fine.clone()), Body::Pin, &mesh).unwrap();
    let expected = patch(5, 3, 1e-3, |column, row| {
        let pixels = (0..9).map(|k| fine.heights[(3 * column + k / 3) * 9 + 3 * row + k % 3]);
        pixels.sum::<f64>() / 9.0
    });
    close(&pin, &expected.heights, 1e-19);
}

/// Mean of sin(kx) between two places.
fn mean_of_sine(k: f64, from: f64, to: f64) -> f64 {
    ((k * from).cos() - (k * to).cos()) / (k * (to - from))
}

#[test]
fn waves_shorter_than_cells_are_attenuated_like_by_a_box() {
    // Pixels hold the mean of the wave over them, as an instrument gives it; cells that begin and end with a pixel then
    // have the mean of the wave over them, sin(kx) times sin(kw/2)/(kw/2), to rounding.
    let mesh = ring(60, 3, 20);
    let (per_cell, cell) = (16, 1e-3);
    let pitch = cell / per_cell as f64;
    for wavelength in [0.37 * cell, 0.7 * cell, 1.3 * cell, 2.1 * cell, 9.0 * cell] {
        let k = TAU / wavelength;
        let (x, y) = (|column: usize| column as f64 * pitch, |row: usize| row as f64 * pitch);
        let fine = patch(20 * per_cell, 3 * per_cell, pitch, |column, row| {
            mean_of_sine(k, x(column), x(column + 1)) + mean_of_sine(k, y(row), y(row + 1))
        });
        let found = apply(Preparation::default(), RawHeights::Patch(fine), Body::Pin, &mesh).unwrap();
        let box_filter = (0.5 * k * cell).sin() / (0.5 * k * cell);
        let wave = |index: usize| (k * (index as f64 + 0.5) * cell).sin() * box_filter;
        close(&found, &patch(20, 3, cell, |column, row| wave(column) + wave(row)).heights, 1e-12);
    }
    // Pixels that do not divide the cells: the edges of a cell are known to half a pixel of 1/31.7 of it, where the wave
    // is at most 1.
    let pitch = cell / 31.7;
    let k = TAU / (0.7 * cell);
    let fine = patch(640, 100, pitch, |column, _| mean_of_sine(k, column as f64 * pitch, (column + 1) as f64 * pitch));
    let found = apply(Preparation::default(), RawHeights::Patch(fine), Body::Pin, &mesh).unwrap();
    let box_filter = (0.5 * k * cell).sin() / (0.5 * k * cell);
    let expected = patch(20, 3, cell, |column, _| (k * (column as f64 + 0.5) * cell).sin() * box_filter);
    close(&found, &expected.heights, k * pitch * pitch / cell);
}

#[test]
fn the_mean_of_all_cells_is_that_of_the_area_they_cover() {
    // A patch whose pixels fit the cells in no way; its own part under the body, weighed by area, is the oracle.
    let mesh = ring(60, 5, 20);
    for pitch in [0.07e-3, 0.313e-3, 0.9999e-3, 1e-3] {
        let (columns, rows) = ((20e-3 / pitch) as usize + 3, (5e-3 / pitch) as usize + 2);
        let pixels = patch(columns, rows, pitch, rough);
        let found = apply(Preparation::default(), RawHeights::Patch(pixels.clone()), Body::Pin, &mesh).unwrap();
        let overlap = |index: usize, from: f64, to: f64| {
            (((index + 1) as f64 * pitch).min(to) - (index as f64 * pitch).max(from)).max(0.0) / (to - from)
        };
        let lower = 0.5 * (rows as f64 * pitch - 5e-3);
        let weight = |index: usize| overlap(index / rows, 0.0, 20e-3) * overlap(index % rows, lower, lower + 5e-3);
        let expected: f64 = pixels.heights.iter().enumerate().map(|(index, z)| weight(index) * z).sum();
        let mean = found.iter().sum::<f64>() / 100.0;
        assert!((mean - expected).abs() < 1e-12 * 1e-6, "pitch {pitch}: {mean}, expected {expected}");
    }
}

proptest! {
    /// Neighbouring cells hold means over windows that are one cell apart, so no step is larger than the largest between
    /// two places of the patch that are one cell apart; at a seam, where the patch is mirrored, they are nearer still.
    #[test]
    fn no_step_of_a_repeated_patch_is_larger_than_inside_it(
        columns in 7_usize..80, length in 1_usize..90, pitch in 0.05_f64..3.0, seed in 0_usize..1000,
    ) {
        prop_assume!(length as f64 * pitch >= 1.0);
        let mesh = ring(columns, 2, columns);
        let rows = 2 + (2.0 / pitch) as usize;
        let mut pixels = patch(length, rows, 1e-3 * pitch, |column, row| rough(column + seed, row));
        pixels.row_pitch = 2e-3 / rows as f64 * (1.0 + 1e-12);
        // Places one cell apart lie at most this many pixels apart.
        let apart = (1.0 / pitch).ceil() as usize;
        let mut limit = 0.0_f64;
        for (first, second) in (0..length).flat_map(|a| (a..length.min(a + apart + 1)).map(move |b| (a, b))) {
            for row in 0..rows {
                limit = limit.max((pixels.heights[first * rows + row] - pixels.heights[second * rows + row]).abs());
            }
        }
        let preparation = Preparation { repeat: true, ..Preparation::default() };
        let heights = apply(preparation, RawHeights::Patch(pixels), Body::Disc, &mesh).unwrap();
        let next = heights[2..].iter().chain(&heights[..2]);
        for (place, (a, b)) in heights.iter().zip(next).enumerate() {
            prop_assert!((a - b).abs() <= limit + 1e-18, "cell {}: step {}, limit {}", place, (a - b).abs(), limit);
        }
    }
}

#[test]
fn a_repeated_patch_leaves_no_step() {
    // Whatever the ratio of ring and patch, no step between neighbours is larger than the largest inside the patch.
    for (columns, length) in [(50, 7), (50, 10), (51, 8), (49, 30), (40, 60)] {
        let mesh = ring(columns, 6, columns);
        let pixels = patch(length, 6, 1e-3, rough);
        let largest = |heights: &[f64], closed: bool| {
            let next = heights[6..].iter().chain(if closed { &heights[..6] } else { &[] });
            heights.iter().zip(next).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let preparation = Preparation { repeat: true, ..Preparation::default() };
        for (body, closed) in [(Body::Disc, true), (Body::Pin, false)] {
            let heights = apply(preparation, RawHeights::Patch(pixels.clone()), body, &mesh).unwrap();
            let limit = largest(&pixels.heights, false) + 1e-18;
            assert!(largest(&heights, closed) <= limit, "{columns} columns, patch of {length}, {body:?}");
            // The first half of the ring, and all of the pin, is the patch, its mirror image, the patch ...
            let count = if closed { columns / 2 } else { columns };
            let tiled = patch(count, 6, 1e-3, |column, row| {
                let place = column % (2 * length);
                rough(place.min(2 * length - 1 - place), row)
            });
            close(&heights[..6 * count], &tiled.heights, 1e-18);
        }
    }
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
    assert_eq!(apply(filled, none, Body::Pin, &mesh), Err(PreparationError::AllMissing { points: 8 }));
}

#[test]
fn refuses_patches_that_do_not_cover_the_body() {
    let mesh = ring(100, 8, 20);
    let error = |pixels, body, repeat| {
        let preparation = Preparation { repeat, ..Preparation::default() };
        apply(preparation, RawHeights::Patch(pixels), body, &mesh).unwrap_err().to_string()
    };
    assert_eq!(
        error(patch(30, 10, 1e-3, rough), Body::Disc, false),
        "the patch is 30 mm long, the ring 100 mm at the mean radius: repeat = true tiles the patch without a step at \
         the seams"
    );
    assert_eq!(
        error(patch(10, 10, 1e-3, rough), Body::Pin, false),
        "the patch is 10 mm long, the pin 20 mm at the mean radius: repeat = true tiles the patch without a step at \
         the seams"
    );
    assert_eq!(
        error(patch(200, 4, 1e-3, rough), Body::Disc, true),
        "the patch is 4 mm wide in r, the track 8 mm: a pixel of at least 2 mm lets its 4 rows cover the track"
    );
    let mut thin = patch(3, 10, 1e-3, rough);
    thin.column_pitch = 1e-300;
    assert!(error(thin, Body::Disc, true).contains("one column 1 mm"));
}

#[test]
fn refuses_numbers_that_make_no_sense() {
    let mesh = ring(40, 2, 2);
    let error = |preparation: Preparation, raw| apply(preparation, raw, Body::Pin, &mesh).unwrap_err();
    let good = || RawHeights::OnMesh(vec![1.0; 4]);
    let nothing = Preparation::default();
    for pixel in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let preparation = Preparation { pixel: Some(pixel), ..nothing };
        assert!(matches!(error(preparation, good()), PreparationError::Value { key: "pixel", .. }));
    }
    for outliers in [0.0, -3.0, f64::NAN, f64::INFINITY] {
        let preparation = Preparation { outliers: Some(outliers), ..nothing };
        assert!(matches!(error(preparation, good()), PreparationError::Value { key: "outliers", .. }));
    }
    // Four heights, three of them alike: their median absolute deviation is 0.
    let alike = RawHeights::OnMesh(vec![1.0, 1.0, 1.0, 2.0]);
    let preparation = Preparation { outliers: Some(5.0), ..nothing };
    assert_eq!(error(preparation, alike), PreparationError::NoDeviation);
    let preparation = Preparation { cutoff: Some(f64::NAN), ..nothing };
    assert!(matches!(error(preparation, good()), PreparationError::Value { key: "cutoff", .. }));
    let preparation = Preparation { scale: f64::INFINITY, ..nothing };
    assert!(matches!(error(preparation, good()), PreparationError::Value { key: "scale", .. }));
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
