//! Heights on a rectangular grid, as an instrument gives them.

/// Heights on a rectangular grid with x along the sliding direction and y outward.
///
/// Stored like the mesh, column by column: the point (column x, row y) is at `x * rows + y`. A missing point is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Points along x.
    pub columns: usize,
    /// Points along y.
    pub rows: usize,
    /// Distance of neighbouring columns, m.
    pub column_pitch: f64,
    /// Distance of neighbouring rows, m.
    pub row_pitch: f64,
    /// Heights, m; NaN where there is none.
    pub heights: Vec<f64>,
}

impl Patch {
    /// Number of points without a height.
    pub fn missing(&self) -> usize {
        self.heights.iter().filter(|height| height.is_nan()).count()
    }

    /// Extent along x, m: every point stands for one pitch.
    pub fn length(&self) -> f64 {
        self.columns as f64 * self.column_pitch
    }

    /// Extent along y, m.
    pub fn height(&self) -> f64 {
        self.rows as f64 * self.row_pitch
    }
}
