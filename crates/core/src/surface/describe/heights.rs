//! Heights with their shape, sums over many of them; height and hybrid parameters (ISO 25178-2:2021, 4.2 and 4.4), and those of profiles
//! (ISO 4287:1997, 4.2; ISO 21920-2:2021), mean over all of one direction.

use rayon::prelude::*;

use crate::surface::Patch;

/// Heights on a rectangular grid, of which the pitch may be unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid<'a> {
    /// Points along x, the sliding direction.
    pub columns: usize,
    /// Points along y, outward.
    pub rows: usize,
    /// Distance of neighbouring points along x and y, m.
    pub pitch: Option<[f64; 2]>,
    /// Heights, m, column by column; NaN where there is none.
    pub heights: &'a [f64],
}

impl<'a> Grid<'a> {
    /// The heights of a patch.
    pub fn of(patch: &'a Patch) -> Self {
        let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
        Self { columns, rows, pitch: Some([column_pitch, row_pitch]), heights }
    }

    /// The heights of every column.
    pub(super) fn column_slices(&self) -> std::slice::ChunksExact<'a, f64> {
        self.heights.chunks_exact(self.rows.max(1))
    }
}

/// Terms that are summed one after the other.
const BLOCK: usize = 1 << 14;

/// Sums of `N` terms of every measured value.
///
/// Blocks of fixed length are summed by themselves and then in their order: the sums do not depend on the number of
/// threads, and rounding grows with the length of a block and the number of blocks only.
pub(super) fn sums<const N: usize>(values: &[f64], terms: impl Fn(f64) -> [f64; N] + Sync) -> [f64; N] {
    let blocks: Vec<[f64; N]> = values
        .par_chunks(BLOCK)
        .map(|block| {
            let measured = block.iter().filter(|value| !value.is_nan());
            measured.fold([0.0; N], |sum, value| added(sum, terms(*value)))
        })
        .collect();
    blocks.into_iter().fold([0.0; N], added)
}

/// Sum of both, number by number.
fn added<const N: usize>(mut sum: [f64; N], terms: [f64; N]) -> [f64; N] {
    sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    sum
}

/// Moments and extremes of the heights above their mean: every measured point counts alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightParameters {
    /// z̄, m: the mean that the others are measured from.
    pub mean: f64,
    /// Sa = ⟨|z − z̄|⟩, m.
    pub arithmetical_mean_height: f64,
    /// Sq = √⟨(z − z̄)²⟩, m.
    pub root_mean_square_height: f64,
    /// Ssk = ⟨(z − z̄)³⟩/Sq³; NaN where all heights are equal.
    pub skewness: f64,
    /// Sku = ⟨(z − z̄)⁴⟩/Sq⁴; NaN where all heights are equal.
    pub kurtosis: f64,
    /// Sp, m: the highest point above the mean.
    pub maximum_peak_height: f64,
    /// Sv, m: depth of the lowest point below the mean.
    pub maximum_pit_depth: f64,
}

impl HeightParameters {
    /// Those of the heights that are there; none if there are none.
    pub fn of(heights: &[f64]) -> Option<Self> {
        let [count, sum] = sums(heights, |z| [1.0, z]);
        if count == 0.0 {
            return None;
        }
        // What rounding left of a large offset is taken out by the mean of the differences; added to the first mean for
        // those who need one number, but not here, for that rounds it again.
        let first = sum / count;
        let rest = sums(heights, |z| [z - first])[0] / count;
        let mean = first + rest;
        let moments = sums(heights, |z| {
            let height = (z - first) - rest;
            let square = height * height;
            [height.abs(), square, square * height, square * square]
        });
        let measured = || heights.iter().filter(|height| !height.is_nan());
        let lowest = measured().copied().fold(f64::INFINITY, f64::min);
        let highest = measured().copied().fold(f64::NEG_INFINITY, f64::max);
        let [absolute, square, cube, fourth] = moments.map(|moment| moment / count);
        let (rms, flat) = (square.sqrt(), highest == lowest);
        Some(Self {
            mean,
            arithmetical_mean_height: absolute,
            root_mean_square_height: rms,
            skewness: if flat { f64::NAN } else { cube / (square * rms) },
            kurtosis: if flat { f64::NAN } else { fourth / (square * square) },
            maximum_peak_height: highest - mean,
            maximum_pit_depth: mean - lowest,
        })
    }

