//! Heights of a whole body with the statistics of a patch that is smaller.
//!
//! The patch is averaged over cells of the mesh's size. From these heights come the distribution (the Abbott-Firestone curve,
//! [`quantiles`]) and the areal power spectrum, with which the autocorrelation and all anisotropy ([`spectrum`]). A Gaussian
//! field g is made with the autocorrelation that becomes that of the patch when its heights are given the patch's
//! distribution, z = T(g) (Grigoriu 1984, see [`translation`](super::synthesis::translation)). From a profile they come as
//! those of a surface without a direction ([`line`]).

mod statistics;

use statistics::{Line, Quantiles, Reach, Spectrum};
pub(super) use statistics::{crossing, few_lengths};

use super::error::PreparationError;
use super::heights::{mean, rms};
use super::level::{Level, level};
use super::random::{Random, Stream};
use super::resample::{cell_averages, whole_cells};
use super::synthesis::planar::{self, Grid, Plane};
use super::synthesis::translation::Translation;
use super::{Body, Length, Patch};
use crate::model::mesh::Mesh;

/// Extension of a patch that is smaller than the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extension {
    /// Random heights with the statistics of the patch.
    Statistics {
        /// Seed of the random stream.
        seed: u64,
    },
    /// Random heights with the statistics of a profile in every direction; the patch is the profile, in one row.
    Isotropic {
        /// Seed of the random stream.
        seed: u64,
    },
}

impl Extension {
    /// Fewest cells in either direction of which statistics are taken.
    pub const FEWEST_CELLS: usize = 4;
}

/// Statistics from which random heights are made.
struct Statistics {
    grid: Grid,
    /// Autocorrelation at every lag of the grid, column by column.
    correlation: Vec<f64>,
    quantiles: Quantiles,
}

/// Share of the mean square height below which a plane is not worth a word.
const SLIGHT: f64 = 1e-6;

/// Share of the mean square height in waves as long as the patch from which on more should be measured.
const MUCH: f64 = 0.1;

/// Fewest cells of a patch whose heights tell a distribution: with fewer the Abbott-Firestone curve has steps of more than 0.2 %.
const FEWEST_HEIGHTS: usize = 500;

/// Warns of a patch with few cells: the heights of the body are those of its cells, and no others.
fn few_heights(cells: &Patch) -> Option<String> {
    let count = cells.heights.len();
    (count < FEWEST_HEIGHTS).then(|| {
        format!(
            "warning: the distribution of the heights comes from {} by {} = {count} cells, expected {FEWEST_HEIGHTS} or more: its \
             tails are unknown and its Abbott-Firestone curve has steps; measure a larger area, or take smaller cells",
            cells.columns, cells.rows
        )
    })
}

/// Random heights of every cell of `body` with the statistics of the patch, on the disc periodic round the ring. What is done,
/// and what the patch cannot tell, goes into the report. The patch is without a tilt, see [`take_out_plane`].
pub(super) fn extend(
    patch: &Patch,
    extension: Extension,
    body: Body,
    mesh: &Mesh,
    report: &mut Vec<String>,
) -> Result<Vec<f64>, PreparationError> {
    let (Extension::Statistics { seed } | Extension::Isotropic { seed }) = extension;
    let statistics = match extension {
        Extension::Statistics { .. } => statistics_of_patch(patch, seed, body, mesh, report)?,
        Extension::Isotropic { .. } => statistics_of_line(patch, seed, body, mesh, report)?,
    };
    let Some(Statistics { grid, correlation, quantiles }) = statistics else {
        // The preparation warns of it.
        return Ok(vec![mean(&patch.heights); body.columns(mesh) * mesh.rows()]);
    };
    let translation = Translation::of(|x| quantiles.normal(x), QUADRATURE_STEP, 0.0);
    let mut power = gaussian_power(correlation, |value| translation.inverse(value), &Plane::of(&grid));
    // Where no field has it, the nearest.
    power.iter_mut().for_each(|power| *power = power.max(0.0));
    let stream = if body == Body::Disc { Stream::DiscExtension } else { Stream::PinExtension };
    let field = planar::field(&grid, power, None, &mut Random::new(seed, stream));
    Ok(quantiles.by_rank(&field))
}

/// Statistics of a patch; none if its cells are equal.
fn statistics_of_patch(
    patch: &Patch,
    seed: u64,
    body: Body,
    mesh: &Mesh,
    report: &mut Vec<String>,
) -> Result<Option<Statistics>, PreparationError> {
    let grid = grid(patch, body, mesh)?;
    let cells = cell_averages(patch, mesh);
    let quantiles = Quantiles::of(&cells.heights);
    if quantiles.are_equal() {
        return Ok(None);
    }
    let spectrum = Spectrum::of(&cells, &grid);
    let long_waves = spectrum.long_waves;
    report.push(format!(
        "extend: heights with the statistics of the patch of {} by {}, averaged over {} by {} cells, seed {seed}; \
         {:.2} % of its mean square height has wavelengths as long as the patch{}",
        Length(patch.length()),
        Length(patch.height()),
        cells.columns,
        cells.rows,
        100.0 * long_waves,
        if long_waves > MUCH { ": measure a larger area" } else { "" }
    ));
    report.extend(few_heights(&cells));
    let correlation = Plane::of(&grid).autocorrelation(spectrum.power);
    report.extend(Reach::of(&correlation, &grid, &cells).remarks(long_waves > MUCH, patch, body, mesh));
    Ok(Some(Statistics { grid, correlation, quantiles }))
}

