//! The cylindrical ring mesh of disc and pin (model section 1; paper 2.1, Table 2).

use std::f64::consts::TAU;
use std::ops::Range;

use thiserror::Error;

/// Why a mesh cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MeshError {
    /// A count of cells is zero.
    #[error("{name} is 0, expected at least 1")]
    Empty {
        /// Which count.
        name: &'static str,
    },
    /// The pin covers more columns than the ring has.
    #[error("pin_columns is {pin_columns}, expected at most disc_columns = {disc_columns}")]
    PinWiderThanRing {
        /// Columns asked for the pin.
        pin_columns: usize,
        /// Columns of the ring.
        disc_columns: usize,
    },
    /// The radii do not span a ring.
    #[error(
        "inner_radius is {inner} m and outer_radius is {outer} m, expected 0 < inner_radius < outer_radius, both finite"
    )]
    Radii {
        /// Inner radius, m.
        inner: f64,
        /// Outer radius, m.
        outer: f64,
    },
    /// The number of cells does not fit the address space.
    #[error("{rows} rows times {columns} columns are more cells than this machine can address")]
    TooLarge {
        /// Rows asked for.
        rows: usize,
        /// Columns asked for.
        columns: usize,
    },
}

/// Ring mesh: `rows` cells in r, `disc_columns` cells in θ around the ring, of which the pin covers `pin_columns`.
///
/// Fields over cells are stored column by column, all radii of a column contiguous: cell (row i, column c) is at
/// `c * rows + i`.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    rows: usize,
    disc_columns: usize,
    pin_columns: usize,
    inner_radius: f64,
    outer_radius: f64,
    radius: Vec<f64>,
    area: Vec<f64>,
}

impl Mesh {
    /// Divides the ring between the two radii (m) into cells.
    ///
    /// # Errors
    /// [`MeshError`] when a count is zero, the pin is wider than the ring, or the radii do not span a ring.
    pub fn new(
        rows: usize,
        disc_columns: usize,
        pin_columns: usize,
        inner_radius: f64,
        outer_radius: f64,
    ) -> Result<Self, MeshError> {
        for (name, count) in [("rows", rows), ("disc_columns", disc_columns), ("pin_columns", pin_columns)] {
            if count == 0 {
                return Err(MeshError::Empty { name });
            }
        }
        if pin_columns > disc_columns {
            return Err(MeshError::PinWiderThanRing { pin_columns, disc_columns });
        }
        if !(inner_radius > 0.0 && outer_radius > inner_radius && outer_radius.is_finite()) {
            return Err(MeshError::Radii { inner: inner_radius, outer: outer_radius });
        }
        let bytes = rows.checked_mul(disc_columns).and_then(|cells| cells.checked_mul(size_of::<f64>()));
        if bytes.is_none_or(|bytes| bytes > isize::MAX as usize) {
            return Err(MeshError::TooLarge { rows, columns: disc_columns });
        }
        let row_height = (outer_radius - inner_radius) / rows as f64;
        let column_angle = TAU / disc_columns as f64;
        let radius: Vec<f64> = (0..rows).map(|i| inner_radius + (i as f64 + 0.5) * row_height).collect();
        let area = radius.iter().map(|r| r * row_height * column_angle).collect();
        Ok(Self { rows, disc_columns, pin_columns, inner_radius, outer_radius, radius, area })
    }

    /// Cells in r.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Cells around the whole ring.
    pub fn disc_columns(&self) -> usize {
        self.disc_columns
    }

    /// Columns covered by the pin.
    pub fn pin_columns(&self) -> usize {
        self.pin_columns
    }

    /// Cells of the pin.
    pub fn pin_cells(&self) -> usize {
        self.rows * self.pin_columns
    }

    /// Cells of the disc ring.
    pub fn disc_cells(&self) -> usize {
        self.rows * self.disc_columns
    }

    /// The cells of a column, of pin or disc.
    pub fn column(&self, column: usize) -> Range<usize> {
        column * self.rows..(column + 1) * self.rows
    }

    /// Δr, m.
    pub fn row_height(&self) -> f64 {
        (self.outer_radius - self.inner_radius) / self.rows as f64
    }

    /// Δθ = 2π / disc_columns, rad.
    pub fn column_angle(&self) -> f64 {
        TAU / self.disc_columns as f64
    }

    /// Radius of the middle of the track, m.
    pub fn mean_radius(&self) -> f64 {
        0.5 * (self.inner_radius + self.outer_radius)
    }

    /// Arc length of one column at the mean radius, m.
    pub fn column_width(&self) -> f64 {
        self.mean_radius() * self.column_angle()
    }

    /// r_i of every row, m.
    pub fn radius(&self) -> &[f64] {
        &self.radius
    }

    /// A_i = r_i Δr Δθ, area of one cell of every row, m².
    pub fn area(&self) -> &[f64] {
        &self.area
    }

    /// Area of one column (all rows), m².
    pub(crate) fn column_area(&self) -> f64 {
        self.area.iter().sum()
    }

    /// Area of all cells of the pin, m².
    pub fn pin_area(&self) -> f64 {
        self.pin_columns as f64 * self.column_area()
    }

    /// Area of all cells of the disc ring, m².
    pub fn disc_area(&self) -> f64 {
        self.disc_columns as f64 * self.column_area()
    }

    /// c(j, n) = (j − n) mod disc_columns: the disc column under pin column `pin_column` in step `step`.
    pub fn disc_column(&self, pin_column: usize, step: u64) -> usize {
        let turned = (step % self.disc_columns as u64) as usize;
        (pin_column + self.disc_columns - turned) % self.disc_columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> Mesh {
        Mesh::new(80, 2764, 161, 20e-3, 24e-3).unwrap()
    }

    #[test]
    fn cells_tile_the_annulus() {
        // Closed form: the cells add up to π (r_outer² − r_inner²), for the midpoint rule is exact for r dr.
        let mesh = paper();
        let annulus = std::f64::consts::PI * (24e-3_f64.powi(2) - 20e-3_f64.powi(2));
        assert!((mesh.disc_area() / annulus - 1.0).abs() < 1e-13);
        assert!((mesh.row_height() - 50e-6).abs() < 1e-18);
    }

    #[test]
    fn a_disc_cell_enters_at_the_leading_edge_and_moves_toward_plus_j() {
        let mesh = paper();
        assert_eq!(mesh.disc_column(0, 0), 0);
        assert_eq!(mesh.disc_column(0, 1), 2763);
        for step in [0, 1, 160, 2763, 2764, 1_000_003] {
            for column in 0..160 {
                assert_eq!(mesh.disc_column(column, step), mesh.disc_column(column + 1, step + 1));
            }
        }
    }

    #[test]
    fn refuses_what_is_no_ring() {
        assert!(matches!(Mesh::new(0, 10, 5, 1.0, 2.0), Err(MeshError::Empty { name: "rows" })));
        assert!(matches!(Mesh::new(1, 10, 11, 1.0, 2.0), Err(MeshError::PinWiderThanRing { .. })));
        assert!(matches!(Mesh::new(1, 10, 5, 2.0, 1.0), Err(MeshError::Radii { .. })));
        assert!(matches!(Mesh::new(1, 10, 5, f64::NAN, 1.0), Err(MeshError::Radii { .. })));
        assert!(matches!(Mesh::new(1 << 40, 1 << 40, 5, 1.0, 2.0), Err(MeshError::TooLarge { .. })));
    }
}
