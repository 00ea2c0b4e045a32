//! Profile by profile, as most files have heights, to column by column, as [`Patch`] has them, and back.

use std::io;

use plateau_core::surface::Patch;

/// Profiles that are turned together: each column is then written, or read, a whole cache line or two at a time.
const BLOCK: usize = 16;
/// Columns whose lines stay in the first-level cache while a block is turned.
const TILE: usize = 8;

/// Takes heights in the order of a file, x growing fastest, and stores them column by column.
pub(super) struct Profiles {
    columns: usize,
    rows: usize,
    /// The first profile has the largest y.
    downward: bool,
    heights: Vec<f64>,
    /// The last profiles, not turned yet.
    block: Vec<f64>,
    /// Profiles turned so far.
    done: usize,
}

impl Profiles {
    /// Room for `columns` times `rows` heights, which the caller has compared with the size of the file.
    pub(super) fn new(columns: usize, rows: usize) -> Self {
        let block = Vec::with_capacity(columns.saturating_mul(BLOCK.min(rows)));
        Self { columns, rows, downward: false, heights: vec![f64::NAN; columns * rows], block, done: 0 }
    }

    /// As [`Self::new`], for files whose first profile has the largest y.
    pub(super) fn downward(columns: usize, rows: usize) -> Self {
        Self { downward: true, ..Self::new(columns, rows) }
    }

    /// Heights that are not there yet.
    pub(super) fn missing(&self) -> usize {
        self.heights.len() - self.len()
    }

    /// Heights taken so far.
    pub(super) fn len(&self) -> usize {
        self.done * self.columns + self.block.len()
    }

    /// Takes the next height; more than there is room for are dropped.
    #[inline]
    pub(super) fn push(&mut self, height: f64) {
        self.block.push(height);
        if self.block.len() == self.columns * BLOCK {
            self.turn();
        }
    }

    /// The heights, column by column; NaN where none was given.
    pub(super) fn finish(mut self) -> Vec<f64> {
        self.turn();
        self.heights
    }

    fn turn(&mut self) {
        let profiles = (self.block.len() / self.columns).min(self.rows - self.done);
        for tile in (0..self.columns).step_by(TILE) {
            for profile in 0..profiles {
                let y = self.done + profile;
                let row = if self.downward { self.rows - 1 - y } else { y };
                for column in tile..self.columns.min(tile + TILE) {
                    self.heights[column * self.rows + row] = self.block[profile * self.columns + column];
                }
            }
        }
        self.done += profiles;
        self.block.clear();
    }
}

/// Gives `take` every profile of a patch, y growing, or falling if `downward`.
///
/// # Errors
/// What `take` says.
pub(super) fn for_each_profile(
    patch: &Patch,
    downward: bool,
    mut take: impl FnMut(&[f64]) -> io::Result<()>,
) -> io::Result<()> {
    let Patch { columns, rows, ref heights, .. } = *patch;
    let mut block = vec![0.0; columns * BLOCK.min(rows)];
    for start in (0..rows).step_by(BLOCK) {
        let profiles = BLOCK.min(rows - start);
        for tile in (0..columns).step_by(TILE) {
            for profile in 0..profiles {
                let y = start + profile;
                let row = if downward { rows - 1 - y } else { y };
                for column in tile..columns.min(tile + TILE) {
                    block[profile * columns + column] = heights[column * rows + row];
                }
            }
        }
        block.chunks_exact(columns).take(profiles).try_for_each(&mut take)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The height of the point (column, row), different everywhere.
    fn height(column: usize, row: usize) -> f64 {
        (1000 * column + row) as f64
    }

    #[test]
    fn turns_there_and_back() {
        for (columns, rows) in [(1, 1), (1, 40), (40, 1), (16, 16), (17, 33), (7, 100), (100, 7)] {
            for downward in [false, true] {
                let mut profiles =
                    if downward { Profiles::downward(columns, rows) } else { Profiles::new(columns, rows) };
                let order: Vec<usize> = if downward { (0..rows).rev().collect() } else { (0..rows).collect() };
                for row in &order {
                    (0..columns).for_each(|column| profiles.push(height(column, *row)));
                }
                assert_eq!(profiles.missing(), 0);
                let heights = profiles.finish();
                for (index, found) in heights.iter().enumerate() {
                    assert_eq!(*found, height(index / rows, index % rows));
                }
                let patch = Patch { columns, rows, column_pitch: 1.0, row_pitch: 1.0, heights };
                let mut row = order.iter();
                for_each_profile(&patch, downward, |profile| {
                    let row = *row.next().ok_or(io::ErrorKind::Other)?;
                    assert!((0..columns).all(|column| profile[column] == height(column, row)));
                    assert_eq!(profile.len(), columns);
                    Ok(())
                })
                .unwrap();
                assert_eq!(row.next(), None);
            }
        }
    }

    #[test]
    fn what_is_not_given_is_missing_and_what_is_too_much_is_dropped() {
        let mut profiles = Profiles::new(2, 2);
        [1.0, 2.0].into_iter().for_each(|height| profiles.push(height));
        assert_eq!(profiles.missing(), 2);
        let heights = profiles.finish();
        assert!(heights[0] == 1.0 && heights[1].is_nan() && heights[2] == 2.0 && heights[3].is_nan());
        let mut profiles = Profiles::new(1, 1);
        (0..100).for_each(|height| profiles.push(f64::from(height)));
        assert_eq!(profiles.finish(), [0.0]);
    }
}
