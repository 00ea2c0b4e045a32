//! What of measured heights can hardly be meant: another unit, or a number that stands for no height.

use super::Length;

/// Distances of points that are not wondered at, m: of atoms, and of what a coordinate measuring machine probes.
const PITCHES: [f64; 2] = [0.1e-9, 1e-3];
/// Rms heights that are not wondered at, m: of a polished mirror, and ten times that of a disc which is scored deeply.
const RMS_HEIGHTS: [f64; 2] = [5e-9, 1e-3];
/// Rms slope that is not wondered at: that of a surface which stands at 79 degrees.
const STEEPEST: f64 = 5.0;
/// Fewest points with one height that may stand for points without a height.
const FEWEST: usize = 5;
/// Heights that tell the quartiles of all, about.
const MOST_LOOKED_AT: usize = 100_000;
/// Times the interquartile range of all others that this height is from their quartiles at least.
const FAR: f64 = 10.0;
/// The same of the height 0, from the nearest of the others: that is what most often stands for no height, and it may be near them.
const GAP_OF_ZERO: f64 = 2.0;

/// What of a measured surface hints at another unit: its pitch along x and y, if it is known, its rms height, both m, or its slopes, for heights in
/// a wrong unit are steep as well. The heights are as of [`odd_slope`].
pub fn odd_units(heights: &[f64], rows: usize, pitch: Option<[f64; 2]>, rms: f64) -> impl Iterator<Item = String> {
    let distances = pitch.and_then(|pitch| odd_pitch(&pitch, None));
    let steep = || pitch.and_then(|pitch| odd_slope(heights, rows, pitch));
    distances.into_iter().chain(odd_rms(rms).or_else(steep))
}

/// Distances of points, m, that no measurement of a body so long has are in another unit.
pub fn odd_pitch(pitches: &[f64], longest: Option<(&str, f64)>) -> Option<String> {
    let (least, largest) = pitches
        .iter()
        .fold((f64::INFINITY, 0.0), |(least, largest): (f64, f64), pitch| (least.min(*pitch), largest.max(*pitch)));
    let too_long = longest.filter(|(_, length)| largest > *length);
    let (pitch, bound) = if let Some((name, length)) = too_long {
        (largest, format!("the whole {name} is {} long", Length(length)))
    } else if largest > PITCHES[1] {
        (largest, format!("expected at most {}", Length(PITCHES[1])))
    } else if least < PITCHES[0] {
        (least, format!("expected at least {}", Length(PITCHES[0])))
    } else {
        return None;
    };
    Some(format!(
        "the points are {} apart, {bound}: check the unit of pitch or pixel, or that of the file",
        Length(pitch)
    ))
}

/// An rms height, m, that no friction surface has is in another unit.
pub fn odd_rms(rms: f64) -> Option<String> {
    let [least, largest] = RMS_HEIGHTS;
    let bound = if rms > largest {
        format!("at most {}", Length(largest))
    } else if rms > 0.0 && rms < least {
        format!("at least {}", Length(least))
    } else {
        return None;
    };
    Some(format!(
        "the heights have an rms of {} about their mean, expected {bound}: check their unit (key unit)",
        Length(rms)
    ))
}

/// Slopes, in rms over neighbours along x and along y, that heights and distances of different units give. Heights are m, in columns of so
/// many rows, NaN where there is none; `pitch` along x and y, m.
pub fn odd_slope(heights: &[f64], rows: usize, pitch: [f64; 2]) -> Option<String> {
    let along = heights.iter().zip(heights.iter().skip(rows)).map(|(one, next)| (next - one) / pitch[0]);
    let columns = heights.chunks(rows.max(1));
    let across = columns.flat_map(|column| column.windows(2).map(|pair| (pair[1] - pair[0]) / pitch[1]));
    let rms = |slopes: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = slopes
            .filter(|slope| slope.is_finite())
            .fold((0.0, 0), |(sum, count), slope| (sum + slope * slope, count + 1));
        if count == 0 { 0.0 } else { (sum / f64::from(count)).sqrt() }
    };
    let largest = rms(&mut along.into_iter()).max(rms(&mut across.into_iter()));
    (largest > STEEPEST).then(|| {
        format!(
            "heights of neighbours differ by {largest:.2} times their distance (rms), expected at most {STEEPEST}: check the units of distances and \
             heights, many instruments write mm beside um"
        )
    })
}

/// Many points with one height far from all others, m: programs write a number such as -9999 where there is no height.
///
/// The others are told by their quartiles, so that neither a tilt nor spikes count.
pub fn stand_in(heights: &[f64]) -> Option<String> {
    let ends = heights.iter().filter(|height| height.is_finite()).fold(None, |ends: Option<[f64; 2]>, height| {
        let [low, high] = ends.unwrap_or([*height; 2]);
        Some([low.min(*height), high.max(*height)])
    })?;
    ends.into_iter().find_map(|end| {
        let count = heights.iter().filter(|height| **height == end).count();
        if count < FEWEST {
            return None;
        }
        // Quartiles of a part of them are near enough, and take no memory to speak of.
        let others = heights.iter().copied().filter(|height| height.is_finite() && *height != end);
        let mut others: Vec<f64> = others.step_by(heights.len() / MOST_LOOKED_AT + 1).collect();
        if others.len() < FEWEST {
            return None;
        }
        let quarter = others.len() / 4;
        let mut at = |place: usize| *others.select_nth_unstable_by(place, f64::total_cmp).1;
        let [low, high] = [at(quarter), at(3 * quarter)];
        let width = high - low;
        let gap = || {
            let others = heights.iter().filter(|height| height.is_finite() && **height != end);
            others.fold(f64::INFINITY, |gap, height| gap.min((height - end).abs()))
        };
        let is_far = (low - end).max(end - high) > FAR * width || end == 0.0 && gap() > GAP_OF_ZERO * width;
        (is_far && width > 0.0).then(|| {
            format!(
                "{count} points have the height {}, far from all others, of which half are {} to {}: if it stands for points \
                 without a height, write NaN in its place",
                Length(end),
                Length(low),
                Length(high)
            )
        })
    })
}

#[cfg(test)]
mod tests {
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
        assert!(
            odd_pitch(&[12.5e-3; 2], None).unwrap().starts_with("the points are 12.5 mm apart, expected at most 1 mm")
        );
        assert!(
            odd_pitch(&[1e-6, 0.2], Some(("ring", 0.13))).unwrap().contains("200 mm apart, the whole ring is 130 mm")
        );
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
}
