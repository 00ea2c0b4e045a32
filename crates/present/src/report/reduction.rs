//! How much is left out of maps so that a page does not become too large.

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

#[cfg(test)]
mod tests {
    use super::Reduction;

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
}
