//! Lines of equal value through a grid of values.

use std::collections::BTreeMap;

/// A side of a square of the grid: the lower left of its two points, and whether it goes to the right or upward.
type Side = (usize, usize, bool);

/// Values on the points of a grid, the columns of which are `rows` long; NaN where there is none.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    /// Column by column, from below.
    pub values: &'a [f64],
    /// Points of a column.
    pub rows: usize,
}

impl Field<'_> {
    /// The lines on which the field has a value, in columns and rows from the lower left point: open ones end at the rim,
    /// closed ones where they begin.
    ///
    /// Every square of the grid is crossed from side to side; where the value is met on all four sides, the mean of the
    /// corners tells which belong together. A square with a corner that has no value is not crossed.
    pub fn contours(&self, level: f64) -> Vec<Vec<[f64; 2]>> {
        let columns = self.values.len() / self.rows.max(1);
        let mut neighbours: BTreeMap<Side, Vec<Side>> = BTreeMap::new();
        for column in 0..columns.saturating_sub(1) {
            for row in 0..self.rows.saturating_sub(1) {
                for [one, other] in self.crossings(column, row, level) {
                    neighbours.entry(one).or_default().push(other);
                    neighbours.entry(other).or_default().push(one);
                }
            }
        }
        let mut lines = Vec::new();
        // Open lines first: those that are left then are closed.
        for open in [true, false] {
            while let Some(first) = neighbours.iter().find(|(_, next)| !open || next.len() == 1).map(|(side, _)| *side)
            {
                let sides = follow(&mut neighbours, first);
                lines.push(sides.into_iter().map(|side| self.place(side, level)).collect());
            }
        }
        lines
    }

    fn value(&self, column: usize, row: usize) -> f64 {
        self.values[column * self.rows + row]
    }

    /// The pairs of sides between which a line crosses a square.
    fn crossings(&self, column: usize, row: usize, level: f64) -> Vec<[Side; 2]> {
        // Round the square from the lower left.
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(right, up)| self.value(column + right, row + up));
        let sides = [(column, row, true), (column + 1, row, false), (column, row + 1, true), (column, row, false)];
        if corners.iter().any(|corner| corner.is_nan()) {
            return Vec::new();
        }
        let above = corners.map(|corner| corner >= level);
        let met: Vec<usize> = (0..4).filter(|side| above[*side] != above[(side + 1) % 4]).collect();
        match met[..] {
            [one, other] => vec![[sides[one], sides[other]]],
            [_, _, _, _] => {
                let middle_above = 0.25 * corners.iter().sum::<f64>() >= level;
                let cut_first = above[0] != middle_above;
                let pairs = if cut_first { [[3, 0], [1, 2]] } else { [[0, 1], [2, 3]] };
                pairs.map(|pair| pair.map(|side| sides[side])).to_vec()
            }
            _ => Vec::new(),
        }
    }

    /// Where on a side the value is, as on a straight line between its ends.
    fn place(&self, (column, row, to_right): Side, level: f64) -> [f64; 2] {
        let end = if to_right { (column + 1, row) } else { (column, row + 1) };
        let (from, to) = (self.value(column, row), self.value(end.0, end.1));
        let part = (level - from) / (to - from);
        let (x, y) = (column as f64, row as f64);
        if to_right { [x + part, y] } else { [x, y + part] }
    }
}

/// Goes from side to side until there is none left, and forgets the ways it went.
fn follow(neighbours: &mut BTreeMap<Side, Vec<Side>>, first: Side) -> Vec<Side> {
    let mut line = vec![first];
    let mut here = first;
    while let Some(next) = neighbours.get_mut(&here).and_then(Vec::pop) {
        if let Some(back) = neighbours.get_mut(&next)
            && let Some(at) = back.iter().position(|side| *side == here)
        {
            back.remove(at);
        }
        for side in [here, next] {
            if neighbours.get(&side).is_some_and(Vec::is_empty) {
                neighbours.remove(&side);
            }
        }
        line.push(next);
        here = next;
    }
    line
}

#[cfg(test)]
mod tests {
    use super::Field;

    fn field(points: usize, value: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        (0..points * points).map(|at| value((at / points) as f64, (at % points) as f64)).collect()
    }

    #[test]
    fn lines_of_a_plane_are_straight_and_open() {
        let values = field(11, |x, y| x + 2.0 * y);
        let lines = Field { values: &values, rows: 11 }.contours(10.3);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].iter().all(|[x, y]| (x + 2.0 * y - 10.3).abs() < 1e-12));
        let ends = [lines[0][0], lines[0][lines[0].len() - 1]];
        assert!(ends.iter().all(|[x, y]| [*x, *y].iter().any(|part| *part == 0.0 || *part == 10.0)));
    }

    #[test]
    fn lines_round_a_peak_are_closed() {
        let values = field(41, |x, y| -(x - 20.0).powi(2) - (y - 20.0).powi(2));
        let lines = Field { values: &values, rows: 41 }.contours(-100.0);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        assert!(lines[0].iter().all(|[x, y]| ((x - 20.0).hypot(y - 20.0) - 10.0).abs() < 0.05));
    }

    #[test]
    fn a_saddle_has_two_lines_on_either_side() {
        let values = field(21, |x, y| (x - 10.0) * (y - 10.0));
        for level in [-20.0, 20.0] {
            let lines = Field { values: &values, rows: 21 }.contours(level);
            assert_eq!(lines.len(), 2);
            assert!(lines.iter().flatten().all(|[x, y]| ((x - 10.0) * (y - 10.0) - level).abs() < 1.0));
        }
        let right = field(21, |x, y| if x < 10.0 { f64::NAN } else { (x - 10.0) * (y - 10.0) });
        assert_eq!(Field { values: &right, rows: 21 }.contours(20.0).len(), 1);
        assert!(Field { values: &values, rows: 21 }.contours(1e3).is_empty());
        assert!(Field { values: &[], rows: 0 }.contours(1.0).is_empty());
    }
}
