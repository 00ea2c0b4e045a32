//! Autocorrelation length, aspect ratio and direction (ISO 25178-2:2021, 4.3.2 to 4.3.4, spatial parameters), from
//! Σ f(x, y) f(x + s, y + t) over all pairs of points of a grid, for all lags (s, t) up to half its size.

use std::sync::Arc;

use rayon::prelude::*;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use super::Grid;

/// Harmonics along y that are kept together, so that both passes move along the memory.
const BAND: usize = 16;
/// Columns that are transformed along y at a time.
const BATCH: usize = 64;

/// The lags 0 ≤ s ≤ columns/2, |t| ≤ rows/2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Lags {
    /// Largest lag along x, in points.
    pub x: usize,
    /// Largest lag along y, in points.
    pub y: usize,
}

impl Lags {
    pub(super) fn of(columns: usize, rows: usize) -> Self {
        Self { x: columns / 2, y: rows / 2 }
    }

    /// Number of lags along y.
    pub(super) fn height(self) -> usize {
        2 * self.y + 1
    }

    /// Place of a lag in the field that [`correlate`] gives.
    pub(super) fn place(self, x: usize, y: isize) -> usize {
        x * self.height() + self.y.saturating_add_signed(y)
    }
}

/// The sums for all [`Lags`], column by column (a lag s along x has all lags t along y, the most negative first), each
/// brought into the wanted form by `finish`. `value` makes f of what the grid holds.
///
/// Zeros round the grid, half as many as there are points, keep the transforms from closing it on itself (Wiener and
/// Khinchin).
pub(super) fn correlate<T: Copy + Default + Send + Sync>(
    columns: &[&[f64]],
    value: impl Fn(f64) -> f64 + Sync,
    finish: impl Fn(f64) -> T + Sync,
) -> Vec<T> {
    let rows = columns.first().map_or(0, |column| column.len());
    let lags = Lags::of(columns.len(), rows);
    let (height, width) = (fast_length(rows + lags.y), fast_length(columns.len() + lags.x));
    let mut harmonics = transform_along_y(columns, height, value);
    square_along_x(&mut harmonics, columns.len(), width, lags.x);
    let scale = 1.0 / (height as f64 * width as f64);
    transform_back_along_y(&harmonics, height, lags, |sum| finish(sum * scale))
}

/// Bytes that [`correlate`] takes for a grid of that size, at most, with its result.
pub(super) fn memory_needed<T>(columns: usize, rows: usize) -> u64 {
    let lags = Lags::of(columns, rows);
    let harmonics = (fast_length(rows + lags.y) / 2 + 1).next_multiple_of(BAND);
    let kept = |columns: usize| (columns as u64).saturating_mul((harmonics * size_of::<Complex<f64>>()) as u64);
    let field = ((lags.x as u64 + 1) * lags.height() as u64).saturating_mul(size_of::<T>() as u64);
    // The field is made when the lags along x are left of the columns.
    kept(columns).saturating_add(kept(BATCH.min(columns))).max(kept(lags.x + 1).saturating_add(field))
}

/// Harmonics of every column, band by band; in a band, column by column.
fn transform_along_y(columns: &[&[f64]], height: usize, value: impl Fn(f64) -> f64 + Sync) -> Vec<Complex<f64>> {
    let plan = RealFftPlanner::new().plan_fft_forward(height);
    let count = plan.complex_len().next_multiple_of(BAND);
    let mut harmonics = vec![Complex::default(); columns.len() * count];
    let mut lines = vec![Complex::default(); BATCH.min(columns.len()) * count];
    for (batch, part) in columns.chunks(BATCH).enumerate() {
        lines.par_chunks_mut(count).zip(part).for_each_init(
            || (plan.make_input_vec(), plan.make_scratch_vec()),
            |(input, scratch), (line, column)| {
                input.fill(0.0);
                input.iter_mut().zip(*column).for_each(|(place, height)| *place = value(*height));
                // It fails for lengths other than the plan's, of which all are.
                let _ = plan.process_with_scratch(input, &mut line[..plan.complex_len()], scratch);
            },
        );
        harmonics.par_chunks_mut(columns.len() * BAND).enumerate().for_each(|(band, kept)| {
            let kept = kept.chunks_exact_mut(BAND).skip(batch * BATCH);
            for (kept, line) in kept.zip(lines.chunks_exact(count).take(part.len())) {
                kept.copy_from_slice(&line[band * BAND..(band + 1) * BAND]);
            }
        });
    }
    harmonics
}

