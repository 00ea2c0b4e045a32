//! Patches smaller than the body, tiled along and across sliding.

use super::*;
use crate::synthesis_bits::digest;

fn tiled(pixels: &Patch, body: Body, mesh: &Mesh) -> Vec<f64> {
    let preparation = Preparation { repeat: true, ..Preparation::default() };
    apply(preparation, RawHeights::Patch(pixels.clone()), body, mesh).unwrap()
}

/// Place in a line of `count` that is mirrored at both ends over and over.
pub(super) fn mirrored(place: isize, count: usize) -> usize {
    let place = place.rem_euclid(2 * count as isize) as usize;
    place.min(2 * count - 1 - place)
}

#[test]
fn rows_are_mirrored_about_the_patch_in_the_middle_of_the_track() {
    // 13 rows of track, 5 of patch: 4 before and 4 after, each the mirror image of the rows beside it.
    let (columns, rows, track) = (7, 5, 13);
    let mesh = ring(100, track, 20);
    let pixels = patch(columns, rows, 1e-3, rough);
    for (body, count) in [(Body::Disc, 20), (Body::Pin, 20)] {
        let heights = tiled(&pixels, body, &mesh);
        let expected = patch(count, track, 1e-3, |column, row| {
            rough(mirrored(column as isize, columns), mirrored(row as isize - 4, rows))
        });
        // Places are rounded to ε times the ring, weighing steps of up to 1e-6.
        close(&heights[..count * track], &expected.heights, 1e-18);
    }
}

/// The largest step between neighbours across sliding, and along it (round the ring).
fn largest_steps(heights: &[f64], rows: usize, closed: bool) -> [f64; 2] {
    let across = heights.chunks(rows).flat_map(|column| column.windows(2).map(|pair| (pair[0] - pair[1]).abs()));
    let next = heights[rows..].iter().chain(if closed { &heights[..rows] } else { &[] });
    let along = heights.iter().zip(next).map(|(one, other)| (one - other).abs());
    [across.fold(0.0, f64::max), along.fold(0.0, f64::max)]
}

#[test]
fn no_seam_has_a_step() {
    // A slope in both directions: tiles that are not mirrored would differ by nearly its whole height at every seam, here
    // 30 or 20 times the step from point to point.
    for (columns, rows, ring_columns, track) in
        [(30, 20, 200, 50), (30, 20, 201, 47), (31, 19, 164, 19), (30, 20, 400, 61)]
    {
        let mesh = ring(ring_columns, track, ring_columns);
        let slope = patch(columns, rows, 1e-3, |column, row| 1e-6 * (column + row) as f64 + 1e-2 * rough(column, row));
        let limit = largest_steps(&slope.heights, rows, false);
        for body in [Body::Disc, Body::Pin] {
            let heights = tiled(&slope, body, &mesh);
            let steps = largest_steps(&heights, track, body == Body::Disc);
            for (found, limit) in steps.iter().zip(limit) {
                assert!(*found <= limit * (1.0 + 1e-9), "{ring_columns} by {track}, {body:?}: {found} > {limit}");
                // Nor is it smoothed away.
                assert!(*found > 0.5e-6, "{found}");
            }
        }
    }
}

#[test]
fn true_scale_is_kept() {
    // A wave along and one across of the patch, each a whole number of half waves long so that its mirror image continues it:
    // the tiled track has the same waves throughout, attenuated by nothing where pixels are cells.
    let (columns, rows, track) = (24, 16, 64);
    let mesh = ring(240, track, 10);
    let wave = |column: usize, row: usize| {
        let phase = |place: usize, count: usize| TAU * (place as f64 + 0.5) * 2.0 / count as f64;
        1e-6 * (phase(column, columns).cos() + phase(row, rows).cos())
    };
    let heights = tiled(&patch(columns, rows, 1e-3, wave), Body::Disc, &mesh);
    // The patch begins at row 24 of the track, which is three waves of 8 rows.
    close(&heights, &patch(240, track, 1e-3, wave).heights, 1e-18);
}

#[test]
fn cells_larger_than_the_patch_have_the_mean_of_its_images() {
    // Each cell holds 10⅓ patches along and 4.25 across. The mean of n + f patches, f of which is the first (or last) part
    // of one, from the definition: the sum over as many pixels as lie in the cell.
    let (columns, rows) = (30, 16);
    let pitch = [1e-3 / 310.0, 1e-3 / 68.0];
    let pixels = Patch { column_pitch: pitch[0], row_pitch: pitch[1], ..patch(columns, rows, 1.0, rough) };
    let mesh = ring(40, 6, 5);
    for (body, count) in [(Body::Disc, 20), (Body::Pin, 5)] {
        let heights = tiled(&pixels, body, &mesh);
        for column in 0..count {
            for row in 0..6 {
                let mut sum = 0.0;
                for x in 310 * column..310 * (column + 1) {
                    // The middle of the track, 204 pixels from its edge, is the middle of the patch, 8 from its own.
                    for y in 68 * row..68 * (row + 1) {
                        sum += rough(mirrored(x as isize, columns), mirrored(y as isize - 196, rows));
                    }
                }
                let (found, expected) = (heights[column * 6 + row], sum / (310.0 * 68.0));
                assert!((found - expected).abs() < 1e-12 * 1e-6, "{body:?} {column} {row}: {found}, not {expected}");
            }
        }
    }
}

