//! A line continued by its mirror image.

/// Index of the point that lies `at` - `reach` points after the first of `count`, mirrored at either end: the end points
/// come twice, so that the mirror stands half a pitch beyond them.
pub(super) fn mirrored(at: usize, reach: usize, count: usize) -> usize {
    // A whole number of periods is added so that the difference is not negative.
    let period = 2 * count;
    let place = (at + reach.div_ceil(period) * period - reach) % period;
    place.min(period - 1 - place)
}

#[cfg(test)]
mod tests {
    use super::mirrored;

    #[test]
    fn mirrors_at_the_edges() {
        let places: Vec<usize> = (0..13).map(|at| mirrored(at, 5, 3)).collect();
        assert_eq!(places, [1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
    }
}
