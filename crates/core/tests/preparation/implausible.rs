//! What of measured heights can hardly be meant.

use plateau_core::surface::implausible::{odd_pitch, odd_rms, odd_slope, stand_in};

use super::*;

#[test]
fn an_rms_height_of_another_unit_is_told() {
    // A ground disc of 1.8 um, read as nm and as mm.
    assert!(odd_rms(1.8e-9).unwrap().contains("an rms of 1.8 nm about their mean, expected at least 5 nm"));
    assert!(odd_rms(1.8e-3).unwrap().contains("expected at most 1 mm"));
    assert_eq!((odd_rms(8e-9), odd_rms(0.0), odd_rms(f64::NAN)), (None, None, None));
}

#[test]
fn a_pitch_of_another_unit_is_told() {
    assert!(odd_pitch(&[12.5e-3; 2], None).unwrap().starts_with("the points are 12.5 mm apart, expected at most 1 mm"));
    assert!(odd_pitch(&[1e-6, 0.2], Some(("ring", 0.13))).unwrap().contains("200 mm apart, the whole ring is 130 mm"));
    assert_eq!((odd_pitch(&[1e-6, 1e-3], Some(("ring", 0.13))), odd_pitch(&[], None)), (None, None));
}

#[test]
fn slopes_of_another_unit_are_told() {
    // 3 x 4 points, 2 um up from column to column and level along them: 2 um over 12.5 um, or over 12.5 nm.
    let heights: Vec<f64> = (0..12).map(|point| 2e-6 * f64::from(point / 4)).collect();
    assert_eq!(odd_slope(&heights, 4, [12.5e-6; 2]), None);
    assert!(odd_slope(&heights, 4, [12.5e-9; 2]).unwrap().contains("differ by 160.00 times their distance"));
    assert_eq!((odd_slope(&[], 4, [1.0; 2]), odd_slope(&[f64::NAN; 4], 2, [1.0; 2])), (None, None));
}

#[test]
fn a_number_that_stands_for_no_height_is_told() {
    // A tilt of 50 um in 1000 points, 40 of which are -9999 um.
    let tilted = |number: usize| 0.05e-6 * number as f64;
    let mut heights: Vec<f64> = (0..1000).map(tilted).collect();
    assert_eq!(stand_in(&heights), None);
    heights.iter_mut().step_by(25).for_each(|height| *height = -9999e-6);
    let told = stand_in(&heights).unwrap();
    assert!(told.starts_with("40 points have the height -9.999 mm, far from all others"), "{told}");
    // More than half of them.
    let mut mostly: Vec<f64> = (0..1000).map(tilted).collect();
    mostly.iter_mut().enumerate().filter(|(at, _)| at % 5 != 0).for_each(|(_, height)| *height = -9999e-6);
    assert!(stand_in(&mostly).unwrap().starts_with("800 points have the height"));
    // 0 is near heights of 6 to 20 um, and no other is near it.
    let near = |number: usize| if number.is_multiple_of(25) { 0.0 } else { 6e-6 + 0.014e-6 * number as f64 };
    let mut zeros: Vec<f64> = (0..1000).map(near).collect();
    assert!(stand_in(&zeros).is_none(), "the range between the quartiles is wider than the gap");
    zeros.iter_mut().filter(|height| **height > 0.0).for_each(|height| *height = 6e-6 + *height / 10.0);
    assert!(stand_in(&zeros).unwrap().starts_with("40 points have the height 0 m, far from all others"));
    // Heights that begin at 0, as some programs save them.
    let from_zero: Vec<f64> = (0..1000).map(|number| tilted(number / 10)).collect();
    assert_eq!(stand_in(&from_zero), None);
    // A detector that is cut off, two spikes, and a surface of two levels are none.
    let cut: Vec<f64> = (0..1000).map(|number| tilted(number).min(45e-6)).collect();
    let mut spikes: Vec<f64> = (0..1000).map(tilted).collect();
    (spikes[3], spikes[700]) = (1e-3, 1e-3);
    let levels: Vec<f64> = (0..1000).map(|number| f64::from(number % 2)).collect();
    assert!([cut, spikes, levels].iter().all(|heights| stand_in(heights).is_none()));
    assert_eq!((stand_in(&[]), stand_in(&[f64::NAN; 4])), (None, None));
}

