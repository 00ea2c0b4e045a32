//! Texture direction Std and aspect ratio Str (ISO 25178-2:2021, 4.3.3 and 4.3.4) of a surface with a lay, from its autocorrelation.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::fft::Complex;
use super::heights::HeightParameters;
use super::synthesis::planar::Plane;

/// Value to which the autocorrelation decays.
const DECAYED: f64 = 0.2;
/// Str below which a surface has a direction.
const LAY: f64 = 0.5;
/// Directions that are compared, at least.
const FEWEST_DIRECTIONS: usize = 720;

/// The lay of a surface. `plateau surface` tells the same numbers; docs/surface.md has their definition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureDirection {
    /// Str: the shortest distance over which the autocorrelation decays to 0.2, over the longest; or what it is less than.
    pub aspect_ratio: f64,
    /// Whether it is that bound, for in some direction the autocorrelation does not decay within half the extent.
    pub is_bound: bool,
    /// Std, rad, above −π/2 and up to π/2, from x towards y.
    pub angle: f64,
}

impl TextureDirection {
    /// Bytes that [`of`](Self::of) takes for a grid of that size.
    pub fn memory_needed(columns: usize, rows: usize) -> u64 {
        let [columns, rows] = [columns, rows].map(|points| padded(points) as u64);
        columns.saturating_mul(rows).saturating_mul(size_of::<Complex>() as u64)
    }

    /// That of heights in columns of so many rows, NaN where there is none, from which form was taken out; `pitch` along x and y, m.
    /// None where Str is not below ½ or not determined.
    pub fn of(heights: &[f64], rows: usize, pitch: [f64; 2]) -> Option<Self> {
        let field = Autocorrelation::of(heights, rows, pitch)?;
        let [x, y] = [field.lags[0], field.lags[1]];
        let ends = (0..x).flat_map(|s| [(s, -y), (s, y)]).chain((-y..=y).map(|t| (x, t)));
        let reaches: Vec<Reach> = ends.collect::<Vec<_>>().into_par_iter().map(|end| field.follow(end)).collect();
        // With each distance, whether it ends before the next point, where the grid has nothing to tell.
        let (mut shortest, mut longest, mut beyond) = ((f64::INFINITY, false), (0.0, false), 0.0_f64);
        for reach in reaches {
            match reach {
                Reach::Beyond(distance) => beyond = beyond.max(distance),
                Reach::Decays { distance, step } => {
                    shortest = if distance < shortest.0 { (distance, step == 1) } else { shortest };
                    longest = if distance > longest.0 { (distance, step == 1) } else { longest };
                }
            }
        }
        let is_bound = beyond > 0.0;
        let is_known = shortest.0.is_finite() && !shortest.1 && (is_bound || !longest.1);
        let aspect_ratio = shortest.0 / if is_bound { beyond.max(longest.0) } else { longest.0 };
        if !is_known || aspect_ratio >= LAY {
            return None;
        }
        Some(Self { aspect_ratio, is_bound, angle: field.direction()? })
    }
}

/// Points of a line with half as many zeros, at least, which keep a transform from closing it on itself (Wiener and Khinchin).
fn padded(points: usize) -> usize {
    (points + points / 2).next_power_of_two()
}

/// How far the autocorrelation reaches in one direction, m.
enum Reach {
    /// It falls to 0.2 at this distance, in this step from one line of the grid of lags to the next.
    Decays { distance: f64, step: usize },
    /// It is above that up to there, where it ends.
    Beyond(f64),
}

/// ⟨z(x, y) z(x + s, y + t)⟩ over all pairs of measured points that are so far apart, over its value at no lag, z from the mean.
struct Autocorrelation {
    /// Sums of products, and how many they are, for every lag; negative ones are at the end.
    sums: Vec<Complex>,
    rows: usize,
    variance: f64,
    /// Largest lags along x and y: half the extent.
    lags: [isize; 2],
    pitch: [f64; 2],
}

