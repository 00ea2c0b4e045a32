//! A map of heights, reduced to what a picture shows.

use std::ops::RangeInclusive;

use plateau_core::surface::describe::Grid;

use super::picture::Picture;
use crate::colour::{COLOURS, MISSING, colour_index, colour_map};

/// Number of the colour of points that were not measured.
const NOT_MEASURED: u8 = COLOURS as u8;
/// Points along a side that a picture shows, at most.
const MOST_POINTS: usize = 1500;

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
        let blocks = |points: usize| points.div_ceil(MOST_POINTS).max(1);
        let (wide, high) = (blocks(grid.columns), blocks(grid.rows));
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

    /// A picture with a point for every value, from the top, where y is largest; `range` spans the colour map.
    pub fn picture(&self, range: &RangeInclusive<f64>) -> Picture {
        let length = range.end() - range.start();
        let colour =
            |value: f64| if value.is_nan() { NOT_MEASURED } else { colour_index((value - range.start()) / length) };
        let row = |row: usize| (0..self.columns).map(move |column| colour(self.values[column * self.rows + row]));
        Picture {
            columns: self.columns,
            rows: self.rows,
            indices: (0..self.rows).rev().flat_map(row).collect(),
            palette: colour_map().into_iter().chain([MISSING]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_grows_upward_and_missing_points_are_grey() {
        let heights = [0.0, 1.0, f64::NAN, 0.5];
        let grid = Grid { columns: 2, rows: 2, pitch: None, heights: &heights };
        let picture = Raster::of(&grid, 0.0).picture(&(0.0..=1.0)).stretched(2, 2);
        // By hand: the upper line holds row 1, the heights 1 and 0.5; the lower one row 0, 0 and the missing point.
        let map = colour_map();
        let colours = [map[COLOURS - 1], map[usize::from(colour_index(0.5))], map[0], MISSING];
        assert_eq!(picture, colours.iter().flat_map(|colour| [colour.0, colour.1, colour.2]).collect::<Vec<_>>());
    }

    #[test]
    fn many_points_are_averaged() {
        let (columns, rows) = (2 * MOST_POINTS + 1, 3);
        let heights: Vec<f64> = (0..columns * rows).map(|point| (point / rows % 3) as f64).collect();
        let raster = Raster::of(&Grid { columns, rows, pitch: None, heights: &heights }, 1.0);
        assert_eq!((raster.columns, raster.rows), (columns.div_ceil(3), 3));
        assert!(raster.values[..raster.values.len() - 3].iter().all(|value| value.abs() < 1e-15));
    }
}
