//! Surfaces with the statistics of a patch, against the statistics of the surface from which the patch was cut.

use plateau_core::surface::describe::{Description, Grid};
use plateau_core::surface::{Body, HeightSynthesis, Patch, Preparation, RawHeights};

use super::{apply, patch, ring, rough};

/// So many columns and rows out of a synthetic ring whose correlation length is four cells.
fn cut_out(seed: u64, columns: usize, rows: usize) -> Patch {
    let mesh = ring(4 * columns, rows, 2);
    let heights = HeightSynthesis::gaussian(seed, 3e-6, 4e-3).field(Body::Disc, &mesh).unwrap();
    Patch { columns, rows, column_pitch: 1e-3, row_pitch: 1e-3, heights: heights[..columns * rows].to_vec() }
}

fn extended(pixels: Patch, seed: u64, body: Body, columns: usize, rows: usize) -> Vec<f64> {
    let preparation = Preparation { extend: Some(seed), ..Preparation::default() };
    apply(preparation, RawHeights::Patch(pixels), body, &ring(columns, rows, columns / 2)).unwrap()
}

/// Mean product of heights this many columns and rows apart over the variance, round the ring.
fn autocorrelation(heights: &[f64], rows: usize, [x, y]: [usize; 2]) -> f64 {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let columns = heights.len() / rows;
    let at = |column: usize, row: usize| heights[column % columns * rows + row] - mean;
    let places = || (0..columns).flat_map(|column| (0..rows - y).map(move |row| (column, row)));
    let product: f64 = places().map(|(column, row)| at(column, row) * at(column + x, row + y)).sum();
    let square: f64 = places().map(|(column, row)| at(column, row) * at(column, row)).sum();
    product / square
}

#[test]
fn texture_and_lay_are_those_of_the_surface_that_was_cut() {
    // Mean over twenty patches against exp(−(r/ℓ)²) with ℓ of four cells. A patch of 60 by 40 cells holds some 2400/Σρ² = 95
    // independent heights, so ρ of one is known to about 0.1, and the mean of twenty to 0.023; three times. The patch's mean is
    // taken out, which lowers ρ by Σρ/2400 = 0.02.
    let lags = [[1, 0], [0, 1], [2, 0], [0, 2], [4, 0], [0, 4], [3, 3], [8, 0], [0, 8]];
    let mut found = [0.0; 9];
    for seed in 0..20 {
        let heights = extended(cut_out(seed, 60, 40), seed, Body::Disc, 301, 50);
        for (sum, lag) in found.iter_mut().zip(lags) {
            *sum += autocorrelation(&heights, 50, lag) / 20.0;
        }
    }
    for (found, [x, y]) in found.iter().zip(lags) {
        let expected = (-((x * x + y * y) as f64) / 16.0).exp();
        assert!((found - expected).abs() < 0.09, "lag {x}, {y}: {found:.3}, expected {expected:.3}");
    }
}

#[test]
fn grooves_keep_their_direction() {
    // Grooves at 45 degrees: heights are alike along one diagonal and not along the other.
    let grooves = patch(48, 48, 1e-3, |column, row| (((column + row) as f64) * 0.9).sin() * 1e-6);
    let heights = extended(grooves, 3, Body::Disc, 200, 48);
    let [along, across] = [[2, 2], [3, 0]].map(|lag| autocorrelation(&heights, 48, lag));
    // cos(0.9 · 4) and cos(0.9 · 3) of the wave itself; a patch of seven waves tells the length of a wave to some per cent.
    assert!((along - (3.6_f64).cos()).abs() < 0.25, "{along}");
    assert!((across - (2.7_f64).cos()).abs() < 0.25, "{across}");
    let down: f64 = (0..199)
        .flat_map(|column| (1..48).map(move |row| (column, row)))
        .map(|(column, row)| heights[column * 48 + row] * heights[(column + 1) * 48 + row - 1])
        .sum();
    let square: f64 = heights.iter().map(|height| height * height).sum();
    assert!(down / square > 0.9, "one to the right and one down is the same groove: {}", down / square);
}

