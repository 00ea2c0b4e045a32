//! A measured patch brought onto the mesh.

use super::preparation_error::PreparationError;
use super::{Body, Patch};
use crate::model::mesh::Mesh;

/// Lengths that differ by less than this are the same length.
const SAME_LENGTH: f64 = 1e-9;

/// Heights of every cell of `body` from a patch.
///
/// Cell (row i, column c) has its centre at x = (c + ½) column_width from the patch's first edge and
/// y = (i + ½) Δr − rows Δr/2 from the middle of the patch. It takes the mean of the patch over a window about its
/// centre, where a pixel has one height all over; the window is as wide as the cell or as a pixel, whichever is wider,
/// in either direction.
///
/// Where pixels are finer than cells this is the exact mean over the cell: wavelengths that the mesh cannot carry are
/// taken out (a wave of length λ by sin(πw/λ)/(πw/λ), w the cell's width) and the mean over all cells is the mean over
/// the part of the patch that they cover. Where pixels are coarser it is linear interpolation between their centres.
///
/// With `repeat` the patch is continued by its mirror image, that by the patch, and so on, in both directions: T(x, y) with the
/// period of two patches and no step at a seam. The ring is besides folded about its middle so that it closes without a
/// step: h(x, y) = T(min(x, L − x), y), L being its circumference.
pub(super) fn resample(patch: &Patch, repeat: bool, body: Body, mesh: &Mesh) -> Result<Vec<f64>, PreparationError> {
    fits(patch, repeat, body, mesh)?;
    // The middle of the track lies on the middle of the patch.
    let margin = 0.5 * (patch.height() - mesh.rows() as f64 * mesh.row_height());
    let grid = CellGrid {
        columns: body.columns(mesh),
        rows: mesh.rows(),
        cell: [mesh.column_width(), mesh.row_height()],
        first: [0.0, margin],
        fold: (repeat && body == Body::Disc).then(|| 0.5 * body.length(mesh)),
    };
    Ok(grid.heights(patch))
}

/// Cells over a patch, which is continued by its mirror images.
pub(super) struct CellGrid {
    pub columns: usize,
    pub rows: usize,
    /// Width and height of a cell, m.
    pub cell: [f64; 2],
    /// Where the first cell begins, from the patch's first corner, m.
    pub first: [f64; 2],
    /// Where the line along x is folded, m.
    pub fold: Option<f64>,
}

impl CellGrid {
    /// Heights of the cells, column by column: see [`resample`].
    pub fn heights(&self, patch: &Patch) -> Vec<f64> {
        let along_x = Axis { pixels: patch.columns, pitch: patch.column_pitch, cell: self.cell[0] };
        let along_y = Axis { pixels: patch.rows, pitch: patch.row_pitch, cell: self.cell[1] };
        let row_weights: Vec<Weights> = (0..self.rows).map(|row| along_y.weights(row, self.first[1], None)).collect();
        let mut heights = Vec::with_capacity(self.columns * self.rows);
        let mut profile = vec![0.0; patch.rows];
        for column in 0..self.columns {
            let column_weights = along_x.weights(column, self.first[0], self.fold);
            profile.fill(0.0);
            for (weight, pixels) in column_weights.pairs(patch.heights.chunks_exact(patch.rows)) {
                profile.iter_mut().zip(pixels).for_each(|(height, pixel)| *height += weight * pixel);
            }
            heights.extend(row_weights.iter().map(|row| row.pairs(&profile).map(|(w, z)| w * z).sum::<f64>()));
        }
        heights
    }
}

impl Patch {
    /// The patch in cells of this width and height, m, as far as whole ones fit: what a mesh sees of it.
    pub fn in_cells(&self, cell: [f64; 2]) -> Self {
        let whole = |length: f64, cell: f64| libm::floor(length / cell * (1.0 + SAME_LENGTH)) as usize;
        let [columns, rows] = [whole(self.length(), cell[0]), whole(self.height(), cell[1])];
        let heights = CellGrid { columns, rows, cell, first: [0.0; 2], fold: None }.heights(self);
        Self { columns, rows, column_pitch: cell[0], row_pitch: cell[1], heights }
    }
}

