//! Synthetic heights with skewness, kurtosis and power-law spectra: the mean over some seeds against what was asked for.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use plateau_core::surface::{Body, HeightSynthesis, Texture};

use crate::scenes::few_or_all;
use crate::synthesis::{correlation, ring};

/// Tolerances are those of the mean over as many.
static SEEDS: LazyLock<u64> = LazyLock::new(|| few_or_all(5, 20));

fn moment(field: &[f64], power: i32) -> f64 {
    field.iter().map(|z| z.powi(power)).sum::<f64>() / field.len() as f64
}

/// A function of a standard normal number whose distribution has a known skewness and kurtosis.
struct Shape {
    name: &'static str,
    height: fn(f64) -> f64,
    skewness: f64,
    kurtosis: f64,
}

/// Moments from scipy 1.17.1 (`johnsonsu.stats`, `lognorm.stats`; bounded ones `integrate.quad` over the definition).
const SHAPES: [Shape; 5] = [
    Shape {
        name: "unbounded, γ = 1, δ = 2",
        height: |x| ((x - 1.0) / 2.0).sinh(),
        skewness: -0.874483851800844,
        kurtosis: 5.586965781247806,
    },
    Shape {
        name: "unbounded, γ = 0, δ = 2",
        height: |x| (x / 2.0).sinh(),
        skewness: 0.0,
        kurtosis: 4.5078621849296505,
    },
    Shape {
        name: "bounded, γ = −1.2, δ = 0.7",
        height: |x| 1.0 / (1.0 + (-(x + 1.2) / 0.7).exp()),
        skewness: -1.249630867982773,
        kurtosis: 3.942344212442865,
    },
    Shape {
        name: "bounded, γ = 0, δ = 0.5",
        height: |x| 1.0 / (1.0 + (-x / 0.5).exp()),
        skewness: 0.0,
        kurtosis: 1.6272908060148703,
    },
    Shape {
        name: "lognormal, δ = 4",
        height: |x| -(-x / 4.0).exp(),
        skewness: -0.7782516357974832,
        kurtosis: 4.095931274730179,
    },
];

impl Shape {
    /// Mean of a function of the standardised height, and x, by the trapezoidal rule.
    fn mean(&self, function: impl Fn(f64, f64) -> f64) -> f64 {
        let raw = |function: &dyn Fn(f64) -> f64| -> f64 {
            (-1200..=1200)
                .map(|i| f64::from(i) * 0.01)
                .map(|x| 0.01 * (-0.5 * x * x).exp() / TAU.sqrt() * function(x))
                .sum()
        };
        let mean = raw(&|x| (self.height)(x));
        let deviation = raw(&|x| ((self.height)(x) - mean).powi(2)).sqrt();
        raw(&|x| function(((self.height)(x) - mean) / deviation, x))
    }
}

/// Heights with the distribution asked for, and with the autocorrelation exp(−(ρ/ℓ)²) after, not before, they got it.
///
/// Skewness and kurtosis of a large sample have the influence functions z³ − 3z − s − 3s(z² − 1)/2 and
/// z⁴ − 4sz − κ − 2κ(z² − 1). Functions of two normal numbers are correlated no more than these (Gebelein 1941), so the
/// variance of the mean of one over a field is at most its own times Σ r/N, r being the autocorrelation of the Gaussian
/// field: N/Σ r is the number of independent patches. As f is convex for r > 0, r ≤ ρ/f'(0), with f'(0) = E[zx]² and
/// Σ ρ = πℓ² cells. Products z z' have at most the variance κ and depend on two pairs of places each.
#[test]
fn moments_and_autocorrelation() {
    let mesh = ring(1000, 128, 300, 1.0);
    let cells = 3.0;
    let length = cells * mesh.column_width();
    let rows = mesh.rows();
    for (body, shape) in
        SHAPES.iter().map(|shape| (Body::Disc, shape)).chain(SHAPES[..3].iter().map(|shape| (Body::Pin, shape)))
    {
        let (s, k) = (shape.skewness, shape.kurtosis);
        let settings = HeightSynthesis { skewness: s, kurtosis: k, ..HeightSynthesis::gaussian(0, 1.0, length) };
        let count = (body.columns(&mesh) * rows) as f64;
        let linear = shape.mean(|z, x| z * x).powi(2);
        let patches = count / (PI * cells * cells / linear);

        let lags: Vec<(usize, usize)> = (1..=12).map(|lag| (lag, 0)).chain((1..=12).map(|lag| (0, lag))).collect();
        let (mut skewness, mut kurtosis, mut correlations) = (0.0, 0.0, vec![0.0; lags.len()]);
        for seed in 0..*SEEDS {
            let field = HeightSynthesis { seed, ..settings }.field(body, &mesh).unwrap();
            assert!(moment(&field, 1).abs() < count * f64::EPSILON);
            assert!((moment(&field, 2) - 1.0).abs() < count * f64::EPSILON);
            skewness += moment(&field, 3) / *SEEDS as f64;
            kurtosis += moment(&field, 4) / *SEEDS as f64;
            for (mean, lag) in correlations.iter_mut().zip(&lags) {
                *mean += correlation(&field, rows, *lag, body == Body::Disc) / *SEEDS as f64;
            }
        }
        let error = |variance: f64| (variance / patches / *SEEDS as f64).sqrt();
        let of_skewness = error(shape.mean(|z, _| (z.powi(3) - 3.0 * z - s - 1.5 * s * (z * z - 1.0)).powi(2)));
        let of_kurtosis = error(shape.mean(|z, _| (z.powi(4) - 4.0 * s * z - k - 2.0 * k * (z * z - 1.0)).powi(2)));
        let of_correlation = error(2.0 * k);
        // Taking out the mean lowers the autocorrelation by one over the number of patches.
        let lowered = 1.0 / patches;

        let crossing = |axis: &[f64]| {
            let limit = (-1.0_f64).exp();
            let after = axis.iter().position(|value| *value < limit).unwrap();
            // Linear in ρ² and ln ρ, in which the autocorrelation asked for is a straight line.
            let (low, high) = (axis[after - 1].ln(), axis[after].ln());
            let (from, to) = ((after as f64).powi(2), (after as f64 + 1.0).powi(2));
            (from + (to - from) * (low + 1.0) / (low - high)).sqrt() / cells
        };
        let lengths = [crossing(&correlations[..12]), crossing(&correlations[12..])];
        println!(
            "{body:?}, {}: skewness {s:.3}: {skewness:.3} ± {of_skewness:.3}; kurtosis {k:.3}: {kurtosis:.3} ± \
             {of_kurtosis:.3}; length {:.4}, {:.4} ± {:.4}",
            shape.name,
            lengths[0],
            lengths[1],
            of_correlation * 1.0_f64.exp() / 2.0
        );
        assert!((skewness - s).abs() < 4.0 * of_skewness, "{}: skewness {skewness}, not {s}", shape.name);
        assert!((kurtosis - k).abs() < 4.0 * of_kurtosis, "{}: kurtosis {kurtosis}, not {k}", shape.name);
        for (found, (x, y)) in correlations.iter().zip(&lags) {
            let expected = (-((x * x + y * y) as f64) / (cells * cells)).exp();
            let tolerance = 4.0 * of_correlation + lowered;
            assert!((found - expected).abs() < tolerance, "{}: ({x}, {y}): {found}, not {expected}", shape.name);
        }
        // dℓ/ℓ = dρ e/2 where ρ = 1/e.
        for found in lengths {
            assert!((found - 1.0).abs() < (4.0 * of_correlation + lowered) * 1.0_f64.exp() / 2.0, "{found}");
        }
    }
}

