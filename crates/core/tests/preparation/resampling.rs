//! Patches brought onto the mesh.

use proptest::prelude::*;

use super::*;

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
