//! The Abbott-Firestone curve, areal material ratio against height, with its core and its volumes (ISO 25178-2:2021, 4.5
//! and B.1; ISO 13565-2:1996, clause 4).

use rayon::prelude::*;

use super::heights::sums;

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

/// Part of the curve that the equivalent line is fitted to.
const CENTRAL_REGION: f64 = 0.4;

/// Sk and what goes with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoreHeight {
    /// Sk, m: height of the core.
    pub core_height: f64,
    /// Spk, m: reduced height of the peaks above the core.
    pub reduced_peak_height: f64,
    /// Svk, m: reduced depth of the dales below the core.
    pub reduced_dale_depth: f64,
    /// Smr1: fraction of the points that are peaks above the core; NaN where all heights are equal.
    pub peak_ratio: f64,
    /// Smr2: fraction of the points that are peaks or core; NaN where all heights are equal.
    pub dale_ratio: f64,
    /// Height of the upper end of the core above the mean, m.
    pub upper: f64,
    /// Height of its lower end above the mean, m.
    pub lower: f64,
}

impl CoreHeight {
    /// The core of a curve; NaN throughout with fewer than five points, of which 40 % make no line.
    ///
    /// The secant over 40 % of the points with the least slope, the first such from the top, marks the central region. The
    /// least-squares line through its points (deviations in the direction of the heights) meets 0 % and 100 % at the ends
    /// of the core. Spk and Svk are the heights of the triangles over the bases Smr1 and 1 − Smr2 that have the areas of
    /// the peaks above and the dales below the core.
    pub fn of(curve: &MaterialCurve) -> Self {
        let heights = curve.descending();
        let width = (CENTRAL_REGION * heights.len() as f64) as usize;
        let Some(first) = least_slope(heights, width) else {
            let [core_height, reduced_peak_height, reduced_dale_depth, peak_ratio, dale_ratio, upper, lower] =
                [f64::NAN; 7];
            return Self { core_height, reduced_peak_height, reduced_dale_depth, peak_ratio, dale_ratio, upper, lower };
        };
        let (mean, slope) = line(&heights[first..=first + width]);
        // The point of index i covers the material ratios from i to i + 1; in indices, 0 % is at −½.
        let centre = first as f64 + 0.5 * width as f64;
        let upper = mean + slope * (-0.5 - centre);
        let lower = mean + slope * (heights.len() as f64 - 0.5 - centre);
        // A plane is all core, or all peak, or all dale.
        let is_flat = heights.first() == heights.last();
        let [peak_ratio, dale_ratio] = [upper, lower].map(|end| if is_flat { f64::NAN } else { curve.ratio(end) });
        let height = |area: f64, base: f64| if base > 0.0 { 2.0 * area / base } else { 0.0 };
        Self {
            core_height: upper - lower,
            reduced_peak_height: height(curve.material_volume(upper), peak_ratio),
            reduced_dale_depth: height(curve.void_volume(lower), 1.0 - dale_ratio),
            peak_ratio,
            dale_ratio,
            upper,
            lower,
        }
    }
}

/// Index at which the secant over `width` steps with the least slope begins.
fn least_slope(descending: &[f64], width: usize) -> Option<usize> {
    if width < 2 {
        return None;
    }
    let falls = descending.iter().zip(&descending[width..]).map(|(begin, end)| begin - end);
    let least = falls.enumerate().reduce(|least, fall| if fall.1 < least.1 { fall } else { least });
    least.map(|(index, _)| index)
}

/// Mean and slope per step of the least-squares line through heights at equal steps.
fn line(heights: &[f64]) -> (f64, f64) {
    let count = heights.len() as f64;
    let mean = sums(heights, |height| [height])[0] / count;
    let centre = 0.5 * (count - 1.0);
    let moment: f64 = heights.iter().enumerate().map(|(step, height)| (step as f64 - centre) * (height - mean)).sum();
    (mean, moment / (count * (count * count - 1.0) / 12.0))
}

/// Material ratio that parts peak from core.
const PEAK: f64 = 0.1;
/// Material ratio that parts core from dale.
const DALE: f64 = 0.8;

/// Volumes of material and void at the material ratios p = 10 % and q = 80 %, per area, m³/m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volumes {
    /// Vm(p) of the peaks, Vmp.
    pub peak_material: f64,
    /// Vm(q) − Vm(p) of the core, Vmc.
    pub core_material: f64,
    /// Vv(p) − Vv(q) of the core, Vvc.
    pub core_void: f64,
    /// Vv(q) of the dales, Vvv.
    pub dale_void: f64,
}

impl Volumes {
    /// Those of a curve.
    pub fn of(curve: &MaterialCurve) -> Self {
        let (peak, dale) = (curve.height(PEAK), curve.height(DALE));
        let (peak_material, dale_void) = (curve.material_volume(peak), curve.void_volume(dale));
        Self {
            peak_material,
            core_material: curve.material_volume(dale) - peak_material,
            core_void: curve.void_volume(peak) - dale_void,
            dale_void,
        }
    }

    /// Vm(q), m³/m²: all material above the height at 80 %.
    pub fn material(&self) -> f64 {
        self.peak_material + self.core_material
    }

    /// Vv(p), m³/m²: all void below the height at 10 %.
    pub fn void(&self) -> f64 {
        self.core_void + self.dale_void
    }
}