/// ρ(r) = ∫ C(q) J₀(qr) q dq / ∫ C(q) q dq and the cells of an independent patch, Σ ρ² = 2π ∫ C² q dq / (∫ C q dq)².
fn power_law(hurst: f64, roll_off: f64, short_cutoff: f64, distance: f64) -> (f64, f64) {
    let (first, last, steps) = (TAU / roll_off, TAU / short_cutoff, 20_000);
    let mut sums = [0.0; 3];
    for step in 0..steps {
        let q = last * (f64::from(step) + 0.5) / f64::from(steps);
        let spectrum = if q < first { 1.0 } else { (q / first).powf(-2.0 - 2.0 * hurst) };
        let values = [spectrum * q, spectrum * q * libm::j0(q * distance), spectrum * spectrum * q];
        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value * last / f64::from(steps));
    }
    (sums[1] / sums[0], TAU * sums[2] / (sums[0] * sums[0]))
}

/// The autocorrelation of a power law by its Hankel transform, in cells, which moments do not change; Bartlett's variance 2 Σ ρ²/N
/// for normal heights, κ times that for others, and Σ ρ/N ≤ 2 Σ ρ²/N for the mean taken out.
#[test]
fn autocorrelation_of_power_laws() {
    let mesh = ring(1000, 128, 300, 1.0);
    let rows = mesh.rows();
    let normal = (0.0, 3.0, 1.0);
    let with_moments = (SHAPES[0].skewness, SHAPES[0].kurtosis, SHAPES[0].kurtosis);
    for (body, hurst, (skewness, kurtosis, variance)) in [
        (Body::Disc, 0.8, normal),
        (Body::Disc, 0.2, normal),
        (Body::Pin, 0.5, normal),
        (Body::Disc, 0.8, with_moments),
    ] {
        let (roll_off, short_cutoff) = (24.0, 4.0);
        let cell = mesh.column_width();
        let texture = Texture::PowerLaw { hurst, roll_off: roll_off * cell, short_cutoff: Some(short_cutoff * cell) };
        let lags =
            [(1, 0), (2, 0), (3, 0), (4, 0), (8, 0), (16, 0), (0, 1), (0, 2), (0, 5), (0, 6), (0, 10), (3, 4), (6, 8)];
        let mut means = [0.0; 13];
        for seed in 0..*SEEDS {
            let settings = HeightSynthesis { texture, skewness, kurtosis, ..HeightSynthesis::gaussian(seed, 1.0, 1.0) };
            let field = settings.field(body, &mesh).unwrap();
            for (mean, lag) in means.iter_mut().zip(lags) {
                *mean += correlation(&field, rows, lag, body == Body::Disc) / *SEEDS as f64;
            }
        }
        for (found, (x, y)) in means.iter().zip(lags) {
            let (expected, patch) = power_law(hurst, roll_off, short_cutoff, ((x * x + y * y) as f64).sqrt());
            let patches = (body.columns(&mesh) * rows) as f64 / patch;
            let tolerance = 4.0 * (2.0 * variance / patches / *SEEDS as f64).sqrt() + 2.0 / patches;
            println!("{body:?} H = {hurst} ({x}, {y}): {found:.4}, expected {expected:.4} ± {tolerance:.4}");
            assert!((found - expected).abs() < tolerance, "({x}, {y}): {found}, expected {expected} ± {tolerance}");
        }
    }
}
