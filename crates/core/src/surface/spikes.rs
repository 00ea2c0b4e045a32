//! Whether a measured patch has spikes, told before anything is done to it.

use super::Patch;
use super::describe::HeightParameters;
use super::level::{Level, level, rms};
use super::missing::remove_outliers;

/// Kurtosis above which there are spikes: normal heights have 3, a surface with deep grooves some 10.
const LARGEST_KURTOSIS: f64 = 20.0;
/// Part of the rms height that outliers leave at least, where they are none worth a word.
const LEAST_LEFT: f64 = 0.7;

/// Points of a patch that lie far from all others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spikes {
    /// How many points they are.
    pub count: usize,
    /// Points with a height.
    pub points: usize,
    /// Kurtosis of the levelled patch.
    pub kurtosis: f64,
    /// Its rms height before and after they are taken out, m.
    pub rms: [f64; 2],
}

impl Spikes {
    /// Robust standard deviations from the median beyond which a point is one, as the key `outliers` takes it.
    pub const LIMIT: f64 = 6.0;

    /// The spikes of a patch, once a plane is taken out; none where kurtosis and rms height do without them what they do with
    /// them.
    pub fn of(patch: &Patch) -> Option<Self> {
        let mut heights = patch.heights.clone();
        level(&mut heights, patch.rows, Level::Plane, false);
        let points = heights.iter().filter(|height| !height.is_nan()).count();
        let (kurtosis, before) = (HeightParameters::of(&heights)?.kurtosis, rms(&heights));
        let (count, _) = remove_outliers(&mut heights, Self::LIMIT)?;
        level(&mut heights, patch.rows, Level::Plane, false);
        let after = rms(&heights);
        let are_there = count > 0 && (kurtosis > LARGEST_KURTOSIS || after < LEAST_LEFT * before);
        are_there.then_some(Self { count, points, kurtosis, rms: [before, after] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::random::{Random, Stream};

    fn patch(spikes: usize) -> Patch {
        let mut random = Random::new(1, Stream::DiscHeight);
        let mut heights: Vec<f64> = (0..10_000).map(|_| 1e-6 * random.normal()).collect();
        heights.iter_mut().step_by(97).take(spikes).for_each(|height| *height = 60e-6);
        heights[5] = f64::NAN;
        Patch { columns: 100, rows: 100, column_pitch: 1e-6, row_pitch: 1e-6, heights }
    }

    #[test]
    fn spikes_are_told_by_kurtosis_or_by_what_they_make_of_the_rms_height() {
        assert_eq!(Spikes::of(&patch(0)), None);
        let spikes = Spikes::of(&patch(20)).unwrap();
        assert_eq!((spikes.count, spikes.points), (20, 9999));
        // 20 of 9999 at 60 um, the rest normal with 1 um: a mean square of 1 + 0.002 x 3600 um2, and 1 um2 without them.
        assert!((spikes.rms[0] - 2.86e-6).abs() < 0.05e-6 && (spikes.rms[1] - 1e-6).abs() < 0.03e-6, "{spikes:?}");
        assert!(spikes.kurtosis > 100.0);
    }
}