    /// Sz = Sp + Sv, m.
    pub fn maximum_height(&self) -> f64 {
        self.maximum_peak_height + self.maximum_pit_depth
    }
}

/// Hybrid parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gradient {
    /// Sdq = √(⟨(Δx z/dx)²⟩ + ⟨(Δy z/dy)²⟩): root-mean-square slope from the differences of neighbouring points, each
    /// difference counted once.
    pub root_mean_square_slope: f64,
    /// Sdr: developed area over the area of the grid, less 1.
    pub developed_area_ratio: f64,
}

/// Σ (Δx z/dx)², their number, Σ (Δy z/dy)², their number, Σ excess area per cell, cells.
type Sums = [f64; 6];

impl Gradient {
    /// Those of a grid of known pitch. Differences and cells with a missing point are left out; NaN where none is left.
    ///
    /// The developed area is that of the triangles between neighbouring points: a cell of four points is divided along
    /// either diagonal, and the mean of the two is taken, so that no direction is preferred.
    pub fn of(grid: &Grid) -> Option<Self> {
        let pitch = grid.pitch?;
        let columns: Vec<&[f64]> = grid.column_slices().collect();
        let sums: Vec<Sums> = (0..columns.len())
            .into_par_iter()
            .map(|index| column(columns[index], columns.get(index + 1).copied().unwrap_or(&[]), pitch))
            .collect();
        let [squares_x, count_x, squares_y, count_y, excess, cells] = sums.into_iter().fold([0.0; 6], added);
        Some(Self {
            root_mean_square_slope: (squares_x / count_x + squares_y / count_y).sqrt(),
            developed_area_ratio: excess / cells,
        })
    }
}

/// Sums over a column and the cells to the next one.
fn column(here: &[f64], next: &[f64], [pitch_x, pitch_y]: [f64; 2]) -> Sums {
    let [mut x, mut y, mut area] = [[0.0; 2]; 3];
    for (one, other) in here.iter().zip(next) {
        x = added(x, measured((other - one) / pitch_x, |slope| slope * slope));
    }
    for pair in here.windows(2) {
        y = added(y, measured((pair[1] - pair[0]) / pitch_y, |slope| slope * slope));
    }
    for (left, right) in here.windows(2).zip(next.windows(2)) {
        let squares = |one: f64, other: f64, pitch: f64| ((other - one) / pitch) * ((other - one) / pitch);
        let along = [squares(left[0], right[0], pitch_x), squares(left[1], right[1], pitch_x)];
        let across = [squares(left[0], left[1], pitch_y), squares(right[0], right[1], pitch_y)];
        let excess = along.map(|along| across.map(|across| excess_area(along + across)));
        area = added(area, measured(excess.as_flattened().iter().sum::<f64>(), |sum| 0.25 * sum));
    }
    [x[0], x[1], y[0], y[1], area[0], area[1]]
}

/// √(1 + s) − 1 without the loss of digits where the squared slope s is small.
fn excess_area(squared_slope: f64) -> f64 {
    squared_slope / (1.0 + (1.0 + squared_slope).sqrt())
}

/// A term and that it is one; nothing where a point is missing.
fn measured(value: f64, term: impl Fn(f64) -> f64) -> [f64; 2] {
    if value.is_nan() { [0.0; 2] } else { [term(value), 1.0] }
}

/// Direction of profiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Along x, the sliding direction.
    Along,
    /// Along y, across the sliding direction.
    Across,
}

/// Means over the profiles, the heights of each being measured from its own mean; no cut-off filter. NaN where no profile
/// is left.
///
/// A profile counts if at least half of its points, and two, have a height; for skewness and kurtosis it must not be flat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileParameters {
    /// Ra, m.
    pub arithmetical_mean_height: f64,
    /// Rq, m.
    pub root_mean_square_height: f64,
    /// Rsk.
    pub skewness: f64,
    /// Rku.
    pub kurtosis: f64,
}