/// Refuses a patch that does not cover the body, or with `repeat` not even a cell.
fn fits(patch: &Patch, repeat: bool, body: Body, mesh: &Mesh) -> Result<(), PreparationError> {
    let (length, height) = (patch.length(), patch.height());
    if repeat {
        let cell = [mesh.column_width(), mesh.row_height()];
        let covers = length >= cell[0] * (1.0 - SAME_LENGTH) && height >= cell[1] * (1.0 - SAME_LENGTH);
        return if covers { Ok(()) } else { Err(PreparationError::SmallerThanCell { patch: [length, height], cell }) };
    }
    let track = mesh.rows() as f64 * mesh.row_height();
    if height < track * (1.0 - SAME_LENGTH) {
        return Err(PreparationError::Narrow { patch: height, track });
    }
    let needed = body.length(mesh);
    if length < needed * (1.0 - SAME_LENGTH) {
        return Err(PreparationError::Short { patch: length, body: body.name(), length: needed });
    }
    Ok(())
}

/// One direction of patch and mesh.
struct Axis {
    pixels: usize,
    pitch: f64,
    cell: f64,
}

impl Axis {
    /// Weights of the pixels in cell number `index`, the first cell beginning at `margin`; with `fold` the line is
    /// first reflected there and at 0.
    fn weights(&self, index: usize, margin: f64, fold: Option<f64>) -> Weights {
        let window = self.cell.max(self.pitch);
        let start = (index as f64 + 0.5) * self.cell - 0.5 * window + margin;
        let mut pieces = vec![(start, start + window)];
        if let Some(fold) = fold {
            pieces = pieces.into_iter().flat_map(|piece| reflected(piece, fold)).collect();
        }
        let length = self.pixels as f64 * self.pitch;
        let pieces: Vec<_> = pieces.into_iter().flat_map(|piece| reflected(piece, length)).collect();
        Weights::new(&pieces, self, window)
    }
}

/// The pieces of a line between 0 and `length` onto which an interval falls, the line being reflected at both ends over
/// and over.
fn reflected((start, end): (f64, f64), length: f64) -> Vec<(f64, f64)> {
    let first = libm::floor(start / length);
    let last = libm::floor(end / length);
    let mut pieces = Vec::with_capacity(2);
    let mut turn = first;
    while turn <= last {
        let (low, high) = (turn * length, (turn + 1.0) * length);
        let (low_cut, high_cut) = (start.max(low), end.min(high));
        if low_cut < high_cut {
            let even = turn % 2.0 == 0.0;
            pieces.push(if even { (low_cut - low, high_cut - low) } else { (high - high_cut, high - low_cut) });
        }
        turn += 1.0;
    }
    pieces
}

/// Weights of neighbouring pixels.
struct Weights {
    first: usize,
    weights: Vec<f64>,
}

impl Weights {
    /// The share of each pixel of `axis` in pieces that together are as long as `window`.
    fn new(pieces: &[(f64, f64)], axis: &Axis, window: f64) -> Self {
        let last_pixel = axis.pixels - 1;
        let pixel = |place: f64| ((place / axis.pitch) as usize).min(last_pixel);
        let first = pieces.iter().map(|(start, _)| pixel(*start)).min().unwrap_or(0);
        let last = pieces.iter().map(|(_, end)| pixel(*end)).max().unwrap_or(0);
        let mut weights = vec![0.0; last - first + 1];
        for (start, end) in pieces {
            for index in pixel(*start)..=pixel(*end) {
                let (low, high) = (index as f64 * axis.pitch, (index + 1) as f64 * axis.pitch);
                weights[index - first] += (end.min(high) - start.max(low)).max(0.0) / window;
            }
        }
        Self { first, weights }
    }

    /// The weights with what they weigh.
    fn pairs<T>(&self, pixels: impl IntoIterator<Item = T>) -> impl Iterator<Item = (f64, T)> {
        self.weights.iter().copied().zip(pixels.into_iter().skip(self.first))
    }
}
