//! Synthetic heights against the closed form of their autocorrelation.

use std::f64::consts::{PI, TAU};

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{Body, HeightSynthesis, SynthesisError, Texture};

/// Ring of mean radius 1 whose cells are as wide as 2π/columns and as high as that times `aspect`.
pub(crate) fn ring(columns: usize, rows: usize, pin_columns: usize, aspect: f64) -> Mesh {
    let half = 0.5 * rows as f64 * aspect * TAU / columns as f64;
    Mesh::new(rows, columns, pin_columns, 1.0 - half, 1.0 + half).unwrap()
}

fn synthesis(seed: u64, correlation_length: f64) -> HeightSynthesis {
    HeightSynthesis::gaussian(seed, 1.0, correlation_length)
}

/// Mean over the field of h(column, row) h(column + columns, row + rows); round the ring if it closes.
pub(crate) fn correlation(field: &[f64], rows: usize, lag: (usize, usize), closed: bool) -> f64 {
    let columns = field.len() / rows;
    let (mut sum, mut count) = (0.0, 0.0);
    for column in 0..if closed { columns } else { columns - lag.0 } {
        for row in 0..rows - lag.1 {
            sum += field[column * rows + row] * field[(column + lag.0) % columns * rows + row + lag.1];
            count += 1.0;
        }
    }
    sum / count
}

/// The mean over 20 seeds must be exp(−(x/ℓx)² − (y/ℓy)²).
///
/// Error of one field of N cells: Bartlett's variance Σ (C² + C(ρ+τ)C(ρ−τ))/N ≤ 2 Σ C²/N, in which Σ C² over the cells
/// is π (ℓx ℓy)/2 in cells for long ℓ and at least 1; taking out the mean lowers C by Σ C/N = π ℓx ℓy/N. The bound holds
/// 4 standard errors of the mean over the seeds, for a third of the cells at the largest lag.
fn check_autocorrelation(body: Body, mesh: &Mesh, along: f64, across: f64) {
    let (width, height) = (mesh.column_width(), mesh.row_height());
    let cells = (body.columns(mesh) * mesh.rows()) as f64;
    let patch = PI * along * across / (width * height);
    let seeds = 20;
    let lags = [(0, 0), (1, 0), (2, 0), (4, 0), (0, 1), (0, 2), (0, 4), (2, 2), (3, 1), (12, 0), (0, 12)];
    let mut means = [0.0; 11];
    for seed in 0..seeds {
        let settings = HeightSynthesis { texture: Texture::Correlation { along, across }, ..synthesis(seed, along) };
        let field = settings.field(body, mesh).unwrap();
        for (mean, lag) in means.iter_mut().zip(lags) {
            *mean += correlation(&field, mesh.rows(), lag, body == Body::Disc) / seeds as f64;
        }
    }
    let error = (patch.max(2.0) / (cells / 3.0) / seeds as f64).sqrt();
    for (mean, (columns, rows)) in means.iter().zip(lags) {
        let (x, y) = (columns as f64 * width, rows as f64 * height);
        let expected = (-(x * x) / (along * along) - (y * y) / (across * across)).exp();
        let tolerance = 4.0 * error + patch / cells;
        assert!(
            (mean - expected).abs() < tolerance,
            "{body:?}, {along} by {across}, lag ({columns}, {rows}): {mean}, expected {expected} ± {tolerance}"
        );
    }
}

#[test]
fn the_autocorrelation_is_that_asked_for() {
    // Correlation lengths are in columns.
    for (body, mesh, along, across) in [
        (Body::Disc, ring(1000, 128, 10, 0.8), 3.0, 3.0),
        (Body::Pin, ring(2000, 128, 500, 1.25), 3.0, 3.0),
        // Ground along the sliding direction on the disc, across it on the pin.
        (Body::Disc, ring(2000, 128, 500, 1.0), 8.0, 2.0),
        (Body::Pin, ring(2000, 128, 500, 1.0), 1.5, 6.0),
        // Of one cell and below.
        (Body::Disc, ring(1000, 128, 10, 1.0), 1.0, 1.0),
        (Body::Disc, ring(1000, 128, 10, 1.0), 0.7, 0.7),
        (Body::Disc, ring(1000, 128, 10, 1.0), 0.5, 0.5),
    ] {
        let width = mesh.column_width();
        check_autocorrelation(body, &mesh, along * width, across * width);
    }
}

