//! The S-filter and the L-filter against closed forms and the sum that defines them.

use std::f64::consts::{LN_2, PI};

use super::tiling::mirrored;
use super::*;

/// What is left of a wave of length λ behind a Gaussian filter of nesting index λc: exp(-π (α λc/λ)²), α² = ln 2/π.
fn transfer(nesting_index: f64, wavelength: f64) -> f64 {
    (-LN_2 * (nesting_index / wavelength) * (nesting_index / wavelength)).exp()
}

fn s_filter(nesting_index: f64) -> Preparation {
    Preparation { s_filter: Some(nesting_index), ..Preparation::default() }
}

fn l_filter(nesting_index: f64) -> Preparation {
    Preparation { l_filter: Some(nesting_index), ..Preparation::default() }
}

#[test]
fn waves_are_left_as_the_transfer_function_says() {
    // Waves with crest or trough at the edges continue themselves by reflection, those that close continue round the ring.
    // Of nesting indices of 10 pitches and more the points have the filter's transfer function to
    // exp(-ln 2 (10/1 - 10/2)²) = 3e-8 for waves of two pitches, and to 1e-16 for waves of more than four. Rounding of sums of
    // hundreds of weights.
    let (columns, rows, pitch) = (240, 60, 1e-3);
    let mesh = ring(columns, rows, columns);
    let along =
        |periods: f64, phase: f64| move |column: usize| (TAU * (periods * (column as f64 + 0.5) / 240.0 + phase)).cos();
    for (body, periods, phase, half_periods, nesting_index) in [
        (Body::Pin, 6.0, 0.0, 0, 40e-3),
        (Body::Disc, 6.0, 0.3, 0, 40e-3),
        (Body::Pin, 0.0, 0.0, 6, 20e-3),
        (Body::Disc, 0.0, 0.0, 6, 20e-3),
        (Body::Pin, 1.5, 0.0, 1, 10e-3),
        (Body::Pin, 4.5, 0.5, 5, 25e-3),
        (Body::Disc, 7.0, 0.1, 5, 12.3e-3),
        (Body::Disc, 1.0, 0.7, 3, 60e-3),
        (Body::Pin, 20.0, 0.0, 0, 60e-3),
    ] {
        let wave = along(periods, phase);
        let height = |column: usize, row: usize| {
            let across = (PI * f64::from(half_periods) * (row as f64 + 0.5) / 60.0).cos();
            1e-6 * wave(column) * across
        };
        let heights = patch(columns, rows, pitch, height).heights;
        // The wave vectors along and across add up by their squares.
        let along = if periods == 0.0 { 1.0 } else { transfer(nesting_index, 240e-3 / periods) };
        let across = if half_periods == 0 { 1.0 } else { transfer(nesting_index, 120e-3 / f64::from(half_periods)) };
        let left = along * across;
        let long: Vec<f64> = heights.iter().map(|height| left * height).collect();
        let raw = || RawHeights::OnMesh(heights.clone());
        close(&apply(s_filter(nesting_index), raw(), body, &mesh).unwrap(), &long, 1e-20);
        let short: Vec<f64> = heights.iter().zip(&long).map(|(height, long)| height - long).collect();
        close(&apply(l_filter(nesting_index), raw(), body, &mesh).unwrap(), &short, 1e-20);
    }
    // A wave of the nesting index is left by half.
    assert!((transfer(0.8e-3, 0.8e-3) - 0.5).abs() < 1e-16);
}

#[test]
fn heights_are_the_means_that_define_the_filter() {
    // Σ w z / Σ w over the plane that is continued by its mirror images, w = exp(-π r²/(αλ)²) of the distance r in two
    // dimensions at once, out to where w is 1e-20; the chain leaves out what is below 1e-16, and of heights of 1 um rounds
    // hundreds of terms.
    let (rows, disc_columns) = (9, 60);
    for (body, columns) in [(Body::Pin, 12), (Body::Disc, disc_columns)] {
        let mesh = Mesh::new(rows, disc_columns, columns, 20e-3, 33.5e-3).unwrap();
        let pitches = [mesh.column_width(), mesh.row_height()];
        assert!(pitches[0] / pitches[1] > 1.8);
        let heights = patch(columns, rows, 1.0, rough).heights;
        let closed = body == Body::Disc;
        let shortest = 2.0 * pitches[0];
        let longest = (rows as f64 * pitches[1]).min(columns as f64 * pitches[0]);
        for nesting_index in [shortest, longest] {
            let found = apply(s_filter(nesting_index), RawHeights::OnMesh(heights.clone()), body, &mesh).unwrap();
            let reach = |pitch: f64| (1.85 * nesting_index / pitch) as isize + 1;
            for (index, found) in found.iter().enumerate() {
                let (mut sum, mut weights) = (0.0, 0.0);
                for dx in -reach(pitches[0])..=reach(pitches[0]) {
                    for dy in -reach(pitches[1])..=reach(pitches[1]) {
                        let squared = (dx as f64 * pitches[0]).powi(2) + (dy as f64 * pitches[1]).powi(2);
                        let weight = (-PI * squared * PI / (LN_2 * nesting_index * nesting_index)).exp();
                        let column = (index / rows) as isize + dx;
                        let column = if closed {
                            column.rem_euclid(columns as isize) as usize
                        } else {
                            mirrored(column, columns)
                        };
                        sum += weight * heights[column * rows + mirrored((index % rows) as isize + dy, rows)];
                        weights += weight;
                    }
                }
                assert!((found - sum / weights).abs() < 1e-20, "{index}: {found} {}", sum / weights);
            }
        }
    }
}

