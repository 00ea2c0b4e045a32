//! The cylindrical ring mesh of disc and pin (model section 1; paper 2.1, Table 2).

use std::f64::consts::TAU;
use std::ops::Range;

use thiserror::Error;

/// Error of a mesh that cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum MeshError {
    #[error("{name} is 0, expected at least 1")]
    Empty { name: &'static str },
    #[error(
        "{name} is {found}, expected at most {most}: beyond that, sums over all cells have no room; take larger cells"
    )]
    TooMany { name: &'static str, found: usize, most: usize },
    #[error("pin_columns is {pin_columns}, expected at most disc_columns = {disc_columns}")]
    PinWiderThanRing { pin_columns: usize, disc_columns: usize },
    #[error(
        "inner_radius is {inner:?} m and outer_radius is {outer:?} m, expected 0 < inner_radius < outer_radius, both finite"
    )]
    Radii { inner: f64, outer: f64 },
    #[error("a round pin of {diameter} m in diameter is wider than the track of {track} m")]
    RoundPinWiderThanTrack { diameter: f64, track: f64 },
    #[error("a round pin of {diameter} m in diameter goes beyond its {pin_columns} columns at the radius {radius} m")]
    RoundPinLongerThanColumns { diameter: f64, pin_columns: usize, radius: f64 },
    #[error(
        "no cell of the pin has its centre within a circle of {diameter} m in diameter about the middle of the track"
    )]
    RoundPinWithoutCells { diameter: f64 },
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
    outline: Outline,
    /// Columns of the pin that are there, by row; empty for a rectangle.
    chords: Vec<Range<usize>>,
}

/// Rows and columns for which the exact sums of the engine have room: docs/evidence/stability.md has the bounds of each.
const MOST_ROWS: usize = 1 << 22;
const MOST_COLUMNS: usize = 1 << 24;

/// Relative rounding that a diameter as large as the track is wide may have.
const ROUNDING: f64 = 1e-9;

