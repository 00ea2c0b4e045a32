//! What is seen of a measured patch before anything is done to it: which form it has, whether there are spikes, how rough it is.

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

/// Rms height that is left of a bowed patch, at most, where a form of second order is taken out in place of a plane. Of fifty
/// independent heights the three terms more take out 6 % of the mean square, of which the root is 0.97.
const LEFT_OF_BOWED: f64 = 0.9;

/// The condition of a measured patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// The form to take out: the plane, or second order where the patch is bowed.
    pub form: Level,
    /// Rms height without spikes, m: with the plane taken out, and with second order.
    pub rms_of_forms: [f64; 2],
    /// Its spikes, once the form is taken out.
    pub spikes: Option<Spikes>,
}

impl Condition {
    /// That of heights in m, in columns of so many rows, NaN where a point is missing; none without heights.
    ///
    /// Form and spikes are looked for as `level` and `outliers` take them out, one after the other: spikes do not tell the form, and a bow
    /// does not hide them.
    pub fn of(heights: &[f64], rows: usize) -> Option<Self> {
        let (spikes, plane) = Spikes::of(heights.to_vec(), rows, Level::Plane)?;
        let (beside_bow, quadratic) = Spikes::of(heights.to_vec(), rows, Level::Quadratic)?;
        let is_bowed = quadratic > 0.0
            && quadratic < LEFT_OF_BOWED * plane
            && is_in_every_quarter(heights, rows, beside_bow.is_some());
        let (form, spikes) = if is_bowed { (Level::Quadratic, beside_bow) } else { (Level::Plane, spikes) };
        Some(Self { form, rms_of_forms: [plane, quadratic], spikes })
    }

    /// Rms height without form and spikes, m.
    pub fn rms_height(&self) -> f64 {
        self.rms_of_forms[usize::from(self.form == Level::Quadratic)]
    }
}

/// Whether the form of second order of a patch is one of each of its quarters, too: whether these are flatter without it, a plane taken
/// out of each. A quarter that has less than half of the curvature is not, and a groove or a wave has its curvature in some and the
/// opposite one in others.
fn is_in_every_quarter(heights: &[f64], rows: usize, has_spikes: bool) -> bool {
    let mut beside = heights.to_vec();
    level(&mut beside, rows, Level::Quadratic, false);
    if has_spikes {
        remove_outliers(&mut beside, Spikes::LIMIT);
        level(&mut beside, rows, Level::Quadratic, false);
    }
    let halves = |count: usize| [0..count / 2, count / 2..count];
    let quarters =
        halves(heights.len() / rows).into_iter().flat_map(|columns| halves(rows).map(|part| (columns.clone(), part)));
    quarters.into_iter().all(|(columns, part)| {
        let left = |whole: &[f64]| {
            let points = columns.clone().flat_map(|column| part.clone().map(move |row| column * rows + row));
            let seen = points.map(|point| if beside[point].is_nan() { f64::NAN } else { whole[point] });
            let mut seen: Vec<f64> = seen.collect();
            level(&mut seen, part.len(), Level::Plane, false);
            rms(&seen)
        };
        let (with, without) = (left(heights), left(&beside));
        // Of a quarter without heights nothing is known.
        without < with || with.is_nan()
    })
}

#[cfg(test)]
mod spikes_tests {
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

#[cfg(test)]
mod condition_tests {
    use super::*;
    use crate::surface::random::{Random, Stream};

    /// 200 by 100 points with a tilt, a bow of so many um from the middle to the ends, and one point of so many 30 um higher.
    fn patch(bow: f64, every: usize) -> Vec<f64> {
        let mut random = Random::new(2, Stream::DiscHeight);
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
            let mut random = Random::new(3, Stream::DiscHeight);
            let place = |number: usize| number as f64 / 49.5 - 1.0;
            let height = |point: usize| 1e-6 * (shape(place(point / 100), place(point % 100)) + random.normal());
            let condition = Condition::of(&(0..10_000).map(height).collect::<Vec<_>>(), 100).unwrap();
            let is_near =
                condition.rms_of_forms.iter().zip(rms).all(|(found, rms)| (found / rms * 1e6 - 1.0).abs() < 0.03);
            assert!(is_near && condition.form == form, "expected {rms:?} um and {form:?}: {condition:?}");
        };
        // Grooves of 8 um at c with the shape of a Gauss curve, of w from the middle to 1/e.
        for (c, w, rms) in [
            (0.9, 0.3, [1.997, 1.306]),
            (0.0, 0.3, [2.912, 2.075]),
            (0.0, 0.8, [2.317, 1.076]),
            (0.3, 0.5, [2.511, 1.852]),
        ] {
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
}
