//! Parameters of surfaces of which they are known in closed form.

mod material_curve;

use std::f64::consts::{PI, SQRT_2, TAU};

use plateau_core::surface::describe::{
    Autocorrelation, CoreHeight, Description, Direction, Gradient, Grid, HeightParameters, MaterialCurve, PARAMETERS,
    ProfileParameters, Volumes, sampling_errors,
};
use plateau_core::surface::{Level, level};

/// A grid of heights z(x, y) over the indices of column and row.
fn heights(columns: usize, rows: usize, z: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    (0..columns * rows).map(|point| z((point / rows) as f64, (point % rows) as f64)).collect()
}

fn grid(columns: usize, rows: usize, heights: &[f64]) -> Grid<'_> {
    Grid { columns, rows, pitch: Some([2e-6, 5e-7]), heights }
}

#[track_caller]
fn near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() <= relative, "{found}, expected {expected} within {relative:e}");
}

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
fn slopes_of_a_plane() {
    // z = 3 x + 4 y in units of the pitch's lengths: Sdq = 5, Sdr = √26 − 1, and nothing changes where a point is missing.
    let mut plane = heights(20, 30, |x, y| 3.0 * 2e-6 * x + 4.0 * 5e-7 * y);
    for _ in 0..2 {
        let gradient = Gradient::of(&grid(20, 30, &plane)).expect("a pitch");
        near(gradient.root_mean_square_slope, 5.0, 1e-12);
        near(gradient.developed_area_ratio, 26_f64.sqrt() - 1.0, 1e-12);
        (plane[47], plane[599]) = (f64::NAN, f64::NAN);
    }
}

#[test]
fn slopes_of_a_pyramid() {
    // One peak of height h on 3 x 3 points of pitch 1: 4 of 6 differences along either axis are ±h, so Sdq² = 2·(4/6) h².
    // Each of the four cells has three flat corners at its edge: of its four corner triangles one has the squared slope
    // 2h² (at the peak), two have h², one is flat.
    let h = 0.75;
    let heights = heights(3, 3, |x, y| if (x, y) == (1.0, 1.0) { h } else { 0.0 });
    let grid = Grid { columns: 3, rows: 3, pitch: Some([1.0; 2]), heights: &heights };
    let gradient = Gradient::of(&grid).expect("a pitch");
    // Along x: the middle row has two differences of h among six.
    near(gradient.root_mean_square_slope, (2.0 * 2.0 / 6.0 * h * h).sqrt(), 1e-14);
    let cell = ((1.0 + 2.0 * h * h).sqrt() + 2.0 * (1.0 + h * h).sqrt() + 1.0) / 4.0;
    near(gradient.developed_area_ratio, cell - 1.0, 1e-14);
    // Digits that the difference of nearly equal areas would lose: Sdr → Sdq²/2.
    let flat: Vec<f64> = heights.iter().map(|height| height * 1e-9).collect();
    let gradient = Gradient::of(&Grid { heights: &flat, ..grid }).expect("a pitch");
    near(gradient.developed_area_ratio, h * h * 1e-18 * (2.0 + 2.0) / 8.0, 1e-12);
}

#[test]
fn profiles_of_a_sinusoid() {
    // sin over whole periods along x on top of anything that changes across: Ra = 2/π (by the sum, (2/n) cot(π/n) with n
    // points a period, n divisible by 4), Rq = 1/√2, Rsk = 0, Rku = 3/2.
    let (period, columns, rows) = (40.0, 200, 60);
    let mut heights = heights(columns, rows, |x, y| (TAU * x / period).sin() + 5.0 * y * y);
    let along = ProfileParameters::of(&grid(columns, rows, &heights), Direction::Along);
    near(along.arithmetical_mean_height, 2.0 / period / (PI / period).tan(), 1e-10);
    near(along.root_mean_square_height, 1.0 / SQRT_2, 1e-10);
    near(along.kurtosis, 1.5, 1e-9);
    assert!(along.skewness.abs() < 1e-9);
    // Across it is the same parabola everywhere, of which Rq is 5 √(⟨y⁴⟩ − ⟨y²⟩²).
    let across = ProfileParameters::of(&grid(columns, rows, &heights), Direction::Across);
    let power = |k: i32| (0..rows).map(|y| (y as f64).powi(k)).sum::<f64>() / rows as f64;
    near(across.root_mean_square_height, 5.0 * (power(4) - power(2).powi(2)).sqrt(), 1e-9);
    // A row with less than half of its points does not count, nor do missing points.
    heights.iter_mut().enumerate().filter(|(point, _)| point % rows == 7 && point / rows >= 99).for_each(|(_, z)| {
        *z = f64::NAN;
    });
    let along = ProfileParameters::of(&grid(columns, rows, &heights), Direction::Along);
    near(along.root_mean_square_height, 1.0 / SQRT_2, 1e-10);
}

