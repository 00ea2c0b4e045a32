//! Form and spikes of measured patches.

use plateau_core::surface::{Condition, Level, Spikes};

use crate::scenes::Stream;

/// Normal heights of 1 um, 100 by 100 points, of which one is missing.
fn normal() -> Vec<f64> {
    let mut random = Stream(1);
    let mut heights: Vec<f64> = (0..10_000).map(|_| 1e-6 * random.normal()).collect();
    heights[5] = f64::NAN;
    heights
}

fn of(heights: Vec<f64>) -> Option<Spikes> {
    Condition::of(&heights, 100).unwrap().spikes
}

#[test]
fn spikes_are_told_by_kurtosis_or_by_what_they_make_of_the_rms_height() {
    assert_eq!(of(normal()), None);
    let mut heights = normal();
    heights.iter_mut().step_by(97).take(20).for_each(|height| *height = 60e-6);
    let spikes = of(heights).unwrap();
    assert_eq!((spikes.count, spikes.points), (20, 9999));
    // 20 of 9999 at 60 um, the rest normal with 1 um: a mean square of 1 + 0.002 x 3600 um2, and 1 um2 without them.
    assert!((spikes.rms[0] - 2.86e-6).abs() < 0.05e-6 && (spikes.rms[1] - 1e-6).abs() < 0.03e-6, "{spikes:?}");
    assert!(spikes.kurtosis > 100.0);
}

#[test]
fn narrow_spikes_are_told_where_a_scratch_is_not() {
    // Ten points of -12 um: (3 + 0.001 x 12⁴)/(1 + 0.001 x 12²)² = 18, and the rms height is 1.07 um with them.
    let with = |places: [usize; 10]| {
        let mut heights = normal();
        places.iter().for_each(|place| heights[*place] = -12e-6);
        of(heights)
    };
    let apart = with(std::array::from_fn(|number| 1007 + 811 * number)).unwrap();
    assert!(apart.count == 10 && (apart.kurtosis - 18.1).abs() < 1.5, "{apart:?}");
    // The same heights as a scratch, straight and aslant, and as two blocks of 2 by 2 with one of two points.
    assert_eq!(with(std::array::from_fn(|number| 1007 + 100 * number)), None);
    assert_eq!(with(std::array::from_fn(|number| 1007 + 101 * number)), None);
    let blocks = [1007, 1008, 1107, 1108, 5007, 5008, 5107, 5108, 8000, 8001];
    assert_eq!(with(blocks).map(|spikes| spikes.count), Some(10));
}

#[test]
fn a_surface_of_two_levels_has_no_spikes() {
    // Of a quarter of the points 20 um higher, and of 6 %.
    for every in [4, 16] {
        let mut heights = normal();
        heights.iter_mut().step_by(every).for_each(|height| *height += 20e-6);
        assert_eq!(of(heights), None, "{every}");
    }
}

#[test]
fn a_single_high_spike_is_told() {
    let mut heights = normal();
    heights[4321] = 25e-6;
    assert_eq!(of(heights).map(|spikes| spikes.count), Some(1));
}

/// 200 by 100 points with a tilt, a bow of so many um from the middle to the ends, and one point of so many 30 um higher.
fn patch(bow: f64, every: usize) -> Vec<f64> {
    let mut random = Stream(2);
    let height = |point: usize| {
        let (x, y) = ((point / 100) as f64 / 99.5 - 1.0, (point % 100) as f64 / 99.0);
        let spike = if point % every == every - 17 { 30.0 } else { 0.0 };
        1e-6 * (12.0 * x - 5.0 * y + bow * x * x + 2.0 * random.normal() + spike)
    };
    (0..20_000).map(height).collect()
}

#[test]
fn bow_and_spikes_are_told_apart() {
    // Without bow and spikes: 2 um. A bow b x² has the rms height b √(4/45), 1.49 um for 5 um: √(4 + 2.22) = 2.49 um.
    let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 0.03;
    for (bow, every, form, plane) in [
        (0.0, usize::MAX, Level::Plane, 2.0),
        (0.0, 1997, Level::Plane, 2.0),
        (5.0, usize::MAX, Level::Quadratic, 2.494),
        (5.0, 1997, Level::Quadratic, 2.494),
    ] {
        let condition = Condition::of(&patch(bow, every), 100).unwrap();
        let spikes = (0..20_000).filter(|point| point % every == every - 17).count();
        let seen = condition.spikes.map_or(0, |spikes| spikes.count);
        assert_eq!((condition.form, seen), (form, if every == usize::MAX { 0 } else { spikes }), "{condition:?}");
        assert!(near(condition.rms_of_forms[0], plane * 1e-6), "{condition:?}");
        assert!(near(condition.rms_height(), 2e-6), "{condition:?}");
    }
}

#[test]
fn a_groove_is_no_bow() {
    // A shape in um from -1 to 1 in x and y, in rough heights of 1 um. Rms by numpy with the plane and second order taken out.
    let check = |shape: &dyn Fn(f64, f64) -> f64, rms: [f64; 2], form: Level| {
        let mut random = Stream(3);
        let place = |number: usize| number as f64 / 49.5 - 1.0;
        let height = |point: usize| 1e-6 * (shape(place(point / 100), place(point % 100)) + random.normal());
        let condition = Condition::of(&(0..10_000).map(height).collect::<Vec<_>>(), 100).unwrap();
        let is_near = condition.rms_of_forms.iter().zip(rms).all(|(found, rms)| (found / rms * 1e6 - 1.0).abs() < 0.03);
        assert!(is_near && condition.form == form, "expected {rms:?} um and {form:?}: {condition:?}");
    };
    // Grooves of 8 um at c with the shape of a Gauss curve, of w from the middle to 1/e.
    for (c, w, rms) in
        [(0.9, 0.3, [1.997, 1.306]), (0.0, 0.3, [2.912, 2.075]), (0.0, 0.8, [2.317, 1.076]), (0.3, 0.5, [2.511, 1.852])]
    {
        check(&|x, _| -8.0 * libm::exp(-((x - c) / w).powi(2)), rms, Level::Plane);
    }
    check(&|x, y| -8.0 * libm::exp(-0.5 * ((x + y) / 0.5).powi(2)), [3.048, 1.794], Level::Plane);
    for (waves, rms) in [(1.0, [2.355, 1.168]), (1.5, [2.249, 1.915])] {
        check(&|x, _| 3.0 * libm::cos(waves * std::f64::consts::PI * x), rms, Level::Plane);
    }
    // Forms, also where they are lower than the roughness.
    check(&|x, _| 3.0 * x * x, [1.354, 1.0], Level::Quadratic);
    check(&|x, y| 2.0 * (x * x + y * y), [1.319, 1.0], Level::Quadratic);
    check(&|x, y| 3.0 * x * y, [1.429, 1.0], Level::Quadratic);
}

#[test]
fn what_is_nothing_but_form_is_no_bowed_surface() {
    let bowl: Vec<f64> = (0..400).map(|point| ((point / 20) as f64).powi(2)).collect();
    assert_eq!(Condition::of(&bowl, 20).map(|condition| condition.form), Some(Level::Plane));
    assert_eq!(Condition::of(&[f64::NAN; 4], 2), None);
    assert_eq!(Condition::of(&[1.0; 4], 2).map(|condition| condition.rms_height()), Some(0.0));
}
