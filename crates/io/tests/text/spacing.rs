//! Distances along a profile: evenly spaced, rounded, with holes, or refused.

use super::*;

/// A profile whose heights, µm, count its points at these distances, µm.
fn of(distances: &[f64]) -> Result<Measured, FileError> {
    let lines: String = distances.iter().zip(1..).map(|(x, z)| format!("{x} {z}\n")).collect();
    profile(&format!("x [um] z [um]\n{lines}"), None, None)
}

#[test]
fn even_points_are_spaced_evenly_whatever_their_digits() {
    for (step, digits, rounded_to) in
        [(0.5, 1, None), (0.156_25, 1, Some("0.1")), (9.951e-5, 6, None), (1.75, 0, Some("1"))]
    {
        for sign in [1.0, -1.0] {
            let scale = 10_f64.powi(digits);
            let distance = |n: i32| 3.0 + sign * (f64::from(n) * step * scale).round() / scale;
            let found = of(&(0..9600).map(distance).collect::<Vec<_>>()).unwrap();
            // The last coordinate is rounded: half a place over 9599 steps.
            let error = 0.5 * 10_f64.powi(-digits) / 9599.0;
            assert!((found.pitch.unwrap()[0] * 1e6 - step).abs() <= error * 1.001, "{:?} for {step}", found.pitch);
            assert_eq!(found.columns, 9600);
            let note = rounded_to.map(|place| format!("distances rounded to {place} are taken as evenly spaced"));
            assert_eq!(note.is_some(), found.notes.len() > 1, "{:?}", found.notes);
            assert!(note.is_none_or(|note| found.notes[1].starts_with(&note)), "{:?}", found.notes);
        }
    }
}

#[test]
fn points_that_are_not_there_leave_holes() {
    let mut distances: Vec<f64> = (0..40).map(f64::from).collect();
    distances.drain(17..19);
    distances.remove(30);
    let found = of(&distances).unwrap();
    assert_eq!((found.columns, found.pitch.unwrap()[0]), (40, 1e-6));
    let missing: Vec<usize> = (0..40).filter(|place| found.heights[*place].is_nan()).collect();
    assert_eq!(missing, [17, 18, 32]);
}

#[test]
fn every_point_may_be_off_its_place_also_the_first() {
    let found = of(&[-0.015, 1.015, 2.0, 3.015, 3.985]).unwrap();
    assert_eq!((found.columns, found.pitch.unwrap()[0]), (5, 1e-6));
}

#[test]
fn uneven_points_are_refused_with_the_numbers() {
    let error = |distances: &[f64]| of(distances).unwrap_err().to_string();
    let said = [
        error(&[0.0, 1.0, 2.0, 3.31, 4.0]),
        // A third of the points is not there; integers with gaps of 1 and 3 are no rounded coordinates.
        error(&[0.0, 1.0, 3.0, 4.0, 7.0, 8.0]),
        error(&[0.0, 1.0, 2.0, 4.0, 6.0, 8.0]),
        error(&[0.0, 1.0, 1.5, 4.0]),
        error(&[1.0, 1.0]),
    ];
    insta::assert_snapshot!(said.join("\n"));
}
