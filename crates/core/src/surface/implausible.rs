//! What of measured heights can hardly be meant: another unit, or a number that stands for no height.

use super::Length;

/// Distances of points that are not wondered at, m: of atoms, and of what a coordinate measuring machine probes.
const PITCHES: [f64; 2] = [0.1e-9, 1e-3];
/// Rms heights that are not wondered at, m: of a polished mirror, and ten times that of a disc which is scored deeply.
const RMS_HEIGHTS: [f64; 2] = [5e-9, 1e-3];
/// Fewest points with one height that may stand for points without a height.
const FEWEST: usize = 5;
/// Times the interquartile range of all others that this height is from them at least.
const FAR: f64 = 10.0;

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
        let mut others: Vec<f64> =
            heights.iter().copied().filter(|height| height.is_finite() && *height != end).collect();
        if others.len() <= count {
            return None;
        }
        let quarter = others.len() / 4;
        let mut at = |place: usize| *others.select_nth_unstable_by(place, f64::total_cmp).1;
        let [low, high] = [at(quarter), at(3 * quarter)];
        let is_far = (low - end).max(end - high) > FAR * (high - low) && high > low;
        is_far.then(|| {
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
    fn a_number_that_stands_for_no_height_is_told() {
        // A tilt of 50 um in 1000 points, 40 of which are -9999 um.
        let tilted = |number: usize| 0.05e-6 * number as f64;
        let mut heights: Vec<f64> = (0..1000).map(tilted).collect();
        assert_eq!(stand_in(&heights), None);
        heights.iter_mut().step_by(25).for_each(|height| *height = -9999e-6);
        let told = stand_in(&heights).unwrap();
        assert!(told.starts_with("40 points have the height -9.999 mm, far from all others"), "{told}");
        // A detector that is cut off, two spikes, and a surface of two levels are none.
        let cut: Vec<f64> = (0..1000).map(|number| tilted(number).min(45e-6)).collect();
        let mut spikes: Vec<f64> = (0..1000).map(tilted).collect();
        (spikes[3], spikes[700]) = (1e-3, 1e-3);
        let levels: Vec<f64> = (0..1000).map(|number| f64::from(number % 2)).collect();
        assert!([cut, spikes, levels].iter().all(|heights| stand_in(heights).is_none()));
        assert_eq!((stand_in(&[]), stand_in(&[f64::NAN; 4])), (None, None));
    }
}
