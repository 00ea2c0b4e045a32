//! Profile parameters (ISO 4287:1997, 4.2; ISO 21920-2:2021), mean over all profiles of one direction.

use rayon::prelude::*;

use super::Grid;
use super::heights::added;

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
const BLOCK: usize = 128;

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
        columns.par_chunks(BLOCK).map(over_block).collect()
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