/// From the harmonics Z(x) of every column to Σ Z̄(x) Z(x + s) for 0 ≤ s ≤ `largest`, which need less memory.
fn square_along_x(harmonics: &mut Vec<Complex<f64>>, columns: usize, width: usize, largest: usize) {
    let mut planner = FftPlanner::new();
    let (forward, backward): (Arc<dyn Fft<f64>>, _) =
        (planner.plan_fft_forward(width), planner.plan_fft_inverse(width));
    let scratch = forward.get_inplace_scratch_len().max(backward.get_inplace_scratch_len());
    harmonics.par_chunks_mut(columns * BAND).for_each_init(
        || (vec![Complex::default(); width], vec![Complex::default(); scratch]),
        |(line, scratch), band| {
            for harmonic in 0..BAND {
                line[columns..].fill(Complex::default());
                line.iter_mut()
                    .zip(band.iter().skip(harmonic).step_by(BAND))
                    .for_each(|(place, value)| *place = *value);
                forward.process_with_scratch(line, scratch);
                line.iter_mut().for_each(|value| *value = value.norm_sqr().into());
                backward.process_with_scratch(line, scratch);
                let lags = band.iter_mut().skip(harmonic).step_by(BAND);
                lags.zip(&line[..=largest]).for_each(|(place, value)| *place = *value);
            }
        },
    );
    let (all, kept) = (columns * BAND, (largest + 1) * BAND);
    let bands = harmonics.len() / all;
    (1..bands).for_each(|band| harmonics.copy_within(band * all..band * all + kept, band * kept));
    harmonics.truncate(bands * kept);
    harmonics.shrink_to_fit();
}

/// From the harmonics of every lag along x to the wanted lags along y.
fn transform_back_along_y<T: Copy + Default + Send + Sync>(
    harmonics: &[Complex<f64>],
    height: usize,
    lags: Lags,
    finish: impl Fn(f64) -> T + Sync,
) -> Vec<T> {
    let plan = RealFftPlanner::new().plan_fft_inverse(height);
    let mut field = vec![T::default(); (lags.x + 1) * lags.height()];
    field.par_chunks_mut(lags.height()).enumerate().for_each_init(
        || (plan.make_input_vec(), plan.make_output_vec(), plan.make_scratch_vec()),
        |(input, output, scratch), (lag, line)| {
            for (band, part) in harmonics.chunks_exact((lags.x + 1) * BAND).zip(input.chunks_mut(BAND)) {
                part.copy_from_slice(&band[lag * BAND..lag * BAND + part.len()]);
            }
            // The first and the last harmonic of real values are real but for rounding, which the transform would refuse.
            if let [first, .., last] = input.as_mut_slice() {
                (first.im, last.im) = (0.0, 0.0);
            }
            let _ = plan.process_with_scratch(input, output, scratch);
            // Negative lags are at the end.
            let around = output[height - lags.y..].iter().chain(&output[..=lags.y]);
            line.iter_mut().zip(around).for_each(|(place, sum)| *place = finish(*sum));
        },
    );
    field
}

/// The smallest even number of at least `length` without prime factors above 5: transforms of such lengths are quick.
fn fast_length(length: usize) -> usize {
    let mut candidate = length.max(2).next_multiple_of(2);
    while !is_fast(candidate) {
        candidate += 2;
    }
    candidate
}

