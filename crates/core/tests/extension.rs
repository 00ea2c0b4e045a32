//! Heights with the statistics of a patch: their distribution, autocorrelation, lay, seeds and bits.

use std::f64::consts::{PI, TAU};

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{
    Body, Extension, HeightSynthesis, Level, Patch, Preparation, PreparationError, RawHeights, Texture,
};

use crate::preparation::ring;
use crate::synthesis_bits::digest;

fn statistics(seed: u64) -> Preparation {
    Preparation { level: Level::Plane, extend: Some(Extension::Statistics { seed }), ..Preparation::default() }
}

/// A Gaussian field with the autocorrelation exp(−(x/ℓx)² − (y/ℓy)²), ℓ in cells, cut to a patch.
fn gaussian_patch(columns: usize, rows: usize, lengths: [f64; 2], seed: u64) -> Patch {
    let mesh = ring(8 * columns.max(rows), rows, columns);
    let cell = mesh.column_width();
    let texture = Texture::Correlation { along: lengths[0] * cell, across: lengths[1] * cell };
    let synthesis = HeightSynthesis { texture, ..HeightSynthesis::gaussian(seed, 1e-6, cell) };
    let heights = synthesis.field(Body::Pin, &mesh).unwrap();
    Patch { columns, rows, column_pitch: 1e-3, row_pitch: 1e-3, heights }
}

fn extended(preparation: Preparation, patch: &Patch, body: Body, mesh: &Mesh) -> Vec<f64> {
    preparation.apply(RawHeights::Patch(patch.clone()), false, body, mesh).unwrap().heights
}

/// ⟨h(column, row) h(column + lag.0, row + lag.1)⟩ over ⟨h²⟩, round the ring.
fn correlation(heights: &[f64], rows: usize, lag: (usize, isize)) -> f64 {
    let columns = heights.len() / rows;
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let at = |column: usize, row: usize| heights[column % columns * rows + row] - mean;
    let (mut sum, mut count, mut squares) = (0.0, 0.0, 0.0);
    for column in 0..columns {
        for row in 0..rows {
            squares += at(column, row) * at(column, row);
            if let Some(other) = row.checked_add_signed(lag.1).filter(|other| *other < rows) {
                sum += at(column, row) * at(column + lag.0, other);
                count += 1.0;
            }
        }
    }
    sum / count / (squares / heights.len() as f64)
}

/// Over patches of one population: the autocorrelation of the extended rings has the mean of that of the population.
///
/// A patch of N = n_x n_y cells gives the autocorrelation at a lag, of normal heights and ρ = exp(−(r/ℓ)²), with the variance
/// at most 2 Σρ²/N (Bartlett), Σρ² = πℓ²/2 cells, and 1.5625 times as much for the two sine tapers in either direction
/// (mean of the square of the mean square taper, 1.25 each); the ring adds 2 Σρ²/N of its own. Three biases: tapers multiply
/// ρ by 1 − π²/2 · (1 + 4)/2 · (τ/n)² at the lag τ along n cells; half of the products of tapers are symmetric or not
/// as the mean is, so taking it out of all costs no more than 4 Σρ/N, and so does the plane; Σρ = πℓ².
#[test]
fn the_autocorrelation_of_a_gaussian_field_is_kept() {
    const SEEDS: u64 = 12;
    let (length, size) = (2.5, 64);
    let mesh = ring(256, 48, 10);
    let lags = [(1, 0), (2, 0), (3, 0), (5, 0), (0, 1), (0, 2), (0, 4), (2, 2), (1, -2), (9, 0)];
    let mut means = [0.0; 10];
    for seed in 0..SEEDS {
        let patch = gaussian_patch(size, size, [length; 2], seed);
        let heights = extended(statistics(seed), &patch, Body::Disc, &mesh);
        for (mean, lag) in means.iter_mut().zip(lags) {
            *mean += correlation(&heights, mesh.rows(), lag) / SEEDS as f64;
        }
    }
    let (points, cells) = ((size * size) as f64, (256 * 48) as f64);
    let squares = 0.5 * PI * length * length;
    let error = (2.0 * squares * (1.5625 / points + 1.0 / cells) / SEEDS as f64).sqrt();
    for (found, (x, y)) in means.iter().zip(lags) {
        let square = (x * x) as f64 + (y * y) as f64;
        let expected = (-square / (length * length)).exp();
        let bias = 0.5 * PI * PI * 2.5 * square / points * expected + 8.0 * 2.0 * squares / points;
        println!("({x}, {y}): {found:.4}, expected {expected:.4} ± {error:.4}, bias up to {bias:.4}");
        assert!((found - expected).abs() < 4.0 * error + bias, "({x}, {y}): {found}, not {expected}");
    }
}

