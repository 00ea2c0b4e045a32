//! Fewer cells and times of maps, so that a page does not become too large.

use plateau_core::observe::{ABSENT, MapValues};

/// Limits of what the maps of a run hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reduction {
    /// Blocks of cells in a map of one time, at most.
    pub cells: usize,
    /// Times, at most.
    pub times: usize,
}

/// No map is coarser than this because of its size.
const LEAST_CELLS: usize = 20_000;
/// No fewer times are left because of their size.
const LEAST_TIMES: usize = 2;

impl Reduction {
    /// As much as a screen shows.
    pub const NONE: Self = Self { cells: 250_000, times: 48 };

    /// A stronger one, for what took `size` bytes and may take `budget`; none if there is nothing left to take away.
    ///
    /// Places go before times, down to what still looks like a surface.
    pub fn stronger(self, size: usize, budget: usize) -> Option<Self> {
        let ratio = (0.9 * budget as f64 / size.max(1) as f64).clamp(0.05, 0.9);
        let less = |number: usize, least: usize| ((number as f64 * ratio) as usize).max(least);
        if self.cells > LEAST_CELLS {
            Some(Self { cells: less(self.cells, LEAST_CELLS), ..self })
        } else if self.times > LEAST_TIMES {
            Some(Self { times: less(self.times, LEAST_TIMES), ..self })
        } else {
            None
        }
    }

    /// Which of so many times are left: evenly many between the first and the last.
    pub fn times_of(self, count: usize) -> Vec<usize> {
        let most = self.times.max(LEAST_TIMES);
        if count <= most {
            return (0..count).collect();
        }
        (0..most).map(|index| index * (count - 1) / (most - 1)).collect()
    }
}

/// A map as the page has it: blocks of cells instead of cells, column by column.
#[derive(Debug, Clone, PartialEq)]
pub enum Coarse {
    /// Means of heights or pressures.
    Float(Vec<f64>),
    /// The most frequent status.
    Status(Vec<u8>),
}

/// How a body's cells are put together to blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Blocks {
    /// Cells of the body: columns and rows.
    pub cells: [usize; 2],
    /// Cells of a block along columns and rows; the last block of each has what is left.
    pub size: [usize; 2],
}

impl Blocks {
    /// Blocks about as wide as high, so large that there are at most so many of them.
    ///
    /// `cell_size` is the width and the height of a cell.
    pub fn at_most(most: usize, cells: [usize; 2], cell_size: [f64; 2]) -> Self {
        let mut blocks = Self { cells, size: [1, 1] };
        while blocks.count() > most.max(1) {
            let length = |direction: usize| blocks.size[direction] as f64 * cell_size[direction];
            let wide = length(0) > length(1);
            let direction = if blocks.shape()[0] == 1 || (wide && blocks.shape()[1] > 1) { 1 } else { 0 };
            // Ever larger steps: a long ring of one row needs thousands of cells in a block.
            blocks.size[direction] += 1 + blocks.size[direction] / 32;
        }
        blocks
    }

    /// Blocks along columns and rows.
    pub fn shape(&self) -> [usize; 2] {
        [0, 1].map(|direction| self.cells[direction].div_ceil(self.size[direction]))
    }

    /// Blocks of the body.
    pub fn count(&self) -> usize {
        self.shape().iter().product()
    }

    /// A map by blocks.
    pub fn coarsen(&self, values: &MapValues) -> Coarse {
        match values {
            MapValues::Float(values) => Coarse::Float(self.each(|cells| mean(cells.map(|cell| values[cell])))),
            MapValues::Status(values) => {
                Coarse::Status(self.each(|cells| most_frequent(cells.map(|cell| values[cell]))))
            }
        }
    }

    /// What `of` makes of the cells of every block.
    fn each<T>(&self, of: impl Fn(&mut dyn Iterator<Item = usize>) -> T) -> Vec<T> {
        let [columns, rows] = self.shape();
        let part = |block: usize, direction: usize| {
            let begin = block * self.size[direction];
            begin..(begin + self.size[direction]).min(self.cells[direction])
        };
        let block = |column: usize, row: usize| {
            let mut cells = part(column, 0).flat_map(|c| part(row, 1).map(move |r| c * self.cells[1] + r));
            of(&mut cells)
        };
        (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))).map(|(c, r)| block(c, r)).collect()
    }
}