/// What is warned of where such a patch is repeated over a body of a ring of 138.2 mm by 4 mm with a pin of 8 mm.
fn of(preparation: Preparation, patch: Patch, body: Body) -> Vec<String> {
    let mesh = Mesh::new(80, 2765, 160, 20e-3, 24e-3).unwrap();
    let preparation = Preparation { repeat: true, ..preparation };
    let report = preparation.apply(RawHeights::Patch(patch), false, body, &mesh).unwrap().report;
    report.into_iter().filter(|line| line.starts_with("warning: ")).collect()
}

/// Heights of so much up and down.
fn steps(columns: usize, rows: usize, pitch: f64, height: f64) -> Patch {
    patch(columns, rows, pitch, |column, row| if (column + row).is_multiple_of(2) { height } else { -height })
}

#[test]
fn few_points_are_warned_of_with_the_error_that_they_leave() {
    let none = Preparation::NONE;
    assert!(of(none, steps(10, 10, 50e-6, 2e-6), Body::Disc).iter().all(|line| !line.contains("expected 100 or more")));
    // 1/√(2·4) = 0.354.
    let warnings = of(none, steps(2, 2, 50e-6, 2e-6), Body::Disc);
    let few = "warning: the patch has 2 x 2 points, which tell its rms height to no better than 35 %";
    assert!(warnings.iter().any(|line| line.starts_with(few)), "{warnings:?}");
    // Of 120 points 20 are left: 1/√40 = 0.158.
    let mut holed = steps(12, 10, 50e-6, 2e-6);
    holed.heights[20..].fill(f64::NAN);
    let warnings = of(Preparation { fill: Some(Fill::Level), ..none }, holed, Body::Disc);
    let few = |line: &String| line.contains("20 of them with a height") && line.contains("16 %");
    assert!(warnings.iter().any(few), "{warnings:?}");
}

#[test]
fn a_pitch_of_another_unit_is_warned_of() {
    for (pitch, body, bound) in [
        (0.2, Body::Disc, "the points are 200 mm apart, the whole ring is 138.2 mm long"),
        (10e-3, Body::Pin, "the points are 10 mm apart, the whole pin is 7.999 mm long"),
        (2e-3, Body::Disc, "the points are 2 mm apart, expected at most 1 mm"),
        (5e-11, Body::Disc, "the points are 0.05 nm apart, expected at least 0.1 nm"),
    ] {
        let warnings = of(Preparation::NONE, steps(20, 20, pitch, 2e-6), body);
        assert!(warnings.iter().any(|line| line.contains(bound)), "{warnings:?}");
    }
    // The one column of a profile is as long as the ring.
    let profile = Patch { column_pitch: 0.1382, ..steps(1, 200, 50e-6, 2e-6) };
    assert_eq!(of(Preparation::NONE, profile, Body::Disc), [""; 0]);
}

#[test]
fn heights_of_another_unit_are_warned_of() {
    let warnings = of(Preparation::NONE, steps(20, 20, 50e-6, 2.0), Body::Disc);
    let bound = "an rms of 2 m about their mean, expected at most 1 mm";
    assert!(warnings.iter().any(|line| line.contains(bound)), "{warnings:?}");
    assert_eq!(of(Preparation::NONE, steps(20, 20, 50e-6, 2e-6), Body::Disc), [""; 0]);
}

#[test]
fn gaps_that_are_filled_from_spikes_are_warned_of() {
    // A gap within a ring of spikes, and the same without them.
    let holed = |spike: f64| {
        patch(40, 40, 50e-6, |column, row| match (column.abs_diff(20), row.abs_diff(20)) {
            (..=8, ..=8) => f64::NAN,
            (..=9, ..=9) => spike,
            _ => 1e-6 * ((column + row) % 2) as f64,
        })
    };
    let fill = Preparation { fill: Some(Fill::Interpolate), ..Preparation::NONE };
    let warnings = of(fill, holed(60e-6), Body::Disc);
    let rougher = |line: &String| line.contains("filling makes the surface rougher") && line.ends_with("outliers = 6");
    assert!(warnings.iter().any(rougher), "{warnings:?}");
    assert!(!of(fill, holed(0.0), Body::Disc).iter().any(rougher));
}

#[test]
fn heights_that_differ_by_rounding_are_flat() {
    let is_flat = |height: f64, offset: f64| {
        let mut patch = steps(20, 20, 50e-6, height);
        patch.heights.iter_mut().for_each(|height| *height += offset);
        let flat = |line: &String| line.starts_with("warning: all heights of the ring are equal");
        of(Preparation::NONE, patch, Body::Disc).iter().any(flat)
    };
    assert_eq!([is_flat(1e-17, 1e-3), is_flat(1e-9, 1e-3), is_flat(0.0, 0.0)], [true, false, true]);
}