/// The heights are those of the patch: its quantiles at (r + ½)/N.
#[test]
fn the_distribution_is_that_of_the_patch() {
    let mut patch = gaussian_patch(40, 30, [3.0, 2.0], 3);
    // Far from normal: plateaus with deep valleys.
    patch.heights.iter_mut().for_each(|height| *height = (*height * 3.0).min(0.4e-6));
    let preparation = Preparation { level: Level::Quadratic, ..statistics(1) };
    let levelled = Preparation { extend: None, ..preparation };
    let mesh = ring(200, 24, 20);
    // On a mesh of its own size the levelled patch comes through point by point.
    let own = ring(400, 30, 40);
    let mut expected = extended(levelled, &patch, Body::Pin, &own);
    expected.sort_by(f64::total_cmp);
    let quantile = |p: f64| {
        let place = (p * 1200.0 - 0.5).clamp(0.0, 1199.0);
        let below = place.floor() as usize;
        expected[below] + place.fract() * (expected[(below + 1).min(1199)] - expected[below])
    };
    for (body, cells) in [(Body::Disc, 4800), (Body::Pin, 480)] {
        let mut found = extended(preparation, &patch, body, &mesh);
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), cells);
        for (rank, height) in found.iter().enumerate() {
            let quantile = quantile((rank as f64 + 0.5) / cells as f64);
            assert!((height - quantile).abs() < 1e-16, "rank {rank}: {height}, expected {quantile}");
        }
    }
}

/// Waves of which the crests lie at an angle: the lay stays, with its sign.
#[test]
fn a_lay_at_an_angle_stays_at_its_angle() {
    let patch = gaussian_patch(120, 60, [2.0, 2.0], 8);
    // Sheared: h(x, y) = g(x − y, y) with the autocorrelation exp(−((x − y)² + y²)/4).
    let heights = (0..3600).map(|index| patch.heights[(60 + index / 60 - index % 60) * 60 + index % 60]).collect();
    let sheared = Patch { columns: 60, heights, ..patch };
    let mesh = ring(300, 40, 10);
    let heights = extended(statistics(4), &sheared, Body::Disc, &mesh);
    // Variance of a correlation: 2 Σρ² (1.5625/3600 + 1/12000), Σρ² = 2π; then 0.08.
    let (with, against) = (correlation(&heights, 40, (2, 2)), correlation(&heights, 40, (2, -2)));
    let (expected, opposite) = ((-1.0_f64).exp(), (-5.0_f64).exp());
    assert!((with - expected).abs() < 4.0 * 0.08 && with > 0.2, "{with}, expected {expected}");
    assert!((against - opposite).abs() < 4.0 * 0.08 && against < 0.2, "{against}, expected {opposite}");
}

#[test]
fn seeds_and_bodies_are_unrelated_and_the_ring_closes() {
    let patch = gaussian_patch(40, 40, [2.0, 2.0], 5);
    let mesh = ring(300, 32, 300);
    let first = extended(statistics(1), &patch, Body::Disc, &mesh);
    let related = |other: &[f64]| {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let (a, b) = (mean(&first), mean(other));
        let product: f64 = first.iter().zip(other).map(|(x, y)| (x - a) * (y - b)).sum();
        let square = |values: &[f64], mean: f64| values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
        product / (square(&first, a) * square(other, b)).sqrt()
    };
    // The correlation of two fields of N cells has the variance Σρ²/N, Σρ² = 2π.
    let error = (TAU / 9600.0_f64).sqrt();
    assert_eq!(related(&extended(statistics(1), &patch, Body::Disc, &mesh)), related(&first));
    for other in [extended(statistics(2), &patch, Body::Disc, &mesh), extended(statistics(1), &patch, Body::Pin, &mesh)]
    {
        assert!(related(&other).abs() < 5.0 * error, "{} ± {error}", related(&other));
    }
    // Where the ring closes, heights of neighbours are related as elsewhere: 1 − ρ(1) = 0.22 of the mean square, of 32 rows
    // some eight of which are independent.
    let step = |from: usize, to: usize| {
        let difference = |row: usize| first[from * 32 + row] - first[to * 32 + row];
        (0..32).map(|row| difference(row) * difference(row)).sum::<f64>() / 32.0
    };
    let usual = (0..299).map(|column| step(column, column + 1)).sum::<f64>() / 299.0;
    assert!(step(299, 0) < 4.0 * usual, "{} {usual}", step(299, 0));
}