#[test]
fn the_heights_are_those_of_the_patch() {
    // Skewed heights: the Abbott-Firestone curve is the patch's to the resolution of its points.
    let mut pixels = cut_out(7, 80, 60);
    pixels.heights.iter_mut().for_each(|height| *height = -(-*height * 2e5).exp() * 1e-6);
    let heights = extended(pixels.clone(), 1, Body::Disc, 400, 60);
    let quantile = |heights: &[f64], part: f64| {
        let mut sorted = heights.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[(part * (sorted.len() - 1) as f64) as usize]
    };
    let span = quantile(&pixels.heights, 1.0) - quantile(&pixels.heights, 0.0);
    for part in [0.0, 0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0] {
        let (found, expected) = (quantile(&heights, part), quantile(&pixels.heights, part));
        assert!((found - expected).abs() < 0.005 * span, "{part}: {found}, expected {expected}");
    }
    let description = |heights: &[f64], columns: usize| {
        Description::of(&Grid { columns, rows: 60, pitch: Some([1e-3; 2]), heights }).unwrap()
    };
    let (made, cut) = (description(&heights, 400), description(&pixels.heights, 80));
    assert!((made.heights.skewness / cut.heights.skewness - 1.0).abs() < 0.02);
    // Slopes are not imposed; 4800/Σρ² = 190 independent heights.
    let slopes = made.gradient.unwrap().root_mean_square_slope / cut.gradient.unwrap().root_mean_square_slope;
    assert!((slopes - 1.0).abs() < 0.15, "{slopes}");
}

#[test]
fn seeds_and_bodies_differ_and_nothing_else_does() {
    let pixels = cut_out(2, 40, 30);
    let make = |seed, body| extended(pixels.clone(), seed, body, 120, 30);
    assert_eq!(make(4, Body::Disc), make(4, Body::Disc));
    assert_ne!(make(4, Body::Disc), make(5, Body::Disc));
    let (disc, pin) = (make(4, Body::Disc), make(4, Body::Pin));
    let product: f64 = disc.iter().zip(&pin).map(|(a, b)| a * b).sum();
    let square: f64 = pin.iter().map(|height| height * height).sum();
    // Two independent fields of 60 by 30 cells, 70 independent heights.
    assert!((product / square).abs() < 0.5, "{}", product / square);
}

#[test]
fn the_ring_closes_and_the_track_has_no_seam() {
    // The largest step of 40 000 normal differences is some 4.5 of their deviation; a step between unrelated heights would be
    // four times as large as those between neighbours.
    let heights = extended(cut_out(9, 60, 40), 0, Body::Disc, 400, 100);
    let next = heights[100..].iter().chain(&heights[..100]);
    let steps: Vec<f64> = heights.iter().zip(next).map(|(a, b)| (a - b).abs()).collect();
    let rms = (steps.iter().map(|step| step * step).sum::<f64>() / steps.len() as f64).sqrt();
    let at_end = &steps[399 * 100..];
    let of_end = (at_end.iter().map(|step| step * step).sum::<f64>() / 100.0).sqrt();
    assert!(of_end < 2.0 * rms, "{of_end}, elsewhere {rms}");
    assert!(steps.iter().all(|step| *step < 6.0 * rms));
}

#[test]
fn what_tells_no_statistics_is_refused_or_flat() {
    let few = Preparation { extend: Some(0), ..Preparation::default() };
    let error =
        few.apply(RawHeights::Patch(patch(30, 5, 1e-3, rough)), false, Body::Disc, &ring(100, 8, 20)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the patch covers 30 by 5 cells of 1 mm by 1 mm, and its statistics show in 8 by 8 at least: take smaller cells, or \
         measure a larger area"
    );
    let flat = extended(patch(30, 20, 1e-3, |_, _| 2e-6), 0, Body::Disc, 100, 8);
    assert!(flat.iter().all(|height| (height - 2e-6).abs() < 1e-20));
    let prepared = few.apply(RawHeights::Patch(cut_out(1, 12, 12)), false, Body::Disc, &ring(100, 8, 20)).unwrap();
    assert!(
        prepared.report.iter().any(|line| line.starts_with("warning: the patch holds about")),
        "{:?}",
        prepared.report
    );
}
