//! Condition of a measured patch before anything is done to it: its form, its spikes and its roughness.

use std::collections::BTreeSet;

use super::heights::{HeightParameters, rms};
use super::level::{Level, level};
use super::missing::remove_outliers;

/// Kurtosis above which there are spikes: normal heights have 3, a surface with deep grooves some 10.
const LARGEST_KURTOSIS: f64 = 20.0;
/// Part of the rms height that outliers leave at least, where they are none worth a word.
const LEAST_LEFT: f64 = 0.7;
/// Part of all points that spikes are, at most: where more lie far from the median, the surface has two levels.
const MOST_OF_ALL: f64 = 0.05;
/// Points of a spike, at most, as of those that `outlier_slope` takes out: a peak, a groove or a scratch of the surface has more.
const MOST_OF_ONE: usize = 9;
/// Least factor by which narrow spikes raise the kurtosis, or by which one of them lies farther away than the limit.
const LEAST_RISE: f64 = 1.5;
const FARTHEST: f64 = 3.0;

/// Points of a patch that lie far from all others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spikes {
    /// Number of points in spikes.
    pub count: usize,
    /// Points with a height.
    pub points: usize,
    /// Kurtosis of the levelled patch with them.
    pub kurtosis: f64,
    /// Rms height of the levelled patch before and after they are taken out, m.
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

/// Number of the points that are in groups of few neighbours.
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
    /// Spikes of the patch, once the form is taken out.
    pub spikes: Option<Spikes>,
}

impl Condition {
    /// Condition of heights in m, in columns of so many rows, NaN where a point is missing; none without heights.
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

/// Tells whether the form of second order of a patch is one of each of its quarters, too: these are flatter without it, a plane taken
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