#[test]
fn a_tilt_is_no_roughness() {
    let flat = gaussian_patch(40, 40, [2.0, 2.0], 6);
    let mut tilted = flat.clone();
    tilted.heights.iter_mut().enumerate().for_each(|(index, height)| *height += 1e-3 + 1e-6 * (index / 40) as f64);
    let mesh = ring(100, 20, 10);
    let preparation = Preparation { level: Level::None, ..statistics(1) };
    let raw = |patch: &Patch| preparation.apply(RawHeights::Patch(patch.clone()), false, Body::Disc, &mesh).unwrap();
    let prepared = raw(&tilted);
    assert!(prepared.report[0].contains("least-squares plane was taken out"), "{:?}", prepared.report);
    let [mean, rms] = moments(&prepared.heights);
    // The mean height stays: 1 mm and half of the tilt over 39 columns; the rms is that of the patch without the tilt, of
    // which quantiles in between leave out a part of the tails, 1/N of the mean square or so.
    assert!((mean - 1e-3 - 19.5e-6).abs() < 1e-8, "{mean}");
    assert!((rms / 1e-6 - 1.0).abs() < 0.02, "{rms}");
    let levelled = extended(statistics(1), &tilted, Body::Disc, &mesh);
    for (with, without) in prepared.heights.iter().zip(&levelled) {
        assert!((with - mean - without).abs() < 1e-11, "{with} {without}");
    }
}

fn moments(heights: &[f64]) -> [f64; 2] {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let square = heights.iter().map(|height| (height - mean) * (height - mean)).sum::<f64>() / heights.len() as f64;
    [mean, square.sqrt()]
}

#[test]
fn what_a_patch_cannot_tell_is_said() {
    let mesh = ring(200, 30, 20);
    let report = |patch: &Patch, body| {
        let prepared = statistics(1).apply(RawHeights::Patch(patch.clone()), false, body, &mesh).unwrap();
        let mut lines = prepared.report;
        lines.retain(|line| line.starts_with("warning: ") || line.starts_with("waves"));
        lines
    };
    let large = gaussian_patch(200, 60, [1.5; 2], 1);
    assert_eq!(report(&large, Body::Pin), [""; 0]);
    let small = gaussian_patch(60, 20, [1.5, 1.5], 1);
    let warnings = report(&small, Body::Disc);
    // ρ falls to 0.2 at ℓ √(ln 5) = 1.9 cells: 32 of them along, about 10.5 across.
    assert!(warnings[0].contains("waves longer than the patch, 60 mm along and 20 mm across sliding"), "{warnings:?}");
    // Of a wave as long as the patch, lowest in its middle, the tapers take out the mean -1/2 and 0: a quarter and none of its mean square
    // 1/2. Of short waves they take out hardly any.
    let wave = |length: f64| {
        let height = |point: usize| 1e-6 * (std::f64::consts::TAU * (point / 20) as f64 / length).cos();
        Patch { heights: (0..1200).map(height).collect(), ..small.clone() }
    };
    for (length, is_warning) in [(60.0, true), (6.0, false)] {
        let lines = report(&wave(length), Body::Disc);
        let line = lines.iter().find(|line| line.contains("waves longer than the patch")).unwrap();
        assert_eq!(line.starts_with("warning: "), is_warning, "{lines:?}");
    }
    let short = report(&gaussian_patch(60, 20, [10.0, 1.0], 1), Body::Disc);
    assert!(short.iter().any(|line| line.contains("along sliding, the patch is only")), "{short:?}");
    let lay = Patch { heights: (0..1200).map(|n| ((n / 20 * 7) % 11) as f64 * 1e-6).collect(), ..small };
    let warnings = report(&lay, Body::Disc);
    assert!(
        warnings.iter().any(|line| line.contains("across sliding, heights are related over a third of the patch")),
        "{warnings:?}"
    );
}

