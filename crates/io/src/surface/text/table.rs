//! What a text file holds.

/// Heights of a text file, m, column by column. A profile has one row.
#[derive(Debug, Default)]
pub(in crate::surface) struct Table {
    pub(in crate::surface) columns: usize,
    pub(in crate::surface) rows: usize,
    pub(in crate::surface) pitch: Option<[f64; 2]>,
    /// The file does not say in which unit its distances are, and they were taken in that of its heights.
    pub(in crate::surface) is_pitch_assumed: bool,
    pub(in crate::surface) heights: Vec<f64>,
    pub(in crate::surface) notes: Vec<String>,
    pub(in crate::surface) warnings: Vec<String>,
}
