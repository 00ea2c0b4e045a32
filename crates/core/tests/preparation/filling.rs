//! Membranes over missing points.

use super::*;

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
