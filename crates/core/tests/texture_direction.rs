//! The direction of a lay is that of its grooves.

use std::f64::consts::{PI, SQRT_2, TAU};

use plateau_core::surface::TextureDirection;

/// Independent Gaussian numbers: SplitMix64 (Steele, Lea and Flood 2014) and the method of Box and Muller.
fn gaussian_sample(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed;
    let mut uniform = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 + 0.5
    };
    let scale = 0.5_f64.powi(53);
    (0..count).map(|_| (-2.0 * (uniform() * scale).ln()).sqrt() * (TAU * uniform() * scale).cos()).collect()
}

#[test]
fn grooves_are_found_at_any_angle() {
    // Grooves at an angle a to x are heights that depend on y cos a - x sin a alone: Std is a. With noise of half their rms height and
    // a tenth of the points missing; on square points, on such as are 4 times as far apart along x, and with waves of 7 points.
    let noise = gaussian_sample(8, 40_000);
    for degrees in [0.0, 10.0, 30.0, 45.0, 60.0, 87.0, 90.0, -20.0, -75.0] {
        let (sine, cosine) = (f64::to_radians(degrees).sin(), f64::to_radians(degrees).cos());
        for (columns, rows, pitch, wave) in
            [(200, 200, [1e-6, 1e-6], 12.3e-6), (100, 400, [4e-6, 1e-6], 33e-6), (200, 200, [1e-6, 1e-6], 7.3e-6)]
        {
            let groove = |point: usize| {
                let (x, y) = ((point / rows) as f64 * pitch[0], (point % rows) as f64 * pitch[1]);
                let height = SQRT_2 * (TAU * (y * cosine - x * sine) / wave).cos() + 0.5 * noise[point];
                if point % 10 == 3 { f64::NAN } else { 1e-6 * height }
            };
            let heights: Vec<f64> = (0..columns * rows).map(groove).collect();
            let found = TextureDirection::of(&heights, rows, pitch).expect("a lay");
            let off = (found.angle.to_degrees() - degrees).rem_euclid(180.0);
            // A wave of the length w over the reach R has a width of w/R: here from 4 to 9 degrees.
            assert!(off.min(180.0 - off) < 0.3, "{degrees}, {pitch:?}, {wave:e}: {found:?}");
            assert!(found.angle > -PI / 2.0 && found.angle <= PI / 2.0, "{found:?}");
        }
    }
}

#[test]
fn the_aspect_ratio_of_a_groove_is_a_bound() {
    // cos(k x) has the autocorrelation cos(k s), which is 0.2 at s = acos(0.2)/k, for ever the same along y: the longest line that
    // stays above 0.2 ends at the edge of the window, half of 64 rows away, beside that place, up to a lag less.
    let waves: Vec<f64> = (0..4000 * 64).map(|point| (TAU * (point / 64) as f64 / 40.0).cos()).collect();
    let found = TextureDirection::of(&waves, 64, [5e-7, 2e-6]).expect("a lay");
    let length = 0.2_f64.acos() / TAU * 40.0 * 5e-7;
    let ratio = length / length.hypot(32.0 * 2e-6);
    assert!(found.is_bound && (found.aspect_ratio / ratio - 1.0).abs() < 0.06, "{found:?}");
}

#[test]
fn without_a_lay_there_is_no_direction() {
    let noise = gaussian_sample(5, 60_000);
    // Lines of one point across: how wide they are nobody knows.
    let lines: Vec<f64> = (0..60_000).map(|point| noise[point % 200]).collect();
    let both: Vec<f64> = (0..160_000)
        .map(|point| (TAU * (point / 400) as f64 / 40.0).cos() + (TAU * (point % 400) as f64 / 40.0).cos())
        .collect();
    for (heights, rows) in [(&noise, 200), (&lines, 200), (&both, 400), (&vec![0.1; 120], 10), (&noise, 60_000)] {
        assert_eq!(TextureDirection::of(heights, rows, [1e-6; 2]), None, "{rows}");
    }
    assert_eq!(TextureDirection::of(&[f64::NAN; 6], 2, [1e-6; 2]), None);
}
