//! Whether what lies far from all other heights of a patch is spikes, told before anything is done to it.

use std::collections::BTreeSet;

use super::describe::HeightParameters;
use super::level::{Level, level, rms};
use super::missing::remove_outliers;

/// Kurtosis above which there are spikes: normal heights have 3, a surface with deep grooves some 10.
const LARGEST_KURTOSIS: f64 = 20.0;
/// Part of the rms height that outliers leave at least, where they are none worth a word.
const LEAST_LEFT: f64 = 0.7;
/// Part of all points that spikes are, at most: where more lie far from the median, the surface has two levels.
const MOST_OF_ALL: f64 = 0.05;
/// Points of a spike, at most, as of those that `outlier_slope` takes out: a peak, a groove or a scratch of the surface has more.
const MOST_OF_ONE: usize = 9;
/// How many times larger narrow spikes make the kurtosis, at least, or how many times farther than the limit one of them lies.
const LEAST_RISE: f64 = 1.5;
const FARTHEST: f64 = 3.0;

/// Points of a patch that lie far from all others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spikes {
    /// How many points they are.
    pub count: usize,
    /// Points with a height.
    pub points: usize,
    /// Kurtosis of the levelled patch with them.
    pub kurtosis: f64,
    /// Its rms height before and after they are taken out, m.
    pub rms: [f64; 2],
}

impl Spikes {
    /// Robust standard deviations from the median beyond which a point is one, as the key `outliers` takes it.
    pub const LIMIT: f64 = 6.0;

    /// The spikes of heights in columns of so many rows, from which a form is taken out as a scene does it: before they are looked for, and
    /// once more without them. Besides the rms height that is left, m, without spikes where there are any; none without heights.
    pub(super) fn of(mut heights: Vec<f64>, rows: usize, form: Level) -> Option<(Option<Self>, f64)> {
        level(&mut heights, rows, form, false);
        let points = heights.iter().filter(|height| !height.is_nan()).count();
        let (kurtosis, before) = (HeightParameters::of(&heights)?.kurtosis, rms(&heights));
        let whole = heights.clone();
        let Some((count, distance)) = remove_outliers(&mut heights, Self::LIMIT).filter(|(count, _)| *count > 0) else {
            return Some((None, before));
        };
        let outliers: BTreeSet<usize> =
            (0..whole.len()).filter(|point| heights[*point].is_nan() && !whole[*point].is_nan()).collect();
        let farthest = outliers.iter().map(|point| whole[*point].abs()).fold(0.0, f64::max);
        level(&mut heights, rows, form, false);
        let (after, left) = (rms(&heights), HeightParameters::of(&heights)?.kurtosis);
        let are_extreme = kurtosis > LARGEST_KURTOSIS || after < LEAST_LEFT * before;
        let stand_out = kurtosis > LEAST_RISE * left || farthest > FARTHEST * distance;
        let are_few = count as f64 <= MOST_OF_ALL * points as f64;
        let are_there = are_few && (are_extreme || stand_out && 2 * narrow(outliers, rows) > count);
        let spikes = Self { count, points, kurtosis, rms: [before, after] };
        Some(if are_there { (Some(spikes), after) } else { (None, before) })
    }
}

/// How many of the points are in groups of few neighbours.
fn narrow(mut points: BTreeSet<usize>, rows: usize) -> usize {
    let mut narrow = 0;
    while let Some(first) = points.pop_first() {
        let (mut group, mut open) = (1, vec![first]);
        while let Some(point) = open.pop() {
            let row = point % rows;
            for place in [point.checked_sub(rows), Some(point), point.checked_add(rows)].into_iter().flatten() {
                // Beside the first and the last row there is nothing.
                let lines = [(row > 0).then(|| place - 1), Some(place), (row + 1 < rows).then_some(place + 1)];
                for neighbour in lines.into_iter().flatten().filter(|neighbour| points.remove(neighbour)) {
                    open.push(neighbour);
                    group += 1;
                }
            }
        }
        narrow += if group <= MOST_OF_ONE { group } else { 0 };
    }
    narrow
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::random::{Random, Stream};

    /// Normal heights of 1 um, 100 by 100 points, of which one is missing.
    fn normal() -> Vec<f64> {
        let mut random = Random::new(1, Stream::DiscHeight);
        let mut heights: Vec<f64> = (0..10_000).map(|_| 1e-6 * random.normal()).collect();
        heights[5] = f64::NAN;
        heights
    }

    fn of(heights: Vec<f64>) -> Option<Spikes> {
        Spikes::of(heights, 100, Level::Plane).unwrap().0
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
        // The last row of a column and the first of the next are no neighbours.
        assert_eq!(narrow((195..205).collect(), 100), 10);
        assert_eq!(narrow((150..160).collect(), 100), 0);
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
}