fn is_fast(mut length: usize) -> bool {
    for factor in [2, 3, 5] {
        while length.is_multiple_of(factor) {
            length /= factor;
        }
    }
    length == 1
}

/// s: value to which the autocorrelation decays.
const CORRELATION_THRESHOLD: f64 = 0.2;

/// Directions that are compared, at least.
const FEWEST_DIRECTIONS: usize = 720;

/// Spatial parameters, from the autocorrelation for lags up to half the grid's extent in either direction.
///
/// The autocorrelation is ⟨z(x, y) z(x + s, y + t)⟩ over all pairs of measured points that are that far apart, over its
/// value at no lag; z is measured from the mean. So nothing is said of what lies beyond the edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Autocorrelation {
    /// Sal, m: the shortest distance over which the autocorrelation decays to s; NaN if it does so in no direction, or
    /// already before the next point.
    pub length: f64,
    /// Str: Sal over the longest such distance of any direction; NaN if it does not decay in every direction, or if either
    /// distance ends before the next point.
    pub aspect_ratio: f64,
    /// What Str is less than where it is NaN because of a direction in which the autocorrelation does not decay: Sal over
    /// half the extent in that direction.
    pub aspect_ratio_below: f64,
    /// Std, rad, above −π/2 and up to π/2, from x towards y: the direction of the lay; NaN if Str is not below
    /// [`LAY`](Self::LAY).
    pub direction: f64,
    /// Whether the shortest distance ends before the next point: it then is somewhere below the pitch, where the grid has
    /// nothing to tell.
    pub below_pitch: bool,
}

impl Autocorrelation {
    /// Str below which a surface has a direction.
    pub const LAY: f64 = 0.5;

    /// Str, or what it is less than; NaN where neither is determined.
    pub fn largest_aspect_ratio(&self) -> f64 {
        if self.aspect_ratio.is_nan() { self.aspect_ratio_below } else { self.aspect_ratio }
    }

    /// Bytes that [`of`](Self::of) takes for a grid of that size, at most.
    pub(super) fn memory_needed(columns: usize, rows: usize) -> u64 {
        let lags = Lags::of(columns, rows);
        if lags.x == 0 || lags.y == 0 {
            return 0;
        }
        // The numbers of pairs are kept, as u32, while the sums are made.
        let pairs = memory_needed::<u32>(columns, rows);
        let kept = ((lags.x as u64 + 1) * lags.height() as u64).saturating_mul(size_of::<u32>() as u64);
        pairs.max(kept.saturating_add(memory_needed::<f64>(columns, rows)))
    }

    /// That of a grid of known pitch, with heights measured from `mean`.
    ///
    /// Along straight lines from no lag to every lag on the edge of the window, the autocorrelation is linear between the
    /// lines of the grid of lags; the distance is that at which it first falls to s.
    pub fn of(grid: &Grid, mean: f64) -> Option<Self> {
        let pitch = grid.pitch?;
        let lags = Lags::of(grid.columns, grid.rows);
        let columns: Vec<&[f64]> = grid.column_slices().collect();
        let [length, aspect_ratio, aspect_ratio_below] = [f64::NAN; 3];
        let none = Self { length, aspect_ratio, aspect_ratio_below, direction: f64::NAN, below_pitch: false };
        if lags.x == 0 || lags.y == 0 || columns.len() != grid.columns {
            return Some(none);
        }
        let field = Field::of(&columns, mean, lags, pitch);
        let reaches: Vec<Reach> = lags.edge().into_par_iter().map(|end| field.follow(end)).collect();
        // With each distance, whether it ends before the next point.
        let (mut shortest, mut longest, mut beyond) = ((f64::INFINITY, false), (0.0, false), 0.0_f64);
        for reach in reaches {
            match reach {
                Reach::Decays { distance, step } => {
                    if distance < shortest.0 {
                        shortest = (distance, step == 1);
                    }
                    if distance > longest.0 {
                        longest = (distance, step == 1);
                    }
                }
                Reach::Beyond(distance) => beyond = beyond.max(distance),
            }
        }
        let (length, below_pitch) = shortest;
        let found = match (length.is_finite(), beyond > 0.0) {
            (false, _) => none,
            (true, _) if below_pitch => Self { below_pitch, ..none },
            (true, true) => Self { length, aspect_ratio_below: length / beyond.max(longest.0), ..none },
            (true, false) if longest.1 => Self { length, ..none },
            (true, false) => Self { length, aspect_ratio: length / longest.0, ..none },
        };
        let has_lay = found.largest_aspect_ratio() < Self::LAY;
        Some(if has_lay { Self { direction: field.direction(), ..found } } else { found })
    }
}