impl ProfileParameters {
    /// Those of a grid in one direction.
    pub fn of(grid: &Grid, direction: Direction) -> Self {
        let profiles = match direction {
            Direction::Along => rows(grid),
            Direction::Across => columns(grid),
        };
        let length = if direction == Direction::Along { grid.columns } else { grid.rows };
        let profiles = profiles.iter().filter(|moments| moments.count >= 2.0 && 2.0 * moments.count >= length as f64);
        let mut sums = [[0.0; 2]; 4];
        for profile in profiles {
            for (sum, value) in sums.iter_mut().zip(profile.parameters()) {
                if !value.is_nan() {
                    *sum = added(*sum, [value, 1.0]);
                }
            }
        }
        let [arithmetical_mean_height, root_mean_square_height, skewness, kurtosis] =
            sums.map(|[sum, profiles]| sum / profiles);
        Self { arithmetical_mean_height, root_mean_square_height, skewness, kurtosis }
    }
}

/// Sums over one profile.
#[derive(Debug, Clone, Copy)]
struct Moments {
    count: f64,
    mean: f64,
    lowest: f64,
    highest: f64,
    /// Σ |z|, z², z³, z⁴ with z from the mean.
    sums: [f64; 4],
}

impl Moments {
    const NONE: Self =
        Self { count: 0.0, mean: 0.0, lowest: f64::INFINITY, highest: f64::NEG_INFINITY, sums: [0.0; 4] };

    fn add_height(&mut self, height: f64) {
        if !height.is_nan() {
            self.count += 1.0;
            self.mean += height;
            self.lowest = self.lowest.min(height);
            self.highest = self.highest.max(height);
        }
    }

    fn add_moments(&mut self, height: f64) {
        if !height.is_nan() {
            let z = height - self.mean;
            self.sums = added(self.sums, [z.abs(), z * z, z * z * z, z * z * z * z]);
        }
    }

    fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.mean += other.mean;
        self.lowest = self.lowest.min(other.lowest);
        self.highest = self.highest.max(other.highest);
    }

    /// Ra, Rq, Rsk and Rku; of a flat profile the last two are NaN.
    fn parameters(&self) -> [f64; 4] {
        let [absolute, square, cube, fourth] = self.sums.map(|sum| sum / self.count);
        let rms = square.sqrt();
        let relative = |moment: f64| if self.highest == self.lowest { f64::NAN } else { moment };
        [absolute, rms, relative(cube / (square * rms)), relative(fourth / (square * square))]
    }
}

/// Moments of the profiles along y, which are stored one after the other.
fn columns(grid: &Grid) -> Vec<Moments> {
    let columns: Vec<&[f64]> = grid.column_slices().collect();
    let moments = |column: &&[f64]| {
        let mut moments = Moments::NONE;
        column.iter().for_each(|height| moments.add_height(*height));
        moments.mean /= moments.count;
        column.iter().for_each(|height| moments.add_moments(*height));
        moments
    };
    columns.par_iter().map(moments).collect()
}

/// Columns whose sums are taken one after the other.
const COLUMNS: usize = 128;

/// Moments of the profiles along x: all at once, column by column, in the order of the memory.
fn rows(grid: &Grid) -> Vec<Moments> {
    let columns: Vec<&[f64]> = grid.column_slices().collect();
    let over_columns = |start: &[Moments], add: fn(&mut Moments, f64)| -> Vec<Vec<Moments>> {
        let over_block = |block: &[&[f64]]| {
            let mut moments = start.to_vec();
            for column in block {
                moments.iter_mut().zip(*column).for_each(|(moments, height)| add(moments, *height));
            }
            moments
        };
        columns.par_chunks(COLUMNS).map(over_block).collect()
    };
    let mut means = vec![Moments::NONE; grid.rows];
    for block in over_columns(&means, Moments::add_height) {
        means.iter_mut().zip(&block).for_each(|(sum, block)| sum.merge(block));
    }
    means.iter_mut().for_each(|moments| moments.mean /= moments.count);
    let mut result = means.clone();
    for block in over_columns(&means, Moments::add_moments) {
        result.iter_mut().zip(&block).for_each(|(sum, block)| sum.sums = added(sum.sums, block.sums));
    }
    result
}