#[test]
fn autocorrelation_of_a_sinusoid() {
    // cos(k x) has the autocorrelation cos(k s), which is 0.2 at s = acos(0.2)/k, for ever the same along y: Str has no value,
    // but is below Sal over half the extent along y. 100 whole periods in 4000 columns leave an estimate within 1/100.
    let period = 40.0;
    let waves = heights(4000, 64, |x, _| (TAU * x / period).cos());
    let spatial = Autocorrelation::of(&grid(4000, 64, &waves), 0.0).expect("a pitch");
    let length = 0.2_f64.acos() / TAU * period * 2e-6;
    near(spatial.length, length, 5e-3);
    assert!(spatial.aspect_ratio.is_nan(), "{spatial:?}");
    // The longest line that stays above 0.2 to the edge of the window, half of 64 rows away, ends there beside the place at
    // which the wave has fallen to 0.2, which is 8.7 lags away: up to a lag less.
    near(spatial.aspect_ratio_below, length / length.hypot(32.0 * 5e-7), 0.06);
}

#[test]
fn autocorrelation_of_a_checkerboard_of_waves_is_that_of_either_direction() {
    // cos(k x) + cos(l y), equal parts: r = (cos ks + cos lt)/2. Along x it falls to 0.2 where cos ks = −0.6, along y where
    // cos lt = −0.6; everywhere between sooner than the longer of the two. With l = 2k in metres the ratio is ½ or less:
    // the shortest distance is found on the curve cos ks + cos lt = 0.4 by the same straight lines, computed here.
    let (k, l) = (TAU / 40.0, TAU / 80.0);
    let waves = heights(1200, 2400, |x, y| (k * x).cos() + (l * y).cos());
    let spatial = Autocorrelation::of(&grid(1200, 2400, &waves), 0.0).expect("a pitch");
    // In metres: k per 2 µm column, l per 0.5 µm row.
    let (k, l) = (k / 2e-6, l / 5e-7);
    let reach = |angle: f64| {
        let r = |d: f64| 0.5 * ((k * d * angle.cos()).cos() + (l * d * angle.sin()).cos());
        let mut distance = 0.0;
        while r(distance) > 0.2 {
            distance += 1e-9;
        }
        distance
    };
    let reaches: Vec<f64> = (0..=900).map(|degree| reach(PI / 1800.0 * f64::from(degree))).collect();
    let shortest = reaches.iter().copied().fold(f64::INFINITY, f64::min);
    let longest = reaches.iter().copied().fold(0.0, f64::max);
    // An estimate over 30 whole periods in either direction, interpolated between lags of a fortieth of a period.
    near(spatial.length, shortest, 0.02);
    near(spatial.aspect_ratio, shortest / longest, 0.04);
}

#[test]
fn the_direction_of_a_lay_is_that_of_its_grooves() {
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
                if point % 10 == 3 { f64::NAN } else { height }
            };
            let heights: Vec<f64> = (0..columns * rows).map(groove).collect();
            let grid = Grid { columns, rows, pitch: Some(pitch), heights: &heights };
            let found = Autocorrelation::of(&grid, 0.0).expect("a pitch");
            let off = (found.direction.to_degrees() - degrees).rem_euclid(180.0);
            // A wave of the length w over the reach R has a width of w/R: here from 4 to 9 degrees.
            assert!(off.min(180.0 - off) < 0.3, "{degrees}, {pitch:?}, {wave:e}: {found:?}");
            assert!(found.direction > -PI / 2.0 && found.direction <= PI / 2.0, "{found:?}");
        }
    }
    // The sum of both directions has none.
    let both = heights(400, 400, |x, y| (TAU * x / 40.0).cos() + (TAU * y / 40.0).cos());
    let found = Autocorrelation::of(&Grid { pitch: Some([1e-6; 2]), ..grid(400, 400, &both) }, 0.0).expect("a pitch");
    assert!(found.aspect_ratio > 0.5 && found.direction.is_nan(), "{found:?}");
}