#[test]
fn the_mean_stays_and_a_patch_is_filtered_before_it_is_tiled() {
    // The mirror images keep the mean: to rounding of sums of 2400 heights of 1 um.
    let pixels = patch(60, 40, 1e-3, rough);
    let mesh = ring(240, 40, 60);
    let mean = |heights: &[f64]| heights.iter().sum::<f64>() / heights.len() as f64;
    for nesting_index in [2e-3, 3.3e-3, 17e-3, 40e-3] {
        let raw = || RawHeights::Patch(pixels.clone());
        let long = apply(s_filter(nesting_index), raw(), Body::Pin, &mesh).unwrap();
        assert!((mean(&long) - mean(&pixels.heights)).abs() < 1e-20, "{nesting_index}");
        let short = apply(l_filter(nesting_index), raw(), Body::Pin, &mesh).unwrap();
        assert!(mean(&short).abs() < 1e-20, "{nesting_index}");
        // The ring tiled with mirror images of the patch and then filtered is the filtered patch tiled. The ring folds about its
        // middle, 120 mm, where two patches end.
        let tiled = Preparation { repeat: true, ..s_filter(nesting_index) };
        let first = apply(tiled, raw(), Body::Disc, &mesh).unwrap();
        let ring = apply(Preparation { repeat: true, ..Preparation::default() }, raw(), Body::Disc, &mesh).unwrap();
        let then = apply(s_filter(nesting_index), RawHeights::OnMesh(ring), Body::Disc, &mesh).unwrap();
        close(&first, &then, 1e-19);
    }
}

#[test]
fn both_filters_follow_each_other_behind_the_filling() {
    let pixels = patch(60, 40, 1e-3, rough);
    let mesh = ring(240, 40, 60);
    let on_mesh = |heights: &[f64]| RawHeights::OnMesh(heights.to_vec());
    let s = apply(s_filter(4e-3), on_mesh(&pixels.heights), Body::Pin, &mesh).unwrap();
    let l = apply(l_filter(20e-3), on_mesh(&s), Body::Pin, &mesh).unwrap();
    let both = Preparation { l_filter: Some(20e-3), ..s_filter(4e-3) };
    let prepared = both.apply(on_mesh(&pixels.heights), false, Body::Pin, &mesh).unwrap();
    assert_eq!(prepared.heights, l);
    let says = "S-filter: waves shorter than 4 mm taken out by an areal Gaussian filter, mirrored at the edges: rms ";
    assert!(prepared.report[0].starts_with(says), "{:?}", prepared.report);
    assert!(prepared.report[1].starts_with("L-filter: waves longer than 20 mm taken out"), "{:?}", prepared.report);
    // Missing points are filled first, else refused first.
    let mut holed = pixels;
    holed.heights[77] = f64::NAN;
    let refused = apply(both, on_mesh(&holed.heights), Body::Pin, &mesh).unwrap_err();
    assert!(matches!(refused, PreparationError::Missing { .. }), "{refused}");
    let filling = Preparation { fill: Some(Fill::Interpolate), ..Preparation::default() };
    let filled = apply(filling, on_mesh(&holed.heights), Body::Pin, &mesh).unwrap();
    let at_once = Preparation { fill: Some(Fill::Interpolate), ..both };
    let found = apply(at_once, on_mesh(&holed.heights), Body::Pin, &mesh).unwrap();
    assert_eq!(found, apply(both, on_mesh(&filled), Body::Pin, &mesh).unwrap());
}

#[test]
fn nesting_indices_that_the_patch_cannot_carry_are_refused() {
    let pixels = || RawHeights::Patch(patch(60, 40, 1e-3, rough));
    let mesh = ring(240, 40, 60);
    let error = |preparation: Preparation| apply(preparation, pixels(), Body::Pin, &mesh).unwrap_err().to_string();
    let bounds = "expected at least two pixels, 2 mm, and at most the shorter side of the heights, 40 mm";
    assert_eq!(error(s_filter(1.9e-3)), format!("s_filter is 1.9 mm, {bounds}"));
    assert_eq!(error(l_filter(41e-3)), format!("l_filter is 41 mm, {bounds}"));
    let crossed = Preparation { l_filter: Some(5e-3), ..s_filter(5e-3) };
    assert_eq!(
        error(crossed),
        "s_filter is 5 mm, l_filter 5 mm: waves between the two are kept, so s_filter is to be the shorter one"
    );
    for wrong in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        assert!(error(s_filter(wrong)).starts_with("s_filter is "));
        assert!(error(l_filter(wrong)).starts_with("l_filter is "));
    }
    // The pitch that counts is that of the key before.
    let finer = Preparation { pixel: Some(0.5e-3), ..s_filter(1.9e-3) };
    assert!(apply(finer, pixels(), Body::Pin, &ring(480, 4, 6)).is_ok());
}