#[test]
fn what_has_no_statistics_is_refused_or_flat() {
    let mesh = ring(100, 20, 10);
    let apply = |columns: usize, rows: usize, pitch: f64, heights: Vec<f64>| {
        let patch = Patch { columns, rows, column_pitch: pitch, row_pitch: pitch, heights };
        statistics(1).apply(RawHeights::Patch(patch), false, Body::Disc, &mesh)
    };
    let few = apply(30, 3, 1e-3, vec![0.0; 90]).unwrap_err();
    assert!(matches!(few, PreparationError::FewCells { cells: [30, 3], least: 4, .. }), "{few:?}");
    assert!(
        few.to_string().contains("30 by 3 whole cells lie in the patch of 30 mm by 3 mm, expected at least 4 by 4"),
        "{few}"
    );
    for pitch in [1.0, 1e3, 1e300] {
        let heights = (0..100).map(|n| f64::from(n % 7)).collect();
        assert!(matches!(apply(10, 10, pitch, heights), Err(PreparationError::LargeField { .. })), "{pitch}");
    }
    assert!(apply(10, 10, 1e-3, vec![2.5; 100]).unwrap().heights.iter().all(|height| *height == 0.0));
    // Heights that are on the mesh are there already.
    let heights: Vec<f64> = (0..2000).map(|n| f64::from(n % 13)).collect();
    let kept = Preparation { level: Level::None, ..statistics(1) };
    let kept = kept.apply(RawHeights::OnMesh(heights.clone()), false, Body::Disc, &mesh).unwrap();
    assert_eq!(kept.heights, heights);
    assert!(kept.patch.is_none());
}

/// A patch that is longer and wider than the body gives its statistics, too.
#[test]
fn a_patch_may_be_larger_than_the_body() {
    let patch = gaussian_patch(120, 90, [3.0; 2], 2);
    let mesh = ring(60, 16, 10);
    let heights = extended(statistics(3), &patch, Body::Disc, &mesh);
    // The heights have their ranks in the patch, so that the rms is that of the patch but for the tails between quantiles.
    let [mean, rms] = moments(&heights);
    assert!(mean.abs() < 1e-8 && (rms / 1e-6 - 1.0).abs() < 0.05, "{mean} {rms}");
    assert!((correlation(&heights, 16, (1, 0)) - (-1.0_f64 / 9.0).exp()).abs() < 0.1);
}

/// The same bits on every machine; whether they are right is for the other tests.
#[test]
fn the_bits_of_extended_patches_are_known() {
    let mut patch = gaussian_patch(30, 24, [2.0, 1.0], 7);
    patch.heights.iter_mut().for_each(|height| *height -= 3e5 * *height * *height);
    let mesh = ring(100, 24, 30);
    for (body, expected) in [
        (Body::Disc, "fda70825bdefe014b741607897ff8eaa0be142482382ab7d345b5aed6629ad34"),
        (Body::Pin, "39bf040ccb0454a33a7892189a63c02980322608ec78f09050e9a76d35269eee"),
    ] {
        let heights = extended(statistics(9), &patch, body, &mesh);
        assert_eq!(heights, extended(statistics(9), &patch, body, &mesh));
        assert_eq!(digest(&heights), expected, "{body:?}");
    }
}

/// The mean of ρ = exp(−(r/ℓ)²) over the distances of the points of two cells `lag` apart, in one direction; cells and
/// lags in ℓ. Simpson's rule, whose error at 2000 intervals is below 1e-12.
fn cell_correlation(lag: f64, cell: f64) -> f64 {
    let rho = |t: f64| (1.0 - t.abs()) * (-(lag + cell * t).powi(2)).exp();
    let half = |sign: f64| -> f64 {
        let value = |k: u32| rho(sign * f64::from(k) / 2000.0) * [2.0, 4.0][(k % 2) as usize];
        ((0..=2000).map(value).sum::<f64>() - rho(0.0) - rho(sign)) / 6000.0
    };
    half(1.0) + half(-1.0)
}