#[test]
fn missing_points_take_no_part() {
    // The same field with a third of its points missing, at random: each parameter within the sampling error of 40 000
    // independent heights (relative: about 1/√N for Sq, a few times that for the others).
    let whole = gaussian_sample(5, 60_000);
    let mut part = whole.clone();
    part.iter_mut()
        .zip(gaussian_sample(6, 60_000))
        .filter(|(_, other)| *other > 0.4307)
        .for_each(|(z, _)| *z = f64::NAN);
    let [whole, part] = [&whole, &part].map(|heights| Description::of(&grid(300, 200, heights)).expect("heights"));
    let missing = 60_000 - part.measured;
    assert!((missing as f64 / 20_000.0 - 1.0).abs() < 0.03, "{missing} missing");
    near(part.heights.root_mean_square_height, whole.heights.root_mean_square_height, 0.015);
    near(part.core.core_height, whole.core.core_height, 0.05);
    near(part.across.root_mean_square_height, whole.across.root_mean_square_height, 0.015);
    let slope = |description: &Description| description.gradient.expect("a pitch").root_mean_square_slope;
    near(slope(&part), slope(&whole), 0.02);
}

#[test]
fn what_varies_from_point_to_point_has_no_length() {
    // Of white noise nothing is left at the next point: where it falls to 0.2 before that, no grid tells.
    let noise = gaussian_sample(5, 60_000);
    let mut part = noise.clone();
    part.iter_mut().step_by(3).for_each(|z| *z = f64::NAN);
    // A lay of lines of one point across: it ends nowhere along x, but how wide it is nobody knows.
    let lines: Vec<f64> = (0..60_000).map(|point| noise[point % 200]).collect();
    for heights in [&noise, &part, &lines] {
        let found = Autocorrelation::of(&grid(300, 200, heights), 0.0).expect("a pitch");
        let Autocorrelation { length, aspect_ratio, aspect_ratio_below, direction, below_pitch } = found;
        assert!(
            below_pitch && [length, aspect_ratio, aspect_ratio_below, direction].iter().all(|value| value.is_nan()),
            "{found:?}"
        );
    }
    // The mean of two points beside each other along either axis has r = ½ at the next one and 0 at the one after: linear
    // between, it falls to 0.2 at 1.6 points along an axis, the shorter pitch first. Along a line between the axes r is the
    // product of both: from ½ (1, 0) to ¼ (1, 1), so that the longest line is not far from the axis of the longer pitch.
    let mean = |x: usize, y: usize| (0..4).map(|k| noise[(x + k % 2) * 201 % 60_000 + y + k / 2]).sum::<f64>();
    let smooth: Vec<f64> = (0..290 * 199).map(|point| mean(point / 199, point % 199)).collect();
    let found = Autocorrelation::of(&grid(290, 199, &smooth), 0.0).expect("a pitch");
    assert!(!found.below_pitch, "{found:?}");
    near(found.length, 1.6 * 5e-7, 0.03);
    near(found.aspect_ratio, 0.25, 0.05);
    // The mean along y alone: what is left along x ends before the next point, so that the longest distance is unknown.
    let smooth: Vec<f64> = noise.windows(2).map(|pair| pair[0] + pair[1]).chain([0.0]).collect();
    let found = Autocorrelation::of(&grid(300, 200, &smooth), 0.0).expect("a pitch");
    near(found.length, 1.6 * 5e-7, 0.03);
    assert!(found.aspect_ratio.is_nan() && found.aspect_ratio_below.is_nan() && !found.below_pitch, "{found:?}");
}