impl Autocorrelation {
    /// None where there is no lag, or all heights are equal.
    fn of(heights: &[f64], rows: usize, pitch: [f64; 2]) -> Option<Self> {
        let columns = heights.len() / rows.max(1);
        let lags = [columns / 2, rows / 2].map(|lag| lag as isize);
        let HeightParameters { mean, root_mean_square_height: rms, .. } = HeightParameters::of(heights)?;
        if lags.contains(&0) || rms == 0.0 {
            return None;
        }
        let [width, height] = [padded(columns), padded(rows)];
        // Heights travel as the real part, what is measured as the imaginary one.
        let mut sums = vec![Complex::default(); width * height];
        for (place, column) in sums.chunks_exact_mut(height).zip(heights.chunks_exact(rows)) {
            for (place, z) in place.iter_mut().zip(column).filter(|(_, z)| !z.is_nan()) {
                *place = Complex { re: (z - mean) / rms, im: 1.0 };
            }
        }
        let mut plane = Plane::new(width, height, 1);
        plane.forward(&mut sums);
        for here in 0..sums.len() {
            let there = (width - here / height) % width * height + (height - here % height) % height;
            if here <= there {
                let (one, other) = (sums[here], sums[there].conj());
                let power = Complex { re: (one + other).norm_sqr(), im: (one - other).norm_sqr() }.unscale(4.0);
                (sums[here], sums[there]) = (power, power);
            }
        }
        // Back: of what is symmetric, both transforms are the same.
        plane.forward(&mut sums);
        let points = sums.len() as f64;
        sums.par_iter_mut().for_each(|sum| *sum = Complex { re: sum.re / points, im: (sum.im / points).round() });
        let variance = sums.first().map(|sum| sum.re / sum.im)?;
        Some(Self { sums, rows: height, variance, lags, pitch })
    }

    /// Follows the straight line from no lag to `end` until the autocorrelation falls to 0.2.
    fn follow(&self, (x, y): (isize, isize)) -> Reach {
        let steps = x.max(y.abs()) as usize;
        let length = (x as f64 * self.pitch[0]).hypot(y as f64 * self.pitch[1]);
        let mut before = 1.0;
        for step in 1..=steps {
            let value = self.at([x, y].map(|end| step as f64 * end as f64 / steps as f64));
            if value.is_nan() {
                return Reach::Beyond(length * (step - 1) as f64 / steps as f64);
            }
            if value <= DECAYED {
                let part = (before - DECAYED) / (before - value);
                return Reach::Decays { distance: length * ((step - 1) as f64 + part) / steps as f64, step };
            }
            before = value;
        }
        Reach::Beyond(length)
    }

    /// The direction along which the autocorrelation is largest in the mean, from the next lag to the nearer edge; as
    /// for `angle` of [`TextureDirection`].
    ///
    /// The mean along a direction is the power of the waves whose crests run along it: a wave across the direction keeps its sign
    /// there, any other changes it and takes no part.
    fn direction(&self) -> Option<f64> {
        let step = self.pitch[0].min(self.pitch[1]);
        let reach = (self.lags[0] as f64 * self.pitch[0]).min(self.lags[1] as f64 * self.pitch[1]);
        let steps = ((reach / step) as usize).max(1);
        // Two waves of the shortest length that points can show differ by 1/steps rad over the reach.
        let count = FEWEST_DIRECTIONS.max(4 * steps);
        let angle = |place: f64| PI * (place / count as f64 - 0.5);
        let mean = |place: usize| {
            let (sine, cosine) = (libm::sin(angle(place as f64)), libm::cos(angle(place as f64)));
            let values = (1..=steps).map(|index| {
                let distance = index as f64 * step;
                self.at([distance * cosine / self.pitch[0], distance * sine / self.pitch[1]])
            });
            let known = values.filter(|value| !value.is_nan());
            let (sum, known) = known.fold((0.0, 0.0), |(sum, known), value| (sum + value, known + 1.0));
            sum / known
        };
        let means: Vec<f64> = (0..count).into_par_iter().map(mean).collect();
        let known = means.iter().enumerate().filter(|(_, mean)| !mean.is_nan());
        let (best, _) = known.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
        let [before, top, after] = [count - 1, 0, 1].map(|shift| means[(best + shift) % count]);
        // The summit of the parabola through the largest mean and its neighbours.
        let shift = 0.5 * (before - after) / (before - 2.0 * top + after);
        let place = best as f64 + if shift.is_finite() { shift } else { 0.0 };
        Some(angle(if place <= 0.0 { place + count as f64 } else { place }))
    }

    /// Linear between the four lags about a place, in pitches, x not negative; beyond the largest lags as there.
    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let (left, below) = (x.floor(), y.floor());
        let column = |x| between(y - below, || self.lag(x, below as isize), || self.lag(x, below as isize + 1));
        between(x - left, || column(left as isize), || column(left as isize + 1))
    }

    /// The value at a lag; NaN where no two measured points are that far apart.
    fn lag(&self, x: isize, y: isize) -> f64 {
        let (x, y) = (x.min(self.lags[0]), y.clamp(-self.lags[1], self.lags[1]));
        let Complex { re, im } = self.sums[x as usize * self.rows + y.rem_euclid(self.rows as isize) as usize];
        if im == 0.0 { f64::NAN } else { re / im / self.variance }
    }
}

/// Linear, so far from the first to the second; what has no part may be NaN.
fn between(part: f64, first: impl Fn() -> f64, second: impl Fn() -> f64) -> f64 {
    let first = first();
    if part == 0.0 { first } else { first + part * (second() - first) }
}
