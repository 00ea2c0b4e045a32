//! A map of heights, reduced to what a picture shows.

use std::ops::{Range, RangeInclusive};

use plateau_core::surface::describe::Grid;

use super::picture::Picture;
use crate::colour::{COLOURS, MISSING, colour_index, colour_map};

/// Number of the colour of points that were not measured.
const NOT_MEASURED: u8 = COLOURS as u8;
/// Points along a side that are kept for a picture, at most; along x for each of its windows.
const MOST_POINTS: usize = 1500;

/// Length of a window over its height, about, and windows of a map, at most.
const ELONGATION: f64 = 8.6;
const MOST_WINDOWS: usize = 6;

/// Heights on a coarser grid where the grid has more points than a picture: the mean of the measured points of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    columns: usize,
    rows: usize,
    /// Column by column; NaN where nothing was measured.
    values: Vec<f64>,
}

impl Raster {
    /// The heights of a grid above `mean`.
    pub fn of(grid: &Grid, mean: f64) -> Self {
        let blocks = |points: usize, most: usize| points.div_ceil(most).max(1);
        let [dx, dy] = grid.pitch.unwrap_or([1.0; 2]);
        let windows = windows(grid.columns as f64 * dx / (grid.rows as f64 * dy));
        let (wide, high) = (blocks(grid.columns, windows * MOST_POINTS), blocks(grid.rows, MOST_POINTS));
        let (columns, rows) = (grid.columns.div_ceil(wide), grid.rows.div_ceil(high));
        let mut values = Vec::with_capacity(columns * rows);
        for block in grid.heights.chunks(grid.rows.max(1) * wide) {
            let mut sums = vec![(0.0, 0.0); rows];
            for column in block.chunks(grid.rows.max(1)) {
                for (sum, heights) in sums.iter_mut().zip(column.chunks(high)) {
                    for height in heights.iter().filter(|height| !height.is_nan()) {
                        *sum = (sum.0 + (height - mean), sum.1 + 1.0);
                    }
                }
            }
            values.extend(sums.iter().map(|(sum, count)| sum / count));
        }
        Self { columns, rows, values }
    }

    /// Columns of values.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The columns of one of so many windows.
    pub fn window(&self, number: usize, count: usize) -> Range<usize> {
        number * self.columns / count..(number + 1) * self.columns / count
    }

    /// A picture of some columns, from the top, where y is largest; `range` spans the colour map. On fewer pixels than there are values each
    /// shows the mean of those that lie in it: single values would make patterns that the surface does not have.
    pub fn picture(&self, range: &RangeInclusive<f64>, window: Range<usize>, pixels: [usize; 2]) -> Picture {
        let length = range.end() - range.start();
        let (columns, rows) = (window.len().min(pixels[0]), self.rows.min(pixels[1]));
        let part = |number: usize, count: usize, of: usize| number * of / count..(number + 1) * of / count;
        let mean = |column: usize, row: usize| {
            let (mut sum, mut count) = (0.0, 0.0);
            for x in part(column, columns, window.len()) {
                let values = &self.values[(window.start + x) * self.rows..][part(row, rows, self.rows)];
                for value in values.iter().filter(|value| !value.is_nan()) {
                    (sum, count) = (sum + value, count + 1.0);
                }
            }
            sum / count
        };
        let colour =
            |value: f64| if value.is_nan() { NOT_MEASURED } else { colour_index((value - range.start()) / length) };
        let row = |row: usize| (0..columns).map(move |column| colour(mean(column, row)));
        Picture {
            columns,
            rows,
            indices: (0..rows).rev().flat_map(row).collect(),
            palette: colour_map().into_iter().chain([MISSING]).collect(),
        }
    }
}

/// Windows in which a surface is shown that is so much longer along x than along y.
pub fn windows(elongation: f64) -> usize {
    ((elongation / ELONGATION).round() as usize).clamp(1, MOST_WINDOWS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_grows_upward_and_missing_points_are_grey() {
        let heights = [0.0, 1.0, f64::NAN, 0.5];
        let grid = Grid { columns: 2, rows: 2, pitch: None, heights: &heights };
        let picture = Raster::of(&grid, 0.0).picture(&(0.0..=1.0), 0..2, [2, 2]).stretched(2, 2);
        // By hand: the upper line holds row 1, the heights 1 and 0.5; the lower one row 0, 0 and the missing point.
        let map = colour_map();
        let colours = [map[COLOURS - 1], map[usize::from(colour_index(0.5))], map[0], MISSING];
        assert_eq!(picture, colours.iter().flat_map(|colour| [colour.0, colour.1, colour.2]).collect::<Vec<_>>());
    }

    #[test]
    fn many_points_are_averaged() {
        // In proportion of 1 to 3: one window.
        let (columns, rows) = (2 * MOST_POINTS + 1, 3);
        let pitch = Some([1.0, columns as f64]);
        let heights: Vec<f64> = (0..columns * rows).map(|point| (point / rows % 3) as f64).collect();
        let raster = Raster::of(&Grid { columns, rows, pitch, heights: &heights }, 1.0);
        assert_eq!((raster.columns, raster.rows), (columns.div_ceil(3), 3));
        assert!(raster.values[..raster.values.len() - 3].iter().all(|value| value.abs() < 1e-15));
    }

    #[test]
    fn fewer_pixels_show_means_and_not_single_points() {
        // Stripes of 0 and 1, two points long, on a quarter as many pixels: each pixel has two of both, the mean is one half.
        let heights: Vec<f64> = (0..400).map(|point| ((point / 2 / 2) % 2) as f64).collect();
        let raster = Raster::of(&Grid { columns: 200, rows: 2, pitch: Some([1.0, 100.0]), heights: &heights }, 0.0);
        let picture = raster.picture(&(0.0..=1.0), 0..200, [50, 10]);
        assert_eq!((picture.columns, picture.rows), (50, 2));
        assert!(picture.indices.iter().all(|index| *index == colour_index(0.5)), "{:?}", picture.indices);
        // A window of two has the columns that the whole has there.
        assert_eq!(raster.window(1, 2), 100..200);
        let half = raster.picture(&(0.0..=1.0), raster.window(1, 2), [100, 2]);
        let whole = raster.picture(&(0.0..=1.0), 0..200, [200, 2]);
        assert_eq!(half.indices[..100], whole.indices[100..200]);
    }
}