#[test]
fn a_plane_is_flat_once_it_is_taken_out() {
    let shapes = [(12, 10), (300, 200), (1024, 33)];
    let planes =
        [(0.1, 0.0, 0.0), (0.0, 1e-7, 3e-7), (0.076, 1.3e-8, -7.7e-7), (-3e-6, 0.02, 1.0 / 3.0), (1e-9, -1e-9, 0.0)];
    for ((columns, rows), (offset, along, across)) in
        shapes.into_iter().flat_map(|shape| planes.map(|plane| (shape, plane)))
    {
        let plane = heights(columns, rows, |x, y| offset + along * x + across * y);
        for form in [Level::Plane, Level::Quadratic] {
            let mut heights = plane.clone();
            level(&mut heights, rows, form, false);
            assert!(heights.iter().all(|height| *height == 0.0), "{offset} + {along} x + {across} y, {form:?}");
        }
        // A billionth of the tilt is a surface.
        let bump = 1e-9 * (offset.abs() + along.abs() * columns as f64 + across.abs() * rows as f64);
        let mut heights = plane;
        heights[columns * rows / 2] += bump;
        level(&mut heights, rows, Level::Plane, false);
        near(heights[columns * rows / 2], bump, 0.1);
    }
    let mut heights = heights(300, 200, |x, y| 1e-6 + 1e-7 * x - 3e-8 * y);
    heights[7] = f64::NAN;
    level(&mut heights, 200, Level::Plane, false);
    assert!(heights[7].is_nan());
    let flat = Description::of(&grid(300, 200, &heights)).expect("heights");
    for parameter in PARAMETERS {
        let value = (parameter.value)(&flat).expect("a pitch");
        let has_shape = ["sk", "ku", "Smr", "Sal", "Str", "Std"].iter().any(|part| parameter.symbol.contains(part));
        // Sk, Spk and Svk are heights, Ssk, Sku, Rsk and Rku are not.
        assert!(if has_shape { value.is_nan() } else { value == 0.0 }, "{} is {value}", parameter.symbol);
    }
    assert!(!flat.autocorrelation.expect("a pitch").below_pitch);
}

#[test]
fn what_the_heights_do_not_determine_is_no_number() {
    let flat = Description::of(&grid(12, 10, &[0.1; 120])).expect("heights");
    assert!(flat.heights.skewness.is_nan() && flat.heights.kurtosis.is_nan() && flat.along.skewness.is_nan());
    assert!(flat.autocorrelation.expect("a pitch").length.is_nan());
    assert_eq!((flat.heights.maximum_height(), flat.core.core_height), (0.0, 0.0));
    assert!(Description::of(&grid(3, 2, &[f64::NAN; 6])).is_none());
    assert!(Description::of(&grid(0, 0, &[])).is_none());
    // One point, one column, one row.
    for (columns, rows) in [(1, 1), (1, 9), (9, 1), (2, 2)] {
        let heights = heights(columns, rows, |x, y| x + y * y);
        let description = Description::of(&grid(columns, rows, &heights)).expect("heights");
        assert_eq!(description.measured, columns * rows);
        assert_eq!(description.core.core_height.is_nan(), columns * rows < 5, "{columns} x {rows}");
    }
    let nothing_known = Grid { pitch: None, ..grid(12, 10, &[0.1; 120]) };
    let description = Description::of(&nothing_known).expect("heights");
    assert!(description.gradient.is_none() && description.autocorrelation.is_none());
}

#[test]
fn the_numbers_do_not_depend_on_the_number_of_threads() {
    let heights = gaussian_sample(9, 400 * 333);
    let describe = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| Description::of(&grid(400, 333, &heights))).expect("heights")
    };
    // As text, which tells every number and takes NaN for NaN.
    let [one, three] = [1, 3].map(|threads| format!("{:?}", describe(threads)));
    assert!(one == three);
}

/// The standard error of the rms of N independent normal heights is σ/√(2N), that of their skewness √(6/N) and of their
/// kurtosis √(24/N). A jackknife of B blocks has the relative error 1/√(2(B − 1)) = 0.144; four of them.
#[test]
fn sampling_errors_of_independent_normal_heights_are_those_of_theory() {
    let (columns, rows) = (150, 100);
    let heights = gaussian_sample(5, columns * rows);
    let errors = sampling_errors(&Grid { columns, rows, pitch: Some([1.0; 2]), heights: &heights });
    let count = (columns * rows) as f64;
    for (symbol, expected) in
        [("Sq", (0.5 / count).sqrt()), ("Ssk", (6.0 / count).sqrt()), ("Sku", (24.0 / count).sqrt())]
    {
        let place = PARAMETERS.iter().position(|parameter| parameter.symbol == symbol).unwrap();
        let found = errors[place];
        assert!((found / expected - 1.0).abs() < 4.0 * 0.144, "{symbol}: {found}, expected {expected}");
    }
    assert!(errors[PARAMETERS.iter().position(|parameter| parameter.symbol == "Sz").unwrap()].is_nan());
}
