//! How large plateaus are: connected cells and the areas that they have together.
//!
//! Cells are connected where they share an edge; the columns of the disc close round the ring.

use crate::model::mesh::Mesh;

/// Areas of the plateaus of a body, m², the largest first. `in_plateau` tells it of every cell, column by column; the
/// body is the whole ring when it has as many columns, and closes then.
pub fn plateau_areas(mesh: &Mesh, in_plateau: &[bool]) -> Vec<f64> {
    let rows = mesh.rows();
    let columns = in_plateau.len() / rows;
    let closed = columns == mesh.disc_columns();
    let mut left = in_plateau.to_vec();
    let mut areas = Vec::new();
    let mut reached = Vec::new();
    for first in 0..left.len() {
        if !std::mem::take(&mut left[first]) {
            continue;
        }
        reached.push(first);
        let mut area = 0.0;
        while let Some(cell) = reached.pop() {
            let (column, row) = (cell / rows, cell % rows);
            area += mesh.area()[row];
            let before = if column > 0 { Some(column - 1) } else { closed.then_some(columns - 1) };
            let after = if column + 1 < columns { Some(column + 1) } else { closed.then_some(0) };
            let beside = [before, after].map(|column| column.map(|column| column * rows + row));
            let [inward, outward] = [(row > 0).then(|| cell - 1), (row + 1 < rows).then_some(cell + 1)];
            let neighbours = [beside[0], beside[1], inward, outward].into_iter().flatten();
            reached.extend(neighbours.filter(|neighbour| std::mem::take(&mut left[*neighbour])));
        }
        areas.push(area);
    }
    areas.sort_unstable_by(|one, other| other.total_cmp(one));
    areas
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells from rows of text, the outermost first.
    fn cells(rows: &[&str]) -> Vec<bool> {
        let letters: Vec<Vec<char>> = rows.iter().rev().map(|row| row.chars().collect()).collect();
        (0..letters[0].len()).flat_map(|column| letters.iter().map(move |row| row[column] == '#')).collect()
    }

    /// Areas in cells of a mesh whose rows are so thin that all cells are as good as equal.
    fn sizes(disc_columns: usize, rows: &[&str]) -> Vec<f64> {
        let mesh = Mesh::new(rows.len(), disc_columns, 1, 1.0, 1.0 + 1e-9).unwrap();
        let one = mesh.area()[0];
        plateau_areas(&mesh, &cells(rows)).into_iter().map(|area| (area / one).round()).collect()
    }

    #[test]
    fn plateaus_are_counted_as_by_hand() {
        let rows = ["##..#.", ".#.##.", "...#.#", "#....#"];
        // A pin: diagonal neighbours are apart.
        assert_eq!(sizes(100, &rows), [4.0, 3.0, 2.0, 1.0]);
        // The whole ring: the last column lies beside the first.
        assert_eq!(sizes(6, &rows), [4.0, 3.0, 3.0]);
        assert_eq!(sizes(3, &["...", "..."]), [0.0; 0]);
    }

    #[test]
    fn one_plateau_of_all_cells_has_the_area_of_the_ring() {
        // Closed form: the annulus.
        let mesh = Mesh::new(7, 13, 5, 20e-3, 24e-3).unwrap();
        let annulus = std::f64::consts::PI * (24e-3_f64.powi(2) - 20e-3_f64.powi(2));
        let areas = plateau_areas(&mesh, &vec![true; mesh.disc_cells()]);
        assert_eq!(areas.len(), 1);
        assert!((areas[0] / annulus - 1.0).abs() < 1e-12);
        let single = Mesh::new(1, 1, 1, 1.0, 2.0).unwrap();
        assert_eq!(plateau_areas(&single, &[true]), single.area());
    }

    #[test]
    fn cells_farther_out_count_more() {
        // By hand: A = r Δr Δθ, so two cells of rows 0 and 1 around r = 1.5 and 2.5 are as 3 to 5.
        let mesh = Mesh::new(2, 10, 3, 1.0, 3.0).unwrap();
        let areas = plateau_areas(&mesh, &[true, false, false, true, false, false]);
        assert!((areas[0] / areas[1] - 5.0 / 3.0).abs() < 1e-14);
    }
}
