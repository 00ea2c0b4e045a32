//! Spikes and pits told by their slopes.

use super::*;

/// Slopes between neighbours 1 mm apart are at most 1.4e-6/1e-3 here.
const BY_SLOPE: Preparation = Preparation { outlier_slope: Some(0.05), fill: Some(Fill::Level), ..Preparation::NONE };

/// Indices of the points that the chain took out.
fn taken_out(pixels: &Patch, body: Body) -> Vec<usize> {
    let mesh = ring(if body == Body::Disc { pixels.columns } else { 400 }, pixels.rows, pixels.columns);
    let prepared = BY_SLOPE.apply(RawHeights::OnMesh(pixels.heights.clone()), false, body, &mesh).unwrap();
    let changed = |index: &usize| prepared.heights[*index].to_bits() != pixels.heights[*index].to_bits();
    let changed: Vec<usize> = (0..pixels.heights.len()).filter(changed).collect();
    let count = format!("outliers by slope: {} of {} points ", changed.len(), pixels.heights.len());
    assert!(prepared.report[0].starts_with(&count), "{:?}", prepared.report);
    changed
}

/// Adds to the heights of a box of points; gives their indices.
fn raise(pixels: &mut Patch, [column, row]: [usize; 2], [columns, rows]: [usize; 2], height: f64) -> Vec<usize> {
    let rows_of_patch = pixels.rows;
    let indices = (column..column + columns).flat_map(|c| (row..row + rows).map(move |r| c * rows_of_patch + r));
    let indices: Vec<usize> = indices.collect();
    indices.iter().for_each(|index| pixels.heights[*index] += height);
    indices
}

#[test]
fn spikes_and_pits_of_up_to_three_points_across_are_taken_out() {
    let mut pixels = patch(40, 30, 1e-3, rough);
    let mut expected = Vec::new();
    for (at, size, height) in [
        ([5, 5], [1, 1], 1e-3),
        ([15, 10], [2, 2], -1e-3),
        ([25, 20], [3, 3], 1e-3),
        ([33, 4], [3, 1], -1e-3),
        ([0, 0], [1, 1], 1e-3),
        ([0, 20], [2, 1], 1e-3),
        ([38, 28], [2, 2], -1e-3),
    ] {
        expected.extend(raise(&mut pixels, at, size, height));
    }
    // A spike on a foot.
    expected.extend(raise(&mut pixels, [10, 22], [3, 3], 0.4e-3));
    raise(&mut pixels, [11, 23], [1, 1], 0.8e-3);
    expected.sort_unstable();
    assert_eq!(taken_out(&pixels, Body::Pin), expected);
}

#[test]
fn edges_ridges_grooves_and_plateaus_stay() {
    let mut pixels = patch(60, 50, 1e-3, rough);
    raise(&mut pixels, [40, 0], [20, 50], 1e-3);
    raise(&mut pixels, [40, 30], [20, 20], 1e-3);
    raise(&mut pixels, [2, 0], [1, 50], -1e-3);
    raise(&mut pixels, [5, 10], [30, 2], 1e-3);
    raise(&mut pixels, [10, 20], [4, 4], 1e-3);
    raise(&mut pixels, [20, 20], [5, 5], -1e-3);
    raise(&mut pixels, [30, 20], [4, 1], 1e-3);
    // Grooves in other directions than those of the grid and its diagonals.
    for step in 0..20 {
        raise(&mut pixels, [8 + step, 30 + step / 2], [1, 1], -2e-3);
        raise(&mut pixels, [45 + step / 3, 5 + step], [1, 1], -2e-3);
    }
    assert_eq!(taken_out(&pixels, Body::Pin), [0; 0]);
}

