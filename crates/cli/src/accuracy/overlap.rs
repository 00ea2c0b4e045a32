//! Which cells of a fine mesh lie in a cell of a coarse one, along one direction.

/// For every coarse cell the fine cells that it overlaps, each with the measure of what they share.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlap(Vec<Vec<(usize, f64)>>);

impl Overlap {
    /// Overlap of equal divisions of one interval; lengths count.
    pub fn of_lengths(fine: usize, coarse: usize) -> Self {
        Self::new(&division([0.0, 1.0], fine), &division([0.0, 1.0], coarse), |low, high| high - low)
    }

    /// Overlap of equal divisions of a range of radii; areas count, as between circles of these radii.
    pub fn of_rings(radii: [f64; 2], fine: usize, coarse: usize) -> Self {
        Self::new(&division(radii, fine), &division(radii, coarse), |low, high| 0.5 * (high - low) * (high + low))
    }

    fn new(fine: &[f64], coarse: &[f64], measure: impl Fn(f64, f64) -> f64) -> Self {
        let shared = |cell: &[f64]| {
            let first = fine.partition_point(|edge| *edge <= cell[0]).saturating_sub(1);
            let pieces = fine.windows(2).enumerate().skip(first).take_while(|(_, piece)| piece[0] < cell[1]);
            let shares = pieces.map(|(index, piece)| (index, piece[0].max(cell[0]), piece[1].min(cell[1])));
            shares.filter(|(_, low, high)| low < high).map(|(index, low, high)| (index, measure(low, high))).collect()
        };
        Self(coarse.windows(2).map(shared).collect())
    }

    /// The coarse cells, one after the other.
    pub fn cells(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        self.0.iter().map(Vec::as_slice)
    }
}

/// Ends of the cells of an interval that is divided into equal ones.
fn division([begin, end]: [f64; 2], cells: usize) -> Vec<f64> {
    (0..=cells).map(|edge| begin + (end - begin) * (edge as f64 / cells as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::Overlap;

    #[test]
    fn cells_are_cut_where_they_must_be() {
        // Three cells of 1/3 in two of 1/2: the middle one is cut in halves of 1/6.
        let overlap = Overlap::of_lengths(3, 2);
        let cells: Vec<_> = overlap.cells().collect();
        for (cell, expected) in cells.iter().zip([[(0, 1.0 / 3.0), (1, 1.0 / 6.0)], [(1, 1.0 / 6.0), (2, 1.0 / 3.0)]]) {
            assert_eq!(cell.len(), 2);
            for ((index, share), (expected_index, expected)) in cell.iter().zip(expected) {
                assert!(*index == expected_index && (share - expected).abs() < 1e-15, "{cell:?}");
            }
        }
    }

    #[test]
    fn rings_count_by_their_areas() {
        // Between radii 1 and 3 in two rings: (2² − 1²)/2 and (3² − 2²)/2.
        let overlap = Overlap::of_rings([1.0, 3.0], 2, 1);
        assert_eq!(overlap.cells().next().unwrap(), [(0, 1.5), (1, 2.5)]);
    }
}
