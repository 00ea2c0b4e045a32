//! Capsules: rectangles with round ends, the outlines of fibres, and the cells that they cover.

use std::ops::Range;

use crate::model::mesh::Mesh;

/// All points within `radius` of a straight segment.
pub(super) struct Capsule {
    pub(super) centre: (f64, f64),
    pub(super) direction: (f64, f64),
    half_segment: f64,
    radius: f64,
}

impl Capsule {
    /// A capsule of this length from end to end, turned by an angle, rad.
    pub(super) fn new(centre: (f64, f64), angle: f64, length: f64, width: f64) -> Self {
        let direction = (libm::cos(angle), libm::sin(angle));
        Self { centre, direction, half_segment: 0.5 * (length - width), radius: 0.5 * width }
    }

    fn contains(&self, x: f64, y: f64) -> bool {
        let (x, y) = (x - self.centre.0, y - self.centre.1);
        let along = x * self.direction.0 + y * self.direction.1;
        let across = y * self.direction.0 - x * self.direction.1;
        let beyond = (along.abs() - self.half_segment).max(0.0);
        beyond * beyond + across * across <= self.radius * self.radius
    }

    /// Columns and rows of the pin in which the capsule may be.
    fn reach(&self, mesh: &Mesh) -> [Range<usize>; 2] {
        let reach_x = self.half_segment * self.direction.0.abs() + self.radius;
        let reach_y = self.half_segment * self.direction.1.abs() + self.radius;
        [
            span(self.centre.0, reach_x, mesh.column_width(), mesh.pin_columns()),
            span(self.centre.1, reach_y, mesh.row_height(), mesh.rows()),
        ]
    }

    /// Cells that are looked at to find those of the capsule.
    pub(super) fn box_cells(&self, mesh: &Mesh) -> u64 {
        let [columns, rows] = self.reach(mesh);
        columns.len() as u64 * rows.len() as u64
    }

    /// Cells of the pin whose centres lie in the capsule.
    pub(super) fn cells(&self, mesh: &Mesh) -> impl Iterator<Item = usize> {
        let (width, height, rows) = (mesh.column_width(), mesh.row_height(), mesh.rows());
        let [columns, row_range] = self.reach(mesh);
        columns
            .flat_map(move |column| row_range.clone().map(move |row| (column, row)))
            .filter(move |(column, row)| self.contains((*column as f64 + 0.5) * width, (*row as f64 + 0.5) * height))
            .map(move |(column, row)| column * rows + row)
    }
}

/// Indices of the cells that reach into centre ± reach. The cast saturates at 0.
fn span(centre: f64, reach: f64, cell: f64, count: usize) -> Range<usize> {
    let first = (((centre - reach) / cell) as usize).min(count);
    let last = libm::ceil((centre + reach) / cell) as usize;
    first..last.min(count)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_capsule_has_the_area_of_a_rectangle_and_a_circle() {
        // The count of centres in a convex shape misses its area by less than its perimeter times a cell's half
        // diagonal.
        // Square cells of 10 µm at the mean radius, pin of 4 mm by 2 mm.
        let mean_radius = 1e-5 * 4000.0 / (2.0 * PI);
        let mesh = Mesh::new(200, 4000, 400, mean_radius - 1e-3, mean_radius + 1e-3).unwrap();
        let centre = (2e-3, 1e-3);
        for (length, width) in [(400e-6, 100e-6), (300e-6, 300e-6), (900e-6, 40e-6)] {
            for angle in [0.0, 0.3, 1.2, PI / 2.0, 2.5] {
                let cells = Capsule::new(centre, angle, length, width).cells(&mesh).count() as f64;
                let area = (length - width) * width + PI * width * width / 4.0;
                let perimeter = 2.0 * (length - width) + PI * width;
                let tolerance = perimeter * 1e-5 / 2.0_f64.sqrt();
                assert!((cells * 1e-10 - area).abs() < tolerance, "{length} {width} {angle}: {cells}");
            }
        }
    }
}
