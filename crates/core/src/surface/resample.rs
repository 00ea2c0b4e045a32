//! A measured patch brought onto the mesh.

use super::error::PreparationError;
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
/// With `repeat` the patch is continued by its mirror image, that by the patch, and so on, along and across sliding:
/// T(x, y) with the period of two patches and no step at a seam. The ring is besides folded about its middle so that it
/// closes without a step: h(x) = T(min(x, L − x)), L being its circumference. A window may be wider than the patch: it
/// then has the patch and its images in it as often as they fit.
pub(super) fn resample(patch: &Patch, repeat: bool, body: Body, mesh: &Mesh) -> Result<Vec<f64>, PreparationError> {
    fits(patch, repeat, body, mesh)?;
    let (columns, rows) = (body.columns(mesh), mesh.rows());
    let [along_x, along_y] = axes(patch, mesh);
    let fold = (repeat && body == Body::Disc).then(|| 0.5 * body.length(mesh));
    // The middle of the track lies on the middle of the patch.
    let margin = 0.5 * (patch.height() - rows as f64 * along_y.cell);
    let row_weights: Vec<Weights> = (0..rows).map(|row| along_y.weights(row, margin, None)).collect();
    let column_weights = (0..columns).map(|column| along_x.weights(column, 0.0, fold));
    // Of many pixels for each cell the rows are averaged once and not for every column.
    if margin < 0.0 && rows <= patch.rows {
        let columns = patch.heights.chunks_exact(patch.rows);
        let averaged: Vec<f64> = columns.flat_map(|pixels| row_weights.iter().map(|row| row.mean(pixels))).collect();
        let same: Vec<Weights> = (0..rows).map(Weights::one).collect();
        return Ok(weighed(&averaged, rows, column_weights, &same));
    }
    Ok(weighed(&patch.heights, patch.rows, column_weights, &row_weights))
}

impl Patch {
    /// The means of the patch over cells of the mesh's size, those that lie in the patch whole; as the heights of a body are
    /// made of it, so that both can be compared. None if there is not one such cell.
    pub fn cell_averages(&self, mesh: &Mesh) -> Option<Self> {
        Some(cell_averages(self, mesh)).filter(|cells| !cells.heights.is_empty())
    }

    /// Seams at which the patch, laid on the disc as it is or repeated, meets itself or its mirror image: angles from the first column,
    /// rad, and radii, m, both increasing.
    pub fn seams(&self, repeat: bool, mesh: &Mesh) -> [Vec<f64>; 2] {
        let ring = Body::Disc.length(mesh);
        let mut places = vec![0.0];
        let mut radii = Vec::new();
        if repeat && self.columns > 1 {
            let half: Vec<f64> =
                (1..).map(|seam| f64::from(seam) * self.length()).take_while(|place| *place < 0.5 * ring).collect();
            places.extend(half.iter().copied().chain([0.5 * ring]));
            places.extend(half.iter().rev().map(|place| ring - place));
        }
        if repeat && self.rows > 1 {
            let track = mesh.rows() as f64 * mesh.row_height();
            let outward: Vec<f64> = (0..)
                .map(|seam| (f64::from(seam) + 0.5) * self.height())
                .take_while(|place| *place < 0.5 * track)
                .collect();
            radii.extend(outward.iter().rev().map(|place| mesh.mean_radius() - place));
            radii.extend(outward.iter().map(|place| mesh.mean_radius() + place));
        }
        [places.into_iter().map(|place| place / mesh.mean_radius()).collect(), radii]
    }
}

/// The mean of the patch in every cell of the mesh's size that lies in it whole, the cells in the middle of the patch; as
/// for [`resample`]. The number of cells along or across may be 0.
pub(super) fn cell_averages(patch: &Patch, mesh: &Mesh) -> Patch {
    let [along_x, along_y] = axes(patch, mesh);
    let weights = |axis: &Axis| -> Vec<Weights> {
        let (count, length) = (axis.whole_cells(), axis.pixels as f64 * axis.pitch);
        let margin = 0.5 * (length - count as f64 * axis.cell);
        (0..count).map(|index| axis.weights(index, margin, None)).collect()
    };
    let [columns, rows] = [weights(&along_x), weights(&along_y)];
    Patch {
        columns: columns.len(),
        rows: rows.len(),
        column_pitch: along_x.cell,
        row_pitch: along_y.cell,
        heights: weighed(&patch.heights, patch.rows, columns.into_iter(), &rows),
    }
}

/// Number of cells of the mesh that lie in the patch whole, along and across sliding.
pub(super) fn whole_cells(patch: &Patch, mesh: &Mesh) -> [usize; 2] {
    axes(patch, mesh).map(|axis| axis.whole_cells())
}

/// Both directions, along and across sliding.
fn axes(patch: &Patch, mesh: &Mesh) -> [Axis; 2] {
    [
        Axis { pixels: patch.columns, pitch: patch.column_pitch, cell: mesh.column_width() },
        Axis { pixels: patch.rows, pitch: patch.row_pitch, cell: mesh.row_height() },
    ]
}