impl Lags {
    /// The lags on the edge of the half plane s ≥ 0, of which one is enough: the other half mirrors it.
    fn edge(self) -> Vec<(usize, isize)> {
        let (x, y) = (self.x, self.y as isize);
        let ends = (0..x).flat_map(|s| [(s, -y), (s, y)]);
        ends.chain((-y..=y).map(|t| (x, t))).collect()
    }
}

/// How far the autocorrelation reaches in one direction, m.
enum Reach {
    /// It falls to s at this distance, in this step from one line of the grid of lags to the next.
    Decays { distance: f64, step: usize },
    /// It is above s up to there, where it ends.
    Beyond(f64),
}

/// The autocorrelation for all lags; NaN where no two measured points are that far apart.
struct Field {
    values: Vec<f64>,
    lags: Lags,
    pitch: [f64; 2],
}

impl Field {
    fn of(columns: &[&[f64]], mean: f64, lags: Lags, pitch: [f64; 2]) -> Self {
        let rows = columns.first().map_or(0, |column| column.len());
        let is_complete = columns.par_iter().all(|column| column.iter().all(|height| !height.is_nan()));
        // Pairs first: they need half the memory of sums.
        let pairs = (!is_complete).then(|| {
            let measured = |height: f64| if height.is_nan() { 0.0 } else { 1.0 };
            correlate(columns, measured, |pairs| pairs.round() as u32)
        });
        let deviation = |height: f64| if height.is_nan() { 0.0 } else { height - mean };
        let mut values = correlate(columns, deviation, |sum| sum);
        let pairs_of = |place: usize| match &pairs {
            Some(pairs) => f64::from(pairs[place]),
            None => {
                let (x, y) = (place / lags.height(), (place % lags.height()).abs_diff(lags.y));
                ((columns.len() - x) * (rows - y)) as f64
            }
        };
        let origin = lags.place(0, 0);
        let variance = values[origin] / pairs_of(origin);
        values.par_iter_mut().enumerate().for_each(|(place, value)| *value /= pairs_of(place) * variance);
        Self { values, lags, pitch }
    }

    /// Follows the straight line from no lag to `end` until the autocorrelation falls to s.
    fn follow(&self, (x, y): (usize, isize)) -> Reach {
        let steps = x.max(y.unsigned_abs());
        let length = (x as f64 * self.pitch[0]).hypot(y as f64 * self.pitch[1]);
        let mut before = 1.0;
        for step in 1..=steps {
            let along = |end: f64| step as f64 * end / steps as f64;
            let value = if x == steps {
                let (below, part) = whole_and_part(along(y as f64));
                self.between([(step, below), (step, below + 1)], part)
            } else {
                let (below, part) = whole_and_part(along(x as f64));
                let y = step as isize * y.signum();
                self.between([(below as usize, y), (below as usize + 1, y)], part)
            };
            if value.is_nan() {
                return Reach::Beyond(length * (step - 1) as f64 / steps as f64);
            }
            if value <= CORRELATION_THRESHOLD {
                let part = (before - CORRELATION_THRESHOLD) / (before - value);
                let distance = length * ((step - 1) as f64 + part) / steps as f64;
                return Reach::Decays { distance, step };
            }
            before = value;
        }
        Reach::Beyond(length)
    }