#[test]
fn the_limit_is_the_slope() {
    // A spike of 100 um on points 1 mm and, along the diagonal, √2 mm apart: slopes 0.1 and 0.0707.
    let mut pixels = patch(9, 9, 1e-3, |_, _| 0.0);
    raise(&mut pixels, [4, 4], [1, 1], 100e-6);
    let mesh = ring(100, 9, 9);
    for (limit, count) in [(0.0706, 1), (0.0708, 0)] {
        let preparation = Preparation { outlier_slope: Some(limit), ..BY_SLOPE };
        let prepared = preparation.apply(RawHeights::OnMesh(pixels.heights.clone()), false, Body::Pin, &mesh).unwrap();
        assert!(prepared.report[0].starts_with(&format!("outliers by slope: {count} of 81")), "{:?}", prepared.report);
    }
}

#[test]
fn the_ring_closes_and_missing_points_tell_nothing() {
    // Raised points on both sides of where the columns begin: on the ring five in a row, which is no spike; on the pin
    // two and three, which are.
    let mut pixels = patch(30, 8, 1e-3, rough);
    raise(&mut pixels, [0, 5], [2, 1], 1e-3);
    raise(&mut pixels, [27, 5], [3, 1], 1e-3);
    assert_eq!(taken_out(&pixels, Body::Disc), [0; 0]);
    assert_eq!(taken_out(&pixels, Body::Pin).len(), 5);
    // On the ring two of three in a row are at its end.
    let mut pixels = patch(30, 8, 1e-3, rough);
    let mut expected = raise(&mut pixels, [0, 5], [1, 1], 1e-3);
    expected.extend(raise(&mut pixels, [28, 5], [2, 1], 1e-3));
    assert_eq!(taken_out(&pixels, Body::Disc), expected);
    // Of a ring of one column every neighbour is itself.
    let column = patch(1, 20, 1e-3, |_, row| if row == 9 { 1.0 } else { 0.0 }).heights;
    let mesh = Mesh::new(20, 1, 1, 20e-3, 40e-3).unwrap();
    let found = apply(BY_SLOPE, RawHeights::OnMesh(column.clone()), Body::Disc, &mesh).unwrap();
    assert_eq!(found, column);
    // A point that stands alone is neither a spike nor a pit, one beside missing points may be.
    let mut pixels = patch(9, 9, 1e-3, |column, row| if column == 4 && row == 4 { 1.0 } else { f64::NAN });
    let taken = |pixels: &Patch| {
        let refused = Preparation { fill: None, ..BY_SLOPE };
        match apply(refused, RawHeights::OnMesh(pixels.heights.clone()), Body::Pin, &ring(100, 9, 9)) {
            Err(PreparationError::Missing { outliers, .. }) => outliers,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(taken(&pixels), 0);
    pixels.heights[3 * 9..4 * 9].fill(0.0);
    assert_eq!(taken(&pixels), 1);
}

#[test]
fn what_is_left_is_levelled_again_and_other_outliers_follow() {
    // A tilt of 1e-4 and one spike: the plane of the points that are left is taken out of all.
    let mesh = ring(400, 20, 20);
    let mut pixels = patch(20, 20, 1e-3, |column, _| 1e-7 * column as f64);
    raise(&mut pixels, [3, 3], [1, 1], 1e-2);
    let preparation = Preparation { level: Level::Plane, ..BY_SLOPE };
    let heights = apply(preparation, RawHeights::OnMesh(pixels.heights), Body::Pin, &mesh).unwrap();
    close(&heights, &[0.0; 400], 1e-17);
    // Both kinds are counted together in the error.
    let mut pixels = patch(20, 20, 1e-3, rough);
    raise(&mut pixels, [3, 3], [1, 1], 1e-2);
    raise(&mut pixels, [10, 10], [5, 5], 1e-2);
    let both = Preparation { outliers: Some(10.0), fill: None, ..BY_SLOPE };
    let error = apply(both, RawHeights::OnMesh(pixels.heights), Body::Pin, &mesh).unwrap_err();
    assert_eq!(error, PreparationError::Missing { missing: 26, outliers: 26, points: 400 });
}