#[test]
fn mean_and_rms_height_are_realised() {
    // Sums of N numbers of size σ round to N ε σ at most.
    let mesh = ring(691, 33, 40, 0.5);
    for body in [Body::Disc, Body::Pin] {
        for length in [0.02, 1e-12, TAU] {
            let field = HeightSynthesis { rms_height: 3e-6, ..synthesis(5, length) }.field(body, &mesh).unwrap();
            let count = field.len() as f64;
            let mean = field.iter().sum::<f64>() / count;
            let rms = (field.iter().map(|h| h * h).sum::<f64>() / count).sqrt();
            assert!(mean.abs() < count * f64::EPSILON * 3e-6, "{mean}");
            assert!((rms / 3e-6 - 1.0).abs() < count * f64::EPSILON, "{rms}");
        }
    }
}

#[test]
fn the_ring_closes_like_any_other_pair_of_columns() {
    // Mean square step 2 (1 − C(Δx)); one column of the field has about rows Δr/(√(π/2) ℓ) independent parts, the mean
    // square of n of them the relative standard error √(2/n). A seam would give 2.
    let mesh = ring(256, 64, 10, 1.0);
    let (rows, length, seeds) = (64, 3.0 * mesh.column_width(), 60);
    let mut step = 0.0;
    for seed in 0..seeds {
        let field = synthesis(seed, length).field(Body::Disc, &mesh).unwrap();
        let (first, last) = (&field[..rows], &field[255 * rows..]);
        step += first.iter().zip(last).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / (seeds * rows as u64) as f64;
    }
    let expected = 2.0 * (1.0 - (-1.0_f64 / 9.0).exp());
    let parts = seeds as f64 * rows as f64 / (3.0 * (PI / 2.0).sqrt());
    assert!((step / expected - 1.0).abs() < 5.0 * (2.0 / parts).sqrt(), "{step}, expected {expected}");
}