/// Sums of heights, `rows` to a column, with these weights.
fn weighed(heights: &[f64], rows: usize, columns: impl Iterator<Item = Weights>, row_weights: &[Weights]) -> Vec<f64> {
    let mut sums = Vec::with_capacity(columns.size_hint().0 * row_weights.len());
    let mut profile = vec![0.0; rows];
    for column in columns {
        profile.fill(0.0);
        for (weight, pixels) in column.pairs(heights.chunks_exact(rows)) {
            profile.iter_mut().zip(pixels).for_each(|(height, pixel)| *height += weight * pixel);
        }
        sums.extend(row_weights.iter().map(|row| row.mean(&profile)));
    }
    sums
}

/// Refuses a patch that does not cover the body and is not repeated.
fn fits(patch: &Patch, repeat: bool, body: Body, mesh: &Mesh) -> Result<(), PreparationError> {
    let (track, length) = (mesh.rows() as f64 * mesh.row_height(), body.length(mesh));
    if repeat {
        return Ok(());
    }
    if patch.height() < track * (1.0 - SAME_LENGTH) {
        return Err(PreparationError::Narrow { patch: patch.height(), track });
    }
    if patch.length() < length * (1.0 - SAME_LENGTH) {
        return Err(PreparationError::Short { patch: patch.length(), body: body.name(), length });
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
    /// Number of cells that lie in the patch whole.
    fn whole_cells(&self) -> usize {
        (self.pixels as f64 * self.pitch / self.cell * (1.0 + SAME_LENGTH)) as usize
    }

    /// Weights of the pixels in cell number `index`, the first cell beginning at `margin`; with `fold` the line is
    /// first reflected there and at 0.
    fn weights(&self, index: usize, margin: f64, fold: Option<f64>) -> Weights {
        let window = self.cell.max(self.pitch);
        let start = (index as f64 + 0.5) * self.cell - 0.5 * window + margin;
        let mut pieces = vec![Piece { start, end: start + window, times: 1.0 }];
        if let Some(fold) = fold {
            pieces = pieces.into_iter().flat_map(|piece| reflected(piece, fold)).collect();
        }
        let length = self.pixels as f64 * self.pitch;
        let pieces: Vec<_> = pieces.into_iter().flat_map(|piece| reflected(piece, length)).collect();
        Weights::new(&pieces, self, window)
    }
}

/// A part of a line, and how many times it counts.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: f64,
    end: f64,
    times: f64,
}

/// The pieces of a line between 0 and `length` onto which an interval falls, the line being reflected at both ends over
/// and over: a first and a last one, and the whole line as often as it fits between them.
fn reflected(Piece { start, end, times }: Piece, length: f64) -> Vec<Piece> {
    let first = libm::floor(start / length);
    let last = libm::floor(end / length);
    let mut pieces = Vec::with_capacity(3);
    let mut part_of = |turn: f64| {
        let (low, high) = (turn * length, (turn + 1.0) * length);
        let (low_cut, high_cut) = (start.max(low), end.min(high));
        if low_cut < high_cut {
            let even = turn % 2.0 == 0.0;
            let (start, end) = if even { (low_cut - low, high_cut - low) } else { (high - high_cut, high - low_cut) };
            pieces.push(Piece { start, end, times });
        }
    };
    if last - first <= 2.0 {
        let mut turn = first;
        while turn <= last {
            part_of(turn);
            turn += 1.0;
        }
    } else {
        part_of(first);
        part_of(last);
        pieces.push(Piece { start: 0.0, end: length, times: times * (last - first - 1.0) });
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
    fn new(pieces: &[Piece], axis: &Axis, window: f64) -> Self {
        let last_pixel = axis.pixels - 1;
        let pixel = |place: f64| ((place / axis.pitch) as usize).min(last_pixel);
        let first = pieces.iter().map(|piece| pixel(piece.start)).min().unwrap_or(0);
        let last = pieces.iter().map(|piece| pixel(piece.end)).max().unwrap_or(0);
        let mut weights = vec![0.0; last - first + 1];
        for Piece { start, end, times } in pieces {
            for index in pixel(*start)..=pixel(*end) {
                let (low, high) = (index as f64 * axis.pitch, (index + 1) as f64 * axis.pitch);
                weights[index - first] += times * ((end.min(high) - start.max(low)).max(0.0) / window);
            }
        }
        Self { first, weights }
    }

    /// All weight on one pixel.
    fn one(pixel: usize) -> Self {
        Self { first: pixel, weights: vec![1.0] }
    }

    /// The weighted mean of the pixels of a line.
    fn mean(&self, pixels: &[f64]) -> f64 {
        self.pairs(pixels).map(|(weight, height)| weight * height).sum()
    }

    /// The weights with what they weigh.
    fn pairs<T>(&self, pixels: impl IntoIterator<Item = T>) -> impl Iterator<Item = (f64, T)> {
        self.weights.iter().copied().zip(pixels.into_iter().skip(self.first))
    }
}