    /// The direction along which the autocorrelation is largest in the mean, from the next lag to the nearer edge of the window; as
    /// for `direction` of [`Autocorrelation`].
    ///
    /// The mean along a direction is the power of the waves whose crests run along it: a wave across the direction keeps its sign
    /// there, any other changes it and takes no part. Where the surface has one lay it is the direction across the maximum of the
    /// angular spectrum (ISO 25178-2:2021, 4.3.4), without the leakage of a transform that closes the field.
    fn direction(&self) -> f64 {
        let step = self.pitch[0].min(self.pitch[1]);
        let reach = (self.lags.x as f64 * self.pitch[0]).min(self.lags.y as f64 * self.pitch[1]);
        let steps = ((reach / step) as usize).max(1);
        // Two waves of the shortest length that points can show differ by 1/steps rad over the reach.
        let count = FEWEST_DIRECTIONS.max(4 * steps);
        let angle = |place: f64| std::f64::consts::PI * (place / count as f64 - 0.5);
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
        let Some((best, _)) = known.max_by(|(_, one), (_, other)| one.total_cmp(other)) else { return f64::NAN };
        let [before, top, after] = [count - 1, 0, 1].map(|shift| means[(best + shift) % count]);
        // The summit of the parabola through the largest mean and its neighbours.
        let shift = 0.5 * (before - after) / (before - 2.0 * top + after);
        let place = best as f64 + if shift.is_finite() { shift } else { 0.0 };
        let place = if place <= 0.0 { place + count as f64 } else { place };
        angle(place)
    }

    /// Linear between the four lags about a place within the window, in pitches, x not negative.
    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let ((left, x_part), (below, y_part)) = (whole_and_part(x), whole_and_part(y));
        let edge = [self.lags.x as isize, self.lags.y as isize];
        let lag = |x: isize, y: isize| (x.clamp(0, edge[0]) as usize, y.clamp(-edge[1], edge[1]));
        let column = |x| self.between([lag(x, below), lag(x, below + 1)], y_part);
        let first = column(left);
        if x_part == 0.0 { first } else { first + x_part * (column(left + 1) - first) }
    }

    /// Linear between two neighbouring lags, so far from the first to the second.
    fn between(&self, [first, second]: [(usize, isize); 2], part: f64) -> f64 {
        let at = |(x, y)| self.values.get(self.lags.place(x, y)).copied().unwrap_or(f64::NAN);
        // On the edge there is no second.
        if part == 0.0 { at(first) } else { at(first) + part * (at(second) - at(first)) }
    }
}

fn whole_and_part(place: f64) -> (isize, f64) {
    let whole = place.floor();
    (whole as isize, place - whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_sums_that_define_it() {
        // The direct sums; rounding is a few ε times Σ f², about 40 here.
        for (columns, rows) in [(1, 1), (1, 9), (8, 1), (5, 7), (70, 12), (6, 45)] {
            let f: Vec<f64> = (0..columns * rows).map(|i| ((i * i + 3 * i) % 17) as f64 / 8.0 - 1.0).collect();
            let slices: Vec<&[f64]> = f.chunks(rows).collect();
            let lags = Lags::of(columns, rows);
            let found = correlate(&slices, |height| height, |sum| sum);
            assert_eq!(found.len(), (lags.x + 1) * lags.height());
            for s in 0..=lags.x {
                for t in -(lags.y as isize)..=lags.y as isize {
                    let mut expected = 0.0;
                    for x in 0..columns - s {
                        for y in (0..rows).filter(|y| y.checked_add_signed(t).is_some_and(|other| other < rows)) {
                            expected += slices[x][y] * slices[x + s][y.saturating_add_signed(t)];
                        }
                    }
                    let found = found[lags.place(s, t)];
                    assert!((found - expected).abs() < 1e-11, "{columns} x {rows}, lag {s}, {t}: {found} {expected}");
                }
            }
        }
    }
}
