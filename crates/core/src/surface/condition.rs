//! What is seen of a measured patch before anything is done to it: which form it has, whether there are spikes, how rough it is.

use super::level::{Level, level, rms};
use super::missing::remove_outliers;
use super::spikes::Spikes;

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
mod tests {
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
