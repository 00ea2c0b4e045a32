//! The Abbott-Firestone curve, its core and its volumes.

use super::*;

/// Height at which the Gaussian distribution function is `p`, by Newton's method from the height of a neighbouring p.
fn gaussian_quantile(p: f64, start: f64) -> f64 {
    let mut x = start;
    for _ in 0..60 {
        let error = 0.5 * libm::erfc(-x / SQRT_2) - p;
        let step = (error * TAU.sqrt() * (0.5 * x * x).exp()).clamp(-0.5, 0.5);
        x -= step;
        if step.abs() < 1e-14 {
            break;
        }
    }
    x
}

/// Sk, Spk, Svk, Smr1 and Smr2 (%) of Gaussian heights of unit variance, N → ∞: the shared folder of surfaces.
const GAUSSIAN: [f64; 5] = [2.57395, 0.9450, 0.9450, 9.905, 90.095];

fn core(heights: &[f64]) -> [f64; 5] {
    let mean = HeightParameters::of(heights).expect("heights").mean;
    let core = CoreHeight::of(&MaterialCurve::of(heights, mean));
    let CoreHeight { core_height, reduced_peak_height, reduced_dale_depth, peak_ratio, dale_ratio, .. } = core;
    [core_height, reduced_peak_height, reduced_dale_depth, 100.0 * peak_ratio, 100.0 * dale_ratio]
}

#[test]
fn the_core_of_the_gaussian_distribution() {
    // Heights at equal steps of the distribution function: no sampling error, but half of the last digit printed, and
    // what lies beyond the outermost of the 10^6 quantiles.
    let count = 1_000_000;
    let mut last = -4.9;
    let heights: Vec<f64> = (0..count)
        .map(|index| {
            last = gaussian_quantile((f64::from(index) + 0.5) / f64::from(count), last);
            last
        })
        .collect();
    let tolerances = [5e-6, 5e-5, 5e-5, 5e-4, 5e-4].map(|half_digit| half_digit * 1.2 + 2e-6);
    for ((found, expected), tolerance) in core(&heights).into_iter().zip(GAUSSIAN).zip(tolerances) {
        assert!((found - expected).abs() < tolerance, "{found}, expected {expected} ± {tolerance}");
    }
}

#[test]
fn the_core_of_gaussian_heights_is_within_the_sampling_error() {
    // Twenty samples of 512 x 512 independent heights. The error of the mean over them is their scatter over √20; three of
    // them hold 99.5 % of Student's distribution with 19 degrees of freedom, four 99.96 %. The sampling error of one sample
    // is at least that of the slope at the median, by which Sk is σ √(2π)/√N of its 2.57 (0.2 %), and not many times it.
    let samples: Vec<[f64; 5]> = (1..=20).map(|seed| core(&gaussian_sample(seed, 512 * 512))).collect();
    for (index, expected) in GAUSSIAN.into_iter().enumerate() {
        let values = || samples.iter().map(|sample| sample[index]);
        let mean = values().sum::<f64>() / 20.0;
        let scatter = (values().map(|value| (value - mean).powi(2)).sum::<f64>() / 19.0).sqrt();
        println!("{expected}: {mean} ± {scatter}");
        assert!((mean - expected).abs() < 4.0 * scatter / 20_f64.sqrt(), "{mean} ± {scatter}, expected {expected}");
        assert!(scatter < 0.01 * expected, "{scatter}");
    }
}

#[test]
fn a_uniform_distribution() {
    // Heights (i + ½)/n in any order: the curve is the straight line from 1 to 0, and all of it is core. Sa = 1/4,
    // Sq = 1/√12, Sku = 9/5 (each to 1/n²); Vm(p) = p²/2, Vv(p) = (1 − p)²/2 (to 1/n).
    let count = 90_000;
    let heights: Vec<f64> = (0..count).map(|index| ((index * 7919 % count) as f64 + 0.5) / count as f64).collect();
    let description = Description::of(&grid(300, 300, &heights)).expect("heights");
    near(description.heights.mean, 0.5, 1e-12);
    near(description.heights.arithmetical_mean_height, 0.25, 1e-9);
    near(description.heights.root_mean_square_height, 1.0 / 12_f64.sqrt(), 1e-9);
    near(description.heights.kurtosis, 1.8, 1e-9);
    assert!(description.heights.skewness.abs() < 1e-10);
    near(description.heights.maximum_height(), 1.0 - 1.0 / count as f64, 1e-12);
    let [sk, spk, svk, smr1, smr2] = core(&heights);
    near(sk, 1.0, 1e-9);
    assert!(spk < 1e-4 && svk < 1e-4 && smr1 < 2e-3 && smr2 > 99.998, "{spk} {svk} {smr1} {smr2}");
    let Volumes { peak_material, core_material, core_void, dale_void } = description.volumes;
    for (found, expected) in [
        (peak_material, 0.005),
        (core_material, 0.32 - 0.005),
        (core_void, 0.405 - 0.02),
        (dale_void, 0.02),
        (description.volumes.material(), 0.32),
        (description.volumes.void(), 0.405),
        (description.extreme_peak_height, 0.475),
    ] {
        near(found, expected, 12.0 / count as f64 / 0.1);
    }
}

#[test]
fn material_ratio_and_height_are_inverse() {
    // By hand: heights 3, 2, 2, 1 less their mean 2.
    let heights = [2.0, f64::NAN, 1.0, 3.0, 2.0];
    let curve = MaterialCurve::of(&heights, 2.0);
    assert_eq!(curve.points(), 4);
    for (height, ratio) in [(1.5, 0.0), (1.0, 0.25), (0.5, 0.25), (0.0, 0.75), (-0.5, 0.75), (-1.0, 1.0), (-9.0, 1.0)] {
        assert_eq!(curve.ratio(height), ratio, "Smr({height})");
    }
    for (ratio, height) in [(0.0, 1.0), (0.25, 1.0), (0.26, 0.0), (0.75, 0.0), (0.8, -1.0), (1.0, -1.0)] {
        assert_eq!(curve.height(ratio), height, "Smc({ratio})");
    }
    // (1 + 0.5 + 0.5)/4 above −0.5; (0.5)/4 below it.
    assert_eq!((curve.material_volume(-0.5), curve.void_volume(-0.5)), (0.625, 0.125));
}