#[test]
fn a_patch_of_atoms_takes_no_longer_than_another() {
    // 10^9 and 10^297 images of the patch in a cell: the mean of the patch, up to rounding of one part in as many.
    for pitch in [1e-13, 1e-300] {
        let mesh = ring(100, 4, 10);
        let pixels = patch(10, 10, pitch, rough);
        let mean = pixels.heights.iter().sum::<f64>() / 100.0;
        for body in [Body::Disc, Body::Pin] {
            let heights = tiled(&pixels, body, &mesh);
            assert!(heights.iter().all(|height| (height - mean).abs() < 1e-13), "{pitch}: {mean} {:?}", &heights[..8]);
        }
    }
}

#[test]
fn cell_averages_are_what_the_body_gets() {
    // Of a patch as large as the pin the cells that lie in it whole are those of the pin.
    let mesh = ring(60, 5, 20);
    let pixels = patch(60, 25, 1e-3 / 3.0, rough);
    let pixels = Patch { row_pitch: 0.2e-3, ..pixels };
    let cells = pixels.cell_averages(&mesh).unwrap();
    assert_eq!((cells.columns, cells.rows), (20, 5));
    close(&cells.heights, &apply(Preparation::default(), RawHeights::Patch(pixels), Body::Pin, &mesh).unwrap(), 1e-20);
    assert!(patch(3, 3, 0.3e-3, rough).cell_averages(&mesh).is_none());
}

/// Patches at least as wide as the track have the bits that they had before narrower ones were tiled; the digests are of that
/// version.
#[test]
fn the_bits_of_wide_patches_are_known() {
    let mut all = Vec::new();
    for (columns, rows, pitch) in [(13, 20, 1e-3), (7, 9, 2.3e-3), (55, 81, 0.27e-3), (300, 60, 0.37e-3)] {
        for (ring_columns, track, pin) in [(130, 20, 9), (131, 17, 30)] {
            let mesh = ring(ring_columns, track, pin);
            let pixels = patch(columns, rows, pitch, rough);
            for body in [Body::Disc, Body::Pin] {
                all.extend(tiled(&pixels, body, &mesh));
            }
        }
    }
    assert_eq!(digest(&all), "ccaad3fd8b0e003d7b2a3e51e28cd25ca2e68fa22b790504a934d76d9574e39b");
}

#[test]
fn seams_are_where_a_repeated_patch_meets_its_image() {
    // A ring of 100 by 8 cells of 100 um, and a patch of 3 by 0.3 mm.
    let mean_radius = 10e-3 / std::f64::consts::TAU;
    let mesh = Mesh::new(8, 100, 10, mean_radius - 0.4e-3, mean_radius + 0.4e-3).unwrap();
    let patch = Patch { columns: 30, rows: 3, column_pitch: 1e-4, row_pitch: 1e-4, heights: vec![0.0; 90] };
    let [angles, radii] = patch.seams(true, &mesh);
    let near = |found: &[f64], expected: &[f64]| {
        found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9)
    };
    let turn = std::f64::consts::TAU;
    assert!(near(&angles, &[0.0, 0.3 * turn, 0.5 * turn, 0.7 * turn]), "{angles:?}");
    let beyond: Vec<f64> = radii.iter().map(|radius| radius - mesh.mean_radius()).collect();
    assert!(near(&beyond, &[-0.15e-3, 0.15e-3]), "{beyond:?}");
    // Laid once, it has one where the ring closes.
    assert_eq!(patch.seams(false, &mesh), [vec![0.0], vec![]]);
    // Heights differ across a seam and nowhere else from those of a patch that goes on: they are a mirror image there.
    let slope = Patch { heights: (0..90).map(|at| f64::from(at / 3)).collect(), ..patch };
    let heights = tiled(&slope, Body::Disc, &mesh);
    let turns = (0..100).filter(|column| {
        let [before, here, next] = [99, 0, 1].map(|more| heights[(column + more) % 100 * 8]);
        (here - before) * (next - here) < 1e-6
    });
    let at: Vec<usize> = turns.collect();
    // Two equal heights on both sides of each.
    assert_eq!(at, [0, 29, 30, 49, 50, 69, 70, 99]);
}
