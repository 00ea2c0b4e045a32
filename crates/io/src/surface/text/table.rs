//! What a text file holds.

/// Heights of a text file, m, column by column. A profile has one row.
#[derive(Debug)]
pub(in crate::surface) struct Table {
    pub(in crate::surface) columns: usize,
    pub(in crate::surface) rows: usize,
    pub(in crate::surface) pitch: Option<[f64; 2]>,
    pub(in crate::surface) heights: Vec<f64>,
    pub(in crate::surface) notes: Vec<String>,
    pub(in crate::surface) warnings: Vec<String>,
}
