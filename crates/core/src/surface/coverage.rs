//! Which points of a patch lie within what was measured, and the largest rectangle of such points.

use super::Patch;

/// Whether each point lies within what was measured: all but the missing points that other missing points join to the edge
/// of the patch, or to the point with the index `outside`. Any other gap with measured points all round it lies within.
pub(super) fn within_measurement(patch: &Patch, outside: Option<usize>) -> Vec<bool> {
    let Patch { columns, rows, ref heights, .. } = *patch;
    let mut within = vec![true; heights.len()];
    let is_outside = |index: usize| {
        let (column, row) = (index / rows, index % rows);
        let on_edge = column == 0 || row == 0 || column + 1 == columns || row + 1 == rows;
        on_edge || outside == Some(index)
    };
    let mut found: Vec<usize> =
        (0..heights.len()).filter(|index| heights[*index].is_nan() && is_outside(*index)).collect();
    found.iter().for_each(|index| within[*index] = false);
    while let Some(index) = found.pop() {
        let (column, row) = (index / rows, index % rows);
        let neighbours = [
            (column > 0).then(|| index - rows),
            (column + 1 < columns).then(|| index + rows),
            (row > 0).then(|| index - 1),
            (row + 1 < rows).then(|| index + 1),
        ];
        for neighbour in neighbours.into_iter().flatten() {
            if within[neighbour] && heights[neighbour].is_nan() {
                within[neighbour] = false;
                found.push(neighbour);
            }
        }
    }
    within
}

/// Columns and rows of a grid, as the first and the number of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub(super) first: [usize; 2],
    pub(super) count: [usize; 2],
}

/// The rectangle with the most points, all of them within; the first of several. `None` where no point is.
///
/// Column by column: how far the points reach back in each row makes a skyline, whose largest rectangle a stack of rising
/// heights finds in one pass (the largest rectangle in a histogram).
pub(super) fn largest_rectangle(within: &[bool], rows: usize) -> Option<Rectangle> {
    let mut back = vec![0; rows];
    let mut best: Option<Rectangle> = None;
    for (column, points) in within.chunks_exact(rows).enumerate() {
        back.iter_mut().zip(points).for_each(|(back, within)| *back = if *within { *back + 1 } else { 0 });
        // Rows from which on the points reach back at least so far; both rise along the stack.
        let mut rising: Vec<(usize, usize)> = Vec::new();
        for row in 0..=rows {
            let here = back.get(row).copied().unwrap_or(0);
            let mut first = row;
            while let Some((start, depth)) = rising.pop_if(|(_, depth)| *depth >= here) {
                first = start;
                let count = [depth, row - start];
                if depth > 0 && best.is_none_or(|best| count[0] * count[1] > best.count[0] * best.count[1]) {
                    best = Some(Rectangle { first: [column + 1 - depth, start], count });
                }
            }
            rising.push((first, here));
        }
    }
    best
}

/// The longest run of columns all of whose points are within, as a rectangle of all rows; the first of several.
pub(super) fn longest_run(within: &[bool], rows: usize) -> Option<Rectangle> {
    let mut best: Option<Rectangle> = None;
    let mut run = 0;
    for (column, points) in within.chunks_exact(rows).enumerate() {
        run = if points.iter().all(|within| *within) { run + 1 } else { 0 };
        if run > best.map_or(0, |best| best.count[0]) {
            best = Some(Rectangle { first: [column + 1 - run, 0], count: [run, rows] });
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Columns side by side, rows from top to bottom; a dot is a missing point.
    fn grid(lines: &[&str]) -> (Vec<bool>, usize) {
        let columns = lines[0].len();
        let points = (0..columns).flat_map(|x| lines.iter().map(move |line| line.as_bytes()[x] != b'.'));
        (points.collect(), lines.len())
    }

    #[test]
    fn a_gap_within_is_no_edge() {
        let (there, rows) = grid(&["..####", ".#.###", "###..#", "######", "####.#"]);
        let heights = there.iter().map(|there| if *there { 1.0 } else { f64::NAN }).collect();
        let patch = Patch { columns: 6, rows, column_pitch: 1.0, row_pitch: 1.0, heights };
        // The gaps in the middle touch the edge at no side, only at corners.
        let (expected, _) = grid(&["..####", ".#####", "######", "######", "####.#"]);
        assert_eq!(within_measurement(&patch, None), expected);
        let (expected, _) = grid(&["..####", ".#####", "###..#", "######", "####.#"]);
        assert_eq!(within_measurement(&patch, Some(3 * rows + 2)), expected);
    }

    #[test]
    fn the_longest_run_has_all_rows() {
        let (within, rows) = grid(&["##.####", "#####.#"]);
        assert_eq!(longest_run(&within, rows), Some(Rectangle { first: [0, 0], count: [2, 2] }));
        assert_eq!(longest_run(&[false, true], 2), None);
    }

    proptest! {
        #[test]
        fn no_rectangle_has_more_points(columns in 1_usize..8, rows in 1_usize..8, bits: u64, holes in 0_u32..4) {
            let within: Vec<bool> =
                (0..columns * rows).map(|i| holes == 0 || !bits.rotate_left(holes * 7 * i as u32).is_multiple_of(4)).collect();
            let is_full = |x: usize, y: usize, w: usize, h: usize| {
                (x..x + w).all(|column| (y..y + h).all(|row| within[column * rows + row]))
            };
            // Every rectangle there is.
            let mut most = 0;
            for (x, y) in (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y))) {
                for (w, h) in (1..=columns - x).flat_map(|w| (1..=rows - y).map(move |h| (w, h))) {
                    if is_full(x, y, w, h) {
                        most = most.max(w * h);
                    }
                }
            }
            match largest_rectangle(&within, rows) {
                None => prop_assert_eq!(most, 0),
                Some(Rectangle { first, count }) => {
                    prop_assert_eq!(count[0] * count[1], most);
                    prop_assert!(is_full(first[0], first[1], count[0], count[1]));
                }
            }
        }
    }
}
