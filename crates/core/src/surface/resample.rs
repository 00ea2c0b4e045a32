//! A measured patch brought onto the mesh.

use super::prepare::PreparationError;
use super::{Body, Patch};
use crate::mesh::Mesh;

/// Lengths that differ by less than this are the same length.
const SAME_LENGTH: f64 = 1e-9;

/// Heights of every cell of `body` from a patch.
///
/// Cell (row i, column c) has its centre at x = (c + ½) column_width from the patch's first edge and
/// y = (i + ½) Δr − rows Δr/2 from the middle of the patch. Between the centres of the pixels the heights are bilinear,
/// beyond the outermost centres constant. Where pixels are finer than cells a cell takes the mean over k × k points,
/// k = ceil(cell/pitch) in either direction.
///
/// With `repeat` the patch is continued by its mirror image, that by the patch, and so on: T(x) with the period of two
/// patches and no step at a seam. The ring is besides folded about its middle so that it closes without a step:
/// h(x) = T(min(x, L − x)), L being its circumference.
pub(super) fn resample(patch: &Patch, repeat: bool, body: Body, mesh: &Mesh) -> Result<Vec<f64>, PreparationError> {
    fits(patch, repeat, body, mesh)?;
    let (columns, rows) = (body.columns(mesh), mesh.rows());
    let along_x = Axis { points: patch.columns, pitch: patch.column_pitch, cell: mesh.column_width() };
    let along_y = Axis { points: patch.rows, pitch: patch.row_pitch, cell: mesh.row_height() };
    let fold = |x: f64| match (repeat, body) {
        (false, _) => x,
        (true, Body::Pin) => mirrored(x * along_x.cell, patch.length()) / along_x.cell,
        (true, Body::Disc) => mirrored(x.min(columns as f64 - x) * along_x.cell, patch.length()) / along_x.cell,
    };
    // The middle of the track lies on the middle of the patch.
    let margin = 0.5 * (patch.height() / along_y.cell - rows as f64);
    let row_weights: Vec<Weights> = (0..rows).map(|row| along_y.weights(row, |y| y + margin)).collect();

    let mut heights = Vec::with_capacity(columns * rows);
    let mut profile = vec![0.0; patch.rows];
    for column in 0..columns {
        let column_weights = along_x.weights(column, fold);
        profile.fill(0.0);
        for (weight, pixels) in column_weights.pairs(patch.heights.chunks_exact(patch.rows)) {
            profile.iter_mut().zip(pixels).for_each(|(height, pixel)| *height += weight * pixel);
        }
        heights.extend(row_weights.iter().map(|row| row.pairs(&profile).map(|(w, z)| w * z).sum::<f64>()));
    }
    Ok(heights)
}

/// Refuses a patch that does not cover the body.
fn fits(patch: &Patch, repeat: bool, body: Body, mesh: &Mesh) -> Result<(), PreparationError> {
    let track = mesh.rows() as f64 * mesh.row_height();
    if patch.height() < track * (1.0 - SAME_LENGTH) {
        return Err(PreparationError::Narrow {
            patch: patch.height(),
            track,
            pixel: track / patch.rows as f64,
            rows: patch.rows,
        });
    }
    let needed = if repeat { mesh.column_width() } else { body.length(mesh) };
    if patch.length() < needed * (1.0 - SAME_LENGTH) {
        return Err(if repeat {
            PreparationError::ShorterThanColumn { patch: patch.length(), column: needed }
        } else {
            PreparationError::Short { patch: patch.length(), body: body.name(), length: needed }
        });
    }
    Ok(())
}

/// Place in the patch of length `period` that lies at `x` ≥ 0 in the mirrored tiling.
fn mirrored(x: f64, period: f64) -> f64 {
    let x = x % (2.0 * period);
    x.min(2.0 * period - x)
}

/// One direction of patch and mesh.
struct Axis {
    points: usize,
    pitch: f64,
    cell: f64,
}

impl Axis {
    /// Weights of the pixels in cell number `index`; `place` maps a coordinate in cells to one in the patch, in cells.
    fn weights(&self, index: usize, place: impl Fn(f64) -> f64) -> Weights {
        // A cell as large as a pixel takes one point, however the division rounds. `fits` keeps this below `points`.
        let samples = (libm::ceil(self.cell / self.pitch - SAME_LENGTH) as usize).max(1);
        let share = 1.0 / samples as f64;
        let last = self.points - 1;
        let mut pixels: Vec<(usize, f64)> = Vec::with_capacity(2 * samples);
        for sample in 0..samples {
            let cells = index as f64 + (sample as f64 + 0.5) * share;
            let pixel = (place(cells) * self.cell / self.pitch - 0.5).clamp(0.0, last as f64);
            let lower = pixel as usize;
            let fraction = pixel - lower as f64;
            pixels.push((lower, share * (1.0 - fraction)));
            if lower < last {
                pixels.push((lower + 1, share * fraction));
            }
        }
        Weights::new(&pixels)
    }
}

/// Weights of neighbouring pixels.
struct Weights {
    first: usize,
    weights: Vec<f64>,
}

impl Weights {
    fn new(pixels: &[(usize, f64)]) -> Self {
        let first = pixels.iter().map(|(pixel, _)| *pixel).min().unwrap_or(0);
        let last = pixels.iter().map(|(pixel, _)| *pixel).max().unwrap_or(0);
        let mut weights = vec![0.0; last - first + 1];
        pixels.iter().for_each(|(pixel, weight)| weights[pixel - first] += weight);
        Self { first, weights }
    }

    /// The weights with what they weigh.
    fn pairs<T>(&self, pixels: impl IntoIterator<Item = T>) -> impl Iterator<Item = (f64, T)> {
        self.weights.iter().copied().zip(pixels.into_iter().skip(self.first))
    }
}