/// Statistics of a surface without a direction, of which the patch is a profile; none if its points are equal.
fn statistics_of_line(
    patch: &Patch,
    seed: u64,
    body: Body,
    mesh: &Mesh,
    report: &mut Vec<String>,
) -> Result<Option<Statistics>, PreparationError> {
    let cell = [mesh.column_width(), mesh.row_height()];
    let cells = cell.map(|cell| (patch.length() / cell) as usize);
    let size = [patch.length(), patch.height()];
    if cells.iter().any(|count| *count < Extension::FEWEST_CELLS) {
        return Err(PreparationError::FewCells { patch: size, cells, least: Extension::FEWEST_CELLS });
    }
    if patch.heights.iter().all(|height| *height == patch.heights[0]) {
        return Ok(None);
    }
    let line = Line::of(patch);
    let grid = Grid::new(body, mesh, [line.reach(); 2], 1);
    if grid.is_too_large() {
        return Err(PreparationError::LargeField {
            patch: size,
            cells,
            field: [grid.padded_columns, grid.padded_rows],
        });
    }
    let (correlation, variance) = line.correlation(&grid);
    let quantiles = Quantiles::of(&line.cell_heights(cell[0], variance));
    report.push(format!(
        "extend: heights without a direction with the statistics of the profile of {}, averaged over cells of {} by {}, seed \
         {seed}; heights are related over {}",
        Length(patch.length()),
        Length(cell[0]),
        Length(cell[1]),
        Length(line.reach())
    ));
    report.extend(line.warning());
    Ok(Some(Statistics { grid, correlation, quantiles }))
}

/// Step of the quadrature of the distribution, whose density is not smooth: its error falls as the square of the step.
const QUADRATURE_STEP: f64 = 1.0 / 128.0;

/// Takes the least-squares plane out of a patch that is to be extended and was not levelled by a plane or a surface of second
/// order: a tilt is not roughness. The mean height stays. It has to be done before peaks are cut, or those that were cut to one
/// height, which carry the load, would lie at many.
pub(super) fn take_out_plane(patch: &mut Patch, levelled: Level, report: &mut Vec<String>) {
    if matches!(levelled, Level::Plane | Level::Quadratic) {
        return;
    }
    let (before, centre) = (rms(&patch.heights), mean(&patch.heights));
    level(&mut patch.heights, patch.rows, Level::Plane, false);
    patch.heights.iter_mut().for_each(|height| *height += centre);
    let after = rms(&patch.heights);
    if before * before - after * after > SLIGHT * before * before {
        let plane = "extend: the least-squares plane was taken out, for a tilt is not roughness";
        report.push(format!("{plane}: rms {} -> {}", Length(before), Length(after)));
    }
}

/// The grid of the field: so large that opposite edges of the body are further apart than any two cells of the patch.
fn grid(patch: &Patch, body: Body, mesh: &Mesh) -> Result<Grid, PreparationError> {
    let (cells, size) = (whole_cells(patch, mesh), [patch.length(), patch.height()]);
    if cells.iter().any(|count| *count < Extension::FEWEST_CELLS) {
        return Err(PreparationError::FewCells { patch: size, cells, least: Extension::FEWEST_CELLS });
    }
    let large = |field: [usize; 2]| PreparationError::LargeField { patch: size, cells, field };
    // Beyond these the padding could not be counted.
    if cells.iter().any(|count| *count > 1 << 28) {
        return Err(large(cells));
    }
    let reach = [cells[0] as f64 * mesh.column_width(), cells[1] as f64 * mesh.row_height()];
    let grid = Grid::new(body, mesh, reach, 1);
    let many = cells[0].checked_mul(cells[1]).is_none_or(|count| count > Grid::MOST_CELLS);
    if many || grid.is_too_large() { Err(large([grid.padded_columns, grid.padded_rows])) } else { Ok(grid) }
}

/// Autocorrelation that is no more than rounding.
const ROUNDING: f64 = 1e-13;

/// The power of the Gaussian field that has this autocorrelation after a map of its values, of which this is the inverse; negative
/// where no field has it.
pub(super) fn gaussian_power(correlation: Vec<f64>, inverse: impl Fn(f64) -> f64 + Sync, plane: &Plane) -> Vec<f64> {
    let [columns, rows] = plane.size();
    // Of two opposite lags, which have the same value, the first.
    let opposite = |here: usize| (columns - here / rows) % columns * rows + (rows - here % rows) % rows;
    let beyond_rounding = |value: f64| if value.abs() < ROUNDING { 0.0 } else { inverse(value.min(1.0)) };
    plane.power_of(correlation, |here| here.min(opposite(here)), beyond_rounding)
}
