//! A surface of any size with the statistics of a measured patch.
//!
//! The heights of the patch are taken as one sample of a random surface. Averaged over cells of the mesh, they have a
//! distribution and an autocorrelation; a Gaussian field is made whose heights, once they have that distribution, have that
//! autocorrelation (see [`super::translation`]), and gets the heights of the patch in the order of its own values. So the
//! Abbott-Firestone curve is the patch's, and texture and lay are those of the patch up to its own length.

use super::autocovariance::{Autocovariance, wrapped};
use super::grid::Grid;
use super::most_cells;
use super::planar;
use super::quantiles::Quantiles;
use super::translation::Translation;
use crate::model::mesh::Mesh;
use crate::surface::fft::Complex;
use crate::surface::fft2d::Fft2d;
use crate::surface::preparation_error::PreparationError;
use crate::surface::random::{Random, Stream};
use crate::surface::resample::CellGrid;
use crate::surface::{Body, Length, Patch};

/// Fewest cells of a patch in either direction whose statistics show.
const FEWEST_CELLS: usize = 8;
/// Positions of the cells over the patch in either direction, where a cell holds as many pixels.
const POSITIONS: usize = 4;
/// Step of the rule for means over the normal distribution; the distribution has corners, so that the error falls with its square.
const NORMAL_STEP: f64 = 1.0 / 256.0;
/// A cell that lacks no more than this of its size is whole.
const ROUNDING: f64 = 1e-9;
/// Standard error of the rms height above which the patch is called small.
const UNCERTAIN: f64 = 0.1;

/// A patch continued by its statistics.
#[derive(Debug, Clone, PartialEq)]
pub struct Extended {
    /// One height for every cell of the body, m, column by column.
    pub heights: Vec<f64>,
    /// What was done, for people.
    pub report: String,
    /// What the patch cannot tell, for people.
    pub warning: Option<String>,
}

/// Extends a complete patch over a body; see the module. The same seed gives the same bits on every machine, and unrelated
/// heights on disc and pin. The disc closes round the ring.
///
/// # Errors
/// [`PreparationError`] when the patch covers too few cells, or the field would be too large.
pub fn extend(patch: &Patch, seed: u64, body: Body, mesh: &Mesh) -> Result<Extended, PreparationError> {
    let cell = [mesh.column_width(), mesh.row_height()];
    let Samples { heights: samples, cells } = Samples::of(patch, cell)?;
    let quantiles = Quantiles::of(samples.concat());
    let size = format!("patch of {} by {}", Length(patch.length()), Length(patch.height()));
    let Some(measured) = Autocovariance::of(&samples, cells) else {
        let heights = vec![quantiles.height(0.5); body.columns(mesh) * mesh.rows()];
        return Ok(Extended { heights, report: format!("{size}, which is flat, extended"), warning: None });
    };
    let reach = [0, 1].map(|axis| cells[axis] as f64 * cell[axis]);
    let grid = Grid::new(body, mesh, reach, 1);
    let (columns, rows) = (grid.padded_columns, grid.padded_rows);
    if columns.checked_mul(rows).is_none_or(|field| field > most_cells(&grid)) {
        return Err(PreparationError::TooLarge { columns, rows });
    }
    let stream = if body == Body::Disc { Stream::DiscExtension } else { Stream::PinExtension };
    let translation = Translation::of(|x| quantiles.of_normal(x), NORMAL_STEP, 0.0);
    let power = spectrum(&measured, &translation, [columns, rows]);
    let mut heights = planar::field(&grid, power, None, &mut Random::new(seed, stream));
    quantiles.impose(&mut heights);
    let [along, across] = cells;
    let report = format!(
        "{size}, averaged over {along} by {across} cells of {} by {} in {} positions, extended by its statistics, seed {seed}",
        Length(cell[0]),
        Length(cell[1]),
        samples.len()
    );
    Ok(Extended { heights, report, warning: warning(&quantiles, &measured) })
}

/// The patch averaged over cells, in several positions of the cells over it: each as many columns and rows.
struct Samples {
    heights: Vec<Vec<f64>>,
    cells: [usize; 2],
}

impl Samples {
    /// Where a cell holds several pixels, one row and column of cells less leaves room to move them about.
    fn of(patch: &Patch, cell: [f64; 2]) -> Result<Self, PreparationError> {
        let whole = |length: f64, cell: f64| libm::floor(length / cell * (1.0 + ROUNDING)) as usize;
        let [columns, rows] = [whole(patch.length(), cell[0]), whole(patch.height(), cell[1])];
        if columns.min(rows) < FEWEST_CELLS {
            return Err(PreparationError::FewCells { columns, rows, cell, least: FEWEST_CELLS });
        }
        let pixels = [whole(cell[0], patch.column_pitch), whole(cell[1], patch.row_pitch)];
        let positions = |cells: usize, pixels: usize| if cells > FEWEST_CELLS { pixels.clamp(1, POSITIONS) } else { 1 };
        let positions = [positions(columns, pixels[0]), positions(rows, pixels[1])];
        let less = |cells: usize, positions: usize| if positions > 1 { cells - 1 } else { cells };
        let (columns, rows) = (less(columns, positions[0]), less(rows, positions[1]));
        let first = |position: usize, axis: usize| position as f64 / positions[axis] as f64 * cell[axis];
        let places = (0..positions[0]).flat_map(|x| (0..positions[1]).map(move |y| [x, y]));
        let heights = places
            .map(|[x, y]| {
                CellGrid { columns, rows, cell, first: [first(x, 0), first(y, 1)], fold: None }.heights(patch)
            })
            .collect();
        Ok(Self { heights, cells: [columns, rows] })
    }
}

/// The spectrum of the Gaussian field, at every harmonic of a periodic plane of so many columns and rows.
///
/// Where it would be negative no field has it, and the nearest that one has is 0 there.
fn spectrum(measured: &Autocovariance, translation: &Translation, [columns, rows]: [usize; 2]) -> Vec<f64> {
    let mut plane = vec![Complex::default(); columns * rows];
    // A short ring has room for shorter lags only.
    let [longest, widest] = [columns, rows].map(|points| (points - 1) / 2);
    for ([x, y], value) in measured.lags() {
        if x.unsigned_abs() <= longest && y.unsigned_abs() <= widest {
            plane[wrapped(x, columns) * rows + wrapped(y, rows)].re = translation.inverse(value);
        }
    }
    Fft2d::new(columns, rows).forward(&mut plane);
    plane.iter().map(|value| value.re.max(0.0)).collect()
}

/// Says how uncertain the statistics are, where the patch is small for its texture: the standard error of Sq of N independent
/// heights is √((kurtosis − 1)/4N) of it.
fn warning(quantiles: &Quantiles, measured: &Autocovariance) -> Option<String> {
    let independent = measured.independent();
    let error = ((quantiles.kurtosis() - 1.0) / (4.0 * independent)).sqrt();
    (error > UNCERTAIN).then(|| {
        format!(
            "the patch holds about {independent:.0} independent heights, so its rms height is known to {:.0} %, and nothing is known of \
             waves longer than the patch: measure a larger area",
            100.0 * error
        )
    })
}
