use super::*;

/// Integral of a contact area 1 + 2t, filled fraction t/10, nothing worn or emitted, known at these moments.
fn known_at(moments: &[f64]) -> Course {
    let mut course = Course::start();
    moments.iter().for_each(|t| course.record(*t, [t + t * t, t / 10.0, 0.0, 0.0]));
    course
}

#[test]
fn means_are_those_of_the_function() {
    // The mean of 1 + 2t over [a, b] is 1 + a + b.
    assert_eq!(known_at(&[2.0, 4.0, 8.0]).means(0), [3.0, 7.0, 13.0]);
    assert_eq!(known_at(&[2.0, 4.0, 8.0]).means(1), [0.2, 0.4, 0.8]);
}

#[test]
fn errors_are_those_of_the_definition() {
    let course = |integral: [f64; 2]| {
        let mut course = Course::start();
        integral.iter().zip([1.0, 2.0]).for_each(|(value, time)| course.record(time, [*value, 0.5, 0.0, *value]));
        course
    };
    // Means 3.3 and 3.6 against 3 and 4. By hand: √((0.3² + 0.4²)/(3² + 4²)) = 0.1; the larger of 0.3/3 and 0.4/4; 6.9/7 − 1.
    let [area, filled, worn, emitted] = course([3.3, 6.9]).errors(&course([3.0, 7.0]));
    assert!((area.mean_square - 0.1).abs() < 1e-15 && (area.largest - 0.1).abs() < 1e-15, "{area:?}");
    assert!((area.end + 0.1 / 7.0).abs() < 1e-15 && emitted == area, "{area:?}, {emitted:?}");
    for equal in [filled, worn] {
        assert_eq!(equal, QuantityError { mean_square: 0.0, largest: 0.0, end: 0.0 });
    }
    // Something where the reference has nothing is no small error.
    assert_eq!(known_at(&[1.0]).errors(&course([0.0, 0.0]).first(1))[0].mean_square, f64::INFINITY);
    let [unknown, ..] = course([f64::NAN, 6.9]).errors(&course([3.0, 7.0]));
    assert!(unknown.mean_square.is_nan() && unknown.largest.is_nan());
}

#[test]
fn dense_moments_are_interpolated_at_the_ends_of_windows() {
    let moments: Vec<f64> = (1..=4000).map(|number| f64::from(number) * 2e-3).collect();
    // Windows that end between moments.
    let width = 2.6665;
    let course = known_at(&moments).at(&Windows { width, count: 3 });
    for (number, mean) in course.means(0).into_iter().enumerate() {
        let expected = 1.0 + (2.0 * number as f64 + 1.0) * width;
        // Linear interpolation of a parabola errs by at most (2e-3)²/4 at each end.
        assert!((mean - expected).abs() < 2.0 * 1e-6 / width, "{mean}, expected {expected}");
    }
    assert!((course.means(1)[1] - 2.0 * width / 10.0).abs() < 1e-12);
}

#[test]
fn moments_at_or_just_after_the_ends_are_known() {
    let windows = Windows { width: 5.0, count: 2 };
    let course = known_at(&[2.5, 5.001, 7.5, 10.0]);
    assert!(course.knows(&windows, 0.002) && !course.knows(&windows, 0.0005));
    assert!(!known_at(&[4.999, 10.0]).knows(&windows, 0.002) && !known_at(&[5.0]).knows(&windows, 0.002));
    let exact = known_at(&[5.001, 10.0]);
    assert_eq!(exact.at(&windows), exact);
}

#[test]
fn common_multiples_are_found_where_there_are_small_ones() {
    assert_eq!(common_multiple(&[1.0, 2.0, 5.0, 10.0]), 10.0);
    assert_eq!(common_multiple(&[1.0, 10.0, 20.0, 50.0]), 100.0);
    assert_eq!(common_multiple(&[2.5, 3.0, 10.0]), 30.0);
    assert_eq!(common_multiple(&[7.3, 100.0]), 100.0);
}

#[test]
fn windows_are_whole_units_and_wide_enough() {
    for (duration, unit, least, width, count) in [
        (3000.0, 70.0, 5.0, 70.0, 42),
        (3000.0, 0.75, 5.0, 5.25, 571),
        (60.0, 2.5, 5.0, 5.0, 12),
        (2.0, 0.75, 5.0, 2.0, 1),
        (7.0, 8.0, 5.0, 7.0, 1),
    ] {
        assert_eq!(Windows::new(duration, unit, least), Windows { width, count });
    }
    assert_eq!(Windows::new(10.0, 5.0, 5.0).ends().collect::<Vec<_>>(), [5.0, 10.0]);
}