/// Mean of the values that are there: cells beyond the pin's outline have none.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) =
        values.filter(|value| !value.is_nan()).fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// The status of most cells; of statuses with equally many the highest, which is the rarer one. Cells beyond the pin's outline
/// count only where there are no others.
fn most_frequent(statuses: impl Iterator<Item = u8>) -> u8 {
    let mut counts = [0_usize; 256];
    statuses.for_each(|status| counts[usize::from(status)] += 1);
    let absent = std::mem::take(&mut counts[usize::from(ABSENT)]);
    let most = (0..=u8::MAX).max_by_key(|status| counts[usize::from(*status)]).unwrap_or(0);
    if absent > 0 && counts[usize::from(most)] == 0 { ABSENT } else { most }
}

#[cfg(test)]
mod tests {
    use plateau_core::observe::MapValues;

    use super::*;

    #[test]
    fn it_ends() {
        let mut reduction = Reduction::NONE;
        let mut steps = 0;
        while let Some(stronger) = reduction.stronger(100, 99) {
            assert!(stronger.cells * stronger.times < reduction.cells * reduction.times);
            (reduction, steps) = (stronger, steps + 1);
            assert!(steps < 100);
        }
        assert_eq!((reduction.cells, reduction.times), (20_000, 2));
    }

    #[test]
    fn the_first_and_the_last_time_stay() {
        let few = Reduction { cells: 1, times: 4 };
        assert_eq!(few.times_of(3), [0, 1, 2]);
        assert_eq!(few.times_of(11), [0, 3, 6, 10]);
        assert!(few.times_of(0).is_empty());
    }

    #[test]
    fn small_maps_stay_as_they_are() {
        let blocks = Blocks::at_most(6, [3, 2], [1.0, 1.0]);
        assert_eq!(blocks.size, [1, 1]);
        let values = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(blocks.coarsen(&MapValues::Float(values.clone())), Coarse::Float(values));
    }

    #[test]
    fn blocks_are_means_and_majorities() {
        let blocks = Blocks { cells: [3, 3], size: [2, 2] };
        assert_eq!(blocks.shape(), [2, 2]);
        // By hand: columns (1 2 3), (4 5 6), (7 8 9); the blocks hold 1 2 4 5, 3 6, 7 8 and 9.
        let values = MapValues::Float((1..10).map(f64::from).collect());
        assert_eq!(blocks.coarsen(&values), Coarse::Float(vec![3.0, 4.5, 7.5, 9.0]));
        let statuses = MapValues::Status(vec![1, 1, 0, 1, 2, 2, 0, 0, 1]);
        assert_eq!(blocks.coarsen(&statuses), Coarse::Status(vec![1, 2, 0, 1]));
        // Beyond the outline of a pin there is nothing to take part.
        let values = MapValues::Float([f64::NAN, 2.0, 3.0, f64::NAN, 5.0, f64::NAN, 7.0, 8.0, f64::NAN].to_vec());
        let Coarse::Float(found) = blocks.coarsen(&values) else { panic!("means") };
        assert_eq!((&found[..3], found[3].is_nan()), (&[3.5, 3.0, 7.5][..], true));
        let statuses = MapValues::Status(vec![3, 3, 0, 3, 1, 3, 3, 3, 2]);
        assert_eq!(blocks.coarsen(&statuses), Coarse::Status(vec![1, 0, 3, 2]));
    }

    #[test]
    fn blocks_are_about_square_and_few_enough() {
        let blocks = Blocks::at_most(250_000, [13_800, 800], [10e-6, 5e-6]);
        assert!(blocks.count() <= 250_000 && blocks.count() > 200_000, "{blocks:?}");
        let [width, height] = [blocks.size[0] as f64 * 10e-6, blocks.size[1] as f64 * 5e-6];
        assert!((0.6..1.7).contains(&(width / height)), "{blocks:?}");
        let ring = Blocks::at_most(1000, [1_000_000, 1], [1.0, 1e9]);
        assert!(ring.count() <= 1000 && ring.count() > 900, "{ring:?}");
    }
}