impl Mesh {
    /// Divides the ring between the two radii (m) into cells.
    ///
    /// # Errors
    /// [`MeshError`] when a count is zero or too large, the pin is wider than the ring, or the radii do not span a ring.
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
        for (name, found, most) in [("rows", rows, MOST_ROWS), ("disc_columns", disc_columns, MOST_COLUMNS)] {
            if found > most {
                return Err(MeshError::TooMany { name, found, most });
            }
        }
        if pin_columns > disc_columns {
            return Err(MeshError::PinWiderThanRing { pin_columns, disc_columns });
        }
        if !(inner_radius > 0.0 && outer_radius > inner_radius && outer_radius.is_finite()) {
            return Err(MeshError::Radii { inner: inner_radius, outer: outer_radius });
        }
        let row_height = (outer_radius - inner_radius) / rows as f64;
        let column_angle = TAU / disc_columns as f64;
        let radius: Vec<f64> = (0..rows).map(|i| inner_radius + (i as f64 + 0.5) * row_height).collect();
        let area = radius.iter().map(|r| r * row_height * column_angle).collect();
        let (outline, chords) = (Outline::Rectangle, Vec::new());
        Ok(Self { rows, disc_columns, pin_columns, inner_radius, outer_radius, radius, area, outline, chords })
    }

    /// Mesh with a pin of this outline.
    ///
    /// # Errors
    /// [`MeshError`] when the outline goes beyond the pin's rows or columns, or no cell lies within it.
    pub fn with_outline(self, outline: Outline) -> Result<Self, MeshError> {
        let Outline::Disc { radius } = outline else {
            return Ok(Self { outline, chords: Vec::new(), ..self });
        };
        let (diameter, width) = (2.0 * radius, self.outer_radius - self.inner_radius);
        if !(diameter > 0.0 && diameter <= width * (1.0 + ROUNDING)) {
            return Err(MeshError::RoundPinWiderThanTrack { diameter, track: width });
        }
        let chord = |radius: &f64| {
            let chord = outline.chord(self.pin_columns, self.column_angle(), *radius, radius - self.mean_radius());
            let pin_columns = self.pin_columns;
            chord.ok_or(MeshError::RoundPinLongerThanColumns { diameter, pin_columns, radius: *radius })
        };
        let chords = self.radius.iter().map(chord).collect::<Result<Vec<_>, _>>()?;
        if chords.iter().all(Range::is_empty) {
            return Err(MeshError::RoundPinWithoutCells { diameter });
        }
        Ok(Self { outline, chords, ..self })
    }

    /// Outline of the pin.
    pub fn outline(&self) -> Outline {
        self.outline
    }

    /// Tells whether all cells of the pin's rows and columns are there.
    pub fn is_rectangle(&self) -> bool {
        self.chords.is_empty()
    }

    /// The columns of the pin that are there in a row.
    pub fn chord(&self, row: usize) -> Range<usize> {
        self.chords.get(row).cloned().unwrap_or(0..self.pin_columns)
    }

    /// Tells whether a cell of the pin is there, by its number.
    pub fn is_present(&self, cell: usize) -> bool {
        self.is_rectangle() || self.chord(cell % self.rows).contains(&(cell / self.rows))
    }

    /// Numbers of the cells within the pin's rows and columns that are not there.
    pub fn absent_cells(&self) -> impl Iterator<Item = usize> + '_ {
        let cells = if self.is_rectangle() { 0 } else { self.pin_cells() };
        (0..cells).filter(|cell| !self.is_present(*cell))
    }

    /// Area of every cell of the pin, m², column by column; 0 where it is not there.
    pub fn pin_areas(&self) -> impl Iterator<Item = f64> + '_ {
        let areas = (0..self.pin_columns).flat_map(|_| &self.area);
        areas.enumerate().map(|(cell, area)| if self.is_present(cell) { *area } else { 0.0 })
    }

    /// Cells of the pin that are there.
    pub fn present_cells(&self) -> usize {
        (0..self.rows).map(|row| self.chord(row).len()).sum()
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

    /// Cells of the pin's rows and columns, whether they are there or not.
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

    /// Area of all cells of the pin that are there, m².
    pub fn pin_area(&self) -> f64 {
        if self.is_rectangle() {
            return self.pin_columns as f64 * self.column_area();
        }
        self.chords.iter().zip(&self.area).map(|(chord, area)| chord.len() as f64 * area).sum()
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

/// Outline of the pin.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Outline {
    /// All cells of its rows and columns.
    #[default]
    Rectangle,
    /// The cells whose centres lie within a circle about the middle of the rectangle.
    Disc {
        /// Radius of the circle, m.
        radius: f64,
    },
}

impl Outline {
    /// Tells whether a cell is there whose centre lies so far (m) from the middle: `along` the sliding direction as arc length at the
    /// cell's own radius, `across` it as a difference of radii.
    fn contains(self, along: f64, across: f64) -> bool {
        match self {
            Self::Rectangle => true,
            Self::Disc { radius } => along * along + across * across <= radius * radius,
        }
    }

    /// The columns of the pin that are there in a row of this radius (m), `across` (m) away from the middle of the track; none
    /// where the outline goes beyond the columns.
    pub(super) fn chord(self, pin_columns: usize, column_angle: f64, radius: f64, across: f64) -> Option<Range<usize>> {
        // Exact in steps of one half, so that both sides of the middle are alike.
        let from_middle = |column: f64| column + 0.5 - 0.5 * pin_columns as f64;
        let is_there = |column: f64| self.contains(radius * (from_middle(column) * column_angle), across);
        if self != Self::Rectangle && is_there(-1.0) {
            return None;
        }
        // The chord is symmetric, so it is empty where no column up to the middle is there.
        let first = (0..pin_columns.div_ceil(2)).find(|column| is_there(*column as f64));
        Some(first.map_or(0..0, |first| first..pin_columns - first))
    }
}

/// Number of columns of the angle `column_angle` (rad) that a circle of this radius (m) about the mean radius (m) takes: its longest
/// arc, which lies a little inward of its middle, in columns, rounded. No cell of the circle is left out, and no column is
/// empty for want of one. `None` where the circle reaches the axis.
pub fn columns_of_disc(radius: f64, mean_radius: f64, column_angle: f64) -> Option<f64> {
    // Half the arc at the radius r is √(R² − (r − r̄)²)/r, which is largest where r = (r̄² − R²)/r̄.
    let farthest = (mean_radius - radius) * (mean_radius + radius);
    (farthest > 0.0).then(|| libm::round(2.0 * (radius / farthest.sqrt()) / column_angle).max(1.0))
}

#[cfg(test)]
#[path = "../../tests/unit/model/mesh.rs"]
mod tests;