/// Profiles of one population of surfaces without a direction: rings have the population's rms height and autocorrelation,
/// averaged over cells, in every direction.
///
/// The line of n points has 2 Σρ² /n of relative variance of the autocovariance at any lag at most (Bartlett), with
/// Σρ² = √(π/2) ℓ points; the ring its own, 2 Σρ²/N over cells. Where the line tells no autocovariance from none, below
/// 2 √(Σρ²/n), it is damped, so at most that is missing.
#[test]
fn a_profile_gives_a_surface_without_a_direction() {
    const SEEDS: u64 = 8;
    let (points, fine, length) = (16_384, 0.25, 2.5);
    let mesh = ring(256, 48, 10);
    let line_mesh = ring(points, 1, 10);
    let width = line_mesh.column_width();
    let lags = [(1, 0), (2, 0), (4, 0), (0, 1), (0, 2), (0, 4), (2, 2), (2, -2)];
    let (mut means, mut square) = ([0.0; 8], 0.0);
    for seed in 0..SEEDS {
        let along = length / fine * width;
        let texture = Texture::Correlation { along, across: along };
        let synthesis = HeightSynthesis { texture, ..HeightSynthesis::gaussian(seed, 1e-6, along) };
        let heights = synthesis.field(Body::Disc, &line_mesh).unwrap();
        let line = Patch { columns: points, rows: 1, column_pitch: fine * 1e-3, row_pitch: fine * 1e-3, heights };
        let preparation = Preparation { extend: Some(Extension::Isotropic { seed }), ..Preparation::default() };
        let heights = extended(preparation, &line, Body::Disc, &mesh);
        square += heights.iter().map(|height| height * height).sum::<f64>() / heights.len() as f64 / SEEDS as f64;
        for (mean, lag) in means.iter_mut().zip(lags) {
            *mean += correlation(&heights, mesh.rows(), lag) / SEEDS as f64;
        }
    }
    let related = (PI / 2.0).sqrt() * length / fine / points as f64;
    let cells = (256 * 48) as f64;
    let error = (2.0 * (related + 0.5 * PI * length * length / cells) / SEEDS as f64).sqrt();
    let damped = 2.0 * related.sqrt();
    let of_cells = |x: usize, y: isize| {
        [x as f64, y as f64].map(|lag| cell_correlation(lag / length, 1.0 / length)).iter().product::<f64>()
    };
    let variance = 1e-12 * of_cells(0, 0);
    assert!((square / variance - 1.0).abs() < 4.0 * error + damped * damped, "{}", square / variance);
    for (found, (x, y)) in means.iter().zip(lags) {
        let expected = of_cells(x, y) / of_cells(0, 0);
        assert!((found - expected).abs() < 4.0 * error + damped, "({x}, {y}): {found}, expected {expected} ± {error}");
    }
}

#[test]
fn a_profile_that_is_short_is_told() {
    let mesh = ring(256, 48, 10);
    let wave = |count: usize| -> Vec<f64> { (0..count).map(|point| (0.3 * point as f64).sin()).collect() };
    let line =
        |count: usize| Patch { columns: count, rows: 1, column_pitch: 1e-4, row_pitch: 1e-4, heights: wave(count) };
    let preparation = Preparation { extend: Some(Extension::Isotropic { seed: 1 }), ..Preparation::default() };
    let prepared = preparation.apply(RawHeights::Patch(line(100)), false, Body::Disc, &mesh).unwrap();
    // A wave is related over all of its length: half of it is looked at, and as much again falls to zero.
    assert!(prepared.report.iter().any(|step| step.starts_with("warning: heights of the profile are related over")));
    let refused = preparation.apply(RawHeights::Patch(line(39)), false, Body::Disc, &mesh).unwrap_err();
    assert!(matches!(refused, PreparationError::FewCells { cells: [3, 3], least: 4, .. }), "{refused:?}");
}
