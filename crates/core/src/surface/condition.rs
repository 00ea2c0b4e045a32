//! What is seen of a measured patch before anything is done to it: which form it has, whether there are spikes, how rough it is.

use super::level::{Level, level, rms_left_out};
use super::missing::remove_outliers;
use super::spikes::Spikes;

/// Rms height that is left of a bowed patch, at most, where a form of second order is taken out in place of a plane. Of fifty
/// independent heights the three terms more take out 6 % of the mean square, of which the root is 0.97.
const LEFT_OF_BOWED: f64 = 0.9;

/// Strips of a patch along either side, each of which is left out once where a form is looked for.
const STRIPS: usize = 4;

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
            && is_found_everywhere(heights, rows, beside_bow.is_some());
        let (form, spikes) = if is_bowed { (Level::Quadratic, beside_bow) } else { (Level::Plane, spikes) };
        Some(Self { form, rms_of_forms: [plane, quadratic], spikes })
    }

    /// Rms height without form and spikes, m.
    pub fn rms_height(&self) -> f64 {
        self.rms_of_forms[usize::from(self.form == Level::Quadratic)]
    }
}

/// Whether a form of second order tells heights of which it knows nothing better than a plane does, in strips along either side: a groove
/// or a wave takes the place of such a form where it is seen, and none where it is not.
fn is_found_everywhere(heights: &[f64], rows: usize, has_spikes: bool) -> bool {
    let mut heights = heights.to_vec();
    if has_spikes {
        let mut beside_form = heights.clone();
        level(&mut beside_form, rows, Level::Quadratic, false);
        remove_outliers(&mut beside_form, Spikes::LIMIT);
        heights
            .iter_mut()
            .zip(&beside_form)
            .filter(|(_, left)| left.is_nan())
            .for_each(|(height, _)| *height = f64::NAN);
    }
    let left = |form| rms_left_out(&heights, rows, form, STRIPS);
    left(Level::Quadratic)
        .into_iter()
        .zip(left(Level::Plane))
        .all(|(quadratic, plane)| quadratic < LEFT_OF_BOWED * plane)
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
    fn what_is_nothing_but_form_is_no_bowed_surface() {
        let bowl: Vec<f64> = (0..400).map(|point| ((point / 20) as f64).powi(2)).collect();
        assert_eq!(Condition::of(&bowl, 20).map(|condition| condition.form), Some(Level::Plane));
        assert_eq!(Condition::of(&[f64::NAN; 4], 2), None);
        assert_eq!(Condition::of(&[1.0; 4], 2).map(|condition| condition.rms_height()), Some(0.0));
    }
}
