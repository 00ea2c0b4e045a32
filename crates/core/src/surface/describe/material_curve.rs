//! The Abbott-Firestone curve: areal material ratio against height (ISO 25178-2:2021, 4.5).

use rayon::prelude::*;

use super::blocks::sums;

/// The material ratio of every height, from all measured heights: a step for every one of them.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialCurve {
    /// Heights above the mean, m, the highest first.
    descending: Vec<f64>,
}

impl MaterialCurve {
    /// The curve of the heights that are there, measured from `mean`, m.
    pub fn of(heights: &[f64], mean: f64) -> Self {
        let mut descending = Vec::with_capacity(heights.len());
        descending.extend(heights.iter().filter(|height| !height.is_nan()).map(|height| height - mean));
        descending.par_sort_unstable_by(|one, other| other.total_cmp(one));
        Self { descending }
    }

    /// Points that have a height.
    pub fn points(&self) -> usize {
        self.descending.len()
    }

    /// Heights above the mean, m, the highest first.
    pub fn descending(&self) -> &[f64] {
        &self.descending
    }

    /// Smr(c): fraction of the points that reach the height `c` (m above the mean) or stand above it.
    pub fn ratio(&self, c: f64) -> f64 {
        self.reaching(c) as f64 / self.points() as f64
    }

    /// Smc(mr): the largest height (m above the mean) that the fraction `ratio` of the points reaches; NaN without points.
    pub fn height(&self, ratio: f64) -> f64 {
        // What rounding adds to a ratio of whole points is no further point.
        let rank = (ratio * self.points() as f64 - 1e-6).ceil() as usize;
        self.descending.get(rank.saturating_sub(1).min(self.points().saturating_sub(1))).copied().unwrap_or(f64::NAN)
    }

    /// Vm at the height `c` (m above the mean), m: volume of material above it per area.
    pub fn material_volume(&self, c: f64) -> f64 {
        let [volume] = sums(&self.descending[..self.reaching(c)], |height| [height - c]);
        volume / self.points() as f64
    }

    /// Vv at the height `c` (m above the mean), m: volume of void below it per area.
    pub fn void_volume(&self, c: f64) -> f64 {
        let [volume] = sums(&self.descending[self.reaching(c)..], |height| [c - height]);
        volume / self.points() as f64
    }

    fn reaching(&self, c: f64) -> usize {
        self.descending.partition_point(|height| *height >= c)
    }
}