#[test]
fn a_patch_repeats_round_the_ring() {
    let mesh = ring(1200, 20, 10, 1.0);
    let (rows, repeat) = (20, 100);
    // 12.3 repeats are asked for; the nearest whole number is 12, so every 100 columns.
    let settings = HeightSynthesis { patch: Some(TAU / 12.3), ..synthesis(1, 0.03) };
    let with_moments = HeightSynthesis { skewness: -1.0, kurtosis: 5.0, ..settings };
    // Rounding of a transform of 1200 points, some ε times its 10 stages; the tail of the distribution steepens it.
    for (settings, rounding) in [(settings, 1e-12), (with_moments, 1e-11)] {
        let field = settings.field(Body::Disc, &mesh).unwrap();
        let repeats = |period: usize| {
            let shifted = field[period * rows..].iter().chain(&field);
            field.iter().zip(shifted).all(|(a, b)| (a - b).abs() < rounding)
        };
        assert!(repeats(repeat), "{settings:?}");
        assert!(!repeats(repeat / 2) && !repeats(repeat / 5), "{settings:?}");
    }
    // As long as the ring or longer: no repeat, the same field as without.
    let whole = HeightSynthesis { patch: Some(100.0), ..settings }.field(Body::Disc, &mesh).unwrap();
    assert_eq!(whole, HeightSynthesis { patch: None, ..settings }.field(Body::Disc, &mesh).unwrap());
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_another_field() {
    let mesh = ring(300, 31, 50, 1.0);
    for body in [Body::Disc, Body::Pin] {
        let field = synthesis(4, 0.1).field(body, &mesh).unwrap();
        assert_eq!(field, synthesis(4, 0.1).field(body, &mesh).unwrap());
        let other = synthesis(5, 0.1).field(body, &mesh).unwrap();
        let product = field.iter().zip(&other).map(|(a, b)| a * b).sum::<f64>() / field.len() as f64;
        // Standard error of the correlation of two independent fields: √(Σ C²/N), Σ C² = π ℓ²/2 in cells.
        let error = (0.5 * PI * (0.1 / mesh.column_width()).powi(2) / field.len() as f64).sqrt();
        assert!(product.abs() < 5.0 * error, "{product}");
    }
}

#[test]
fn equal_seeds_on_disc_and_pin_are_uncorrelated() {
    let mesh = ring(400, 64, 200, 1.0);
    let length = 2.0 * mesh.column_width();
    let disc = synthesis(9, length).field(Body::Disc, &mesh).unwrap();
    let pin = synthesis(9, length).field(Body::Pin, &mesh).unwrap();
    let product = pin.iter().zip(&disc).map(|(a, b)| a * b).sum::<f64>() / pin.len() as f64;
    assert!(product.abs() < 5.0 * (0.5 * PI * 4.0 / pin.len() as f64).sqrt(), "{product}");
}

#[test]
fn no_rms_height_gives_a_flat_surface() {
    let mesh = ring(30, 4, 3, 1.0);
    let settings = HeightSynthesis { rms_height: 0.0, ..synthesis(1, 0.1) };
    assert_eq!(settings.field(Body::Disc, &mesh).unwrap(), vec![0.0; 120]);
}

#[test]
fn refuses_what_is_no_field() {
    let mesh = ring(30, 1, 1, 1.0);
    let field = |settings: HeightSynthesis, body| settings.field(body, &mesh).unwrap_err();
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(field(synthesis(1, length), Body::Disc), SynthesisError::CorrelationLength { .. }));
    }
    for across in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let settings = HeightSynthesis { texture: Texture::Correlation { along: 0.1, across }, ..synthesis(1, 0.1) };
        let key = "correlation_length_across";
        assert!(
            matches!(field(settings, Body::Disc), SynthesisError::CorrelationLength { key: found, .. } if found == key)
        );
    }
    let power_law = |hurst, roll_off, short_cutoff| {
        let texture = Texture::PowerLaw { hurst, roll_off, short_cutoff };
        field(HeightSynthesis { texture, ..synthesis(1, 0.1) }, Body::Disc)
    };
    for hurst in [-0.1, 1.1, f64::NAN] {
        assert!(matches!(power_law(hurst, 1.0, None), SynthesisError::Hurst { .. }));
    }
    for roll_off in [0.0, 0.4, 7.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(power_law(0.8, roll_off, None), SynthesisError::RollOff { .. }));
    }
    for short_cutoff in [0.0, 0.4, 2.1, f64::NAN] {
        assert!(matches!(power_law(0.8, 2.0, Some(short_cutoff)), SynthesisError::ShortCutoff { .. }));
    }
    let settings = HeightSynthesis { skewness: 1.0, kurtosis: 1.9, ..synthesis(1, 0.1) };
    assert!(matches!(field(settings, Body::Disc), SynthesisError::Kurtosis { .. }));
    for rms_height in [-1.0, f64::NAN, f64::INFINITY] {
        let settings = HeightSynthesis { rms_height, ..synthesis(1, 0.1) };
        assert!(matches!(field(settings, Body::Disc), SynthesisError::RmsHeight { .. }));
    }
    for patch in [0.0, -1.0, f64::NAN, f64::INFINITY, 0.3] {
        let settings = HeightSynthesis { patch: Some(patch), ..synthesis(1, 0.1) };
        assert!(matches!(field(settings, Body::Disc), SynthesisError::Patch { .. }), "{patch}");
    }
    assert!(matches!(field(synthesis(1, 7.0), Body::Disc), SynthesisError::CorrelationTooLong { .. }));
    let settings = HeightSynthesis { patch: Some(1.0), ..synthesis(1, 0.1) };
    assert_eq!(field(settings, Body::Pin), SynthesisError::PatchOnPin);
    // One cell has only its mean; so has one row of a field that repeats more often than it varies.
    assert!(matches!(field(synthesis(1, 0.1), Body::Pin), SynthesisError::OnlyMean { .. }));
    let settings = HeightSynthesis { patch: Some(TAU / 10.0), ..synthesis(1, 6.0) };
    assert!(matches!(field(settings, Body::Disc), SynthesisError::OnlyMean { .. }));
}
