//! Heights as an HDF5 file has them.

use plateau_core::surface::Body;

/// Heights of an HDF5 file, column by column.
pub(in crate::surface) struct Heights {
    pub(in crate::surface) columns: usize,
    pub(in crate::surface) rows: usize,
    /// Distance of neighbouring points along x and y, m, if the dataset states it.
    pub(in crate::surface) pitch: Option<[f64; 2]>,
    pub(in crate::surface) heights: Vec<f64>,
    /// The body of which a run recorded them.
    pub(in crate::surface) body: Option<Body>,
    /// What they are, one fact a line.
    pub(in crate::surface) notes: Vec<String>,
    /// What is to be warned of.
    pub(in crate::surface) warnings: Vec<String>,
}
