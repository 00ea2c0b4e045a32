//! Prepares a surface: the steps of the chain, in their order.

use std::ops::RangeInclusive;

use super::error::PreparationError;
use super::extend::{Extension, extend, take_out_plane};
use super::gaussian_filter::filter;
use super::heights::{change, mean, rms};
use super::implausible::{flat, odd_rms, rougher_by_filling, stand_in, warnings};
use super::level::{Level, level};
use super::missing::{Fill, fill, remove_outliers, remove_slope_outliers};
use super::resample::resample;
use super::rotate::Turn;
use super::straighten::{Crop, Flip, reverse_along, straighten};
use super::unroll::Unroll;
use super::{Body, Length, Patch};
use crate::model::mesh::Mesh;

/// Distances of points that are taken, m, as of files; measured ones are between 1e-11 and 1e-3.
const PIXELS: RangeInclusive<f64> = 1e-15..=1e3;

/// The preparation chain; a step that is absent is not done. Applied in the order of the fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preparation {
    /// The part of the patch that is kept.
    pub crop: Option<Crop>,
    /// Takes the patch as a sector of a ring measured in x and y, and makes arc length and radius of it.
    pub unroll: Option<Unroll>,
    /// Turns the patch counterclockwise, x to the right and y up, rad. Quarters of a turn are exact, else it is interpolated.
    pub rotate: f64,
    /// Reverses the patch.
    pub flip: Option<Flip>,
    /// Levelling; missing points do not take part.
    pub level: Level,
    /// Takes out points of spikes and pits with slopes beyond this; what is left is levelled once more.
    pub outlier_slope: Option<f64>,
    /// Takes out points further than this many robust standard deviations from the median of the levelled surface,
    /// which then is levelled once more without them.
    pub outliers: Option<f64>,
    /// Filling of missing points and outliers; without it they are an error.
    pub fill: Option<Fill>,
    /// Reinterprets the distance of the points, m.
    pub pixel: Option<f64>,
    /// Takes out waves that are shorter: nesting index of an areal Gaussian filter, m (S-filter).
    pub s_filter: Option<f64>,
    /// Takes out waves that are longer, in the same way, m (L-filter).
    pub l_filter: Option<f64>,
    /// Cuts what stands higher than this above the mean, m (along the Abbott-Firestone curve).
    pub cutoff: Option<f64>,
    /// Tiles the patch along and across the sliding direction without a step at the seams.
    pub repeat: bool,
    /// Makes random heights with the statistics of the patch, in place of it; `repeat` then has no meaning.
    pub extend: Option<Extension>,
    /// Multiplies the heights.
    pub scale: f64,
}

impl Preparation {
    /// Preparation that does nothing.
    pub const NONE: Self = Self {
        crop: None,
        unroll: None,
        rotate: 0.0,
        flip: None,
        level: Level::None,
        outlier_slope: None,
        outliers: None,
        fill: None,
        pixel: None,
        s_filter: None,
        l_filter: None,
        cutoff: None,
        repeat: false,
        extend: None,
        scale: 1.0,
    };

    /// Refuses numbers that make no sense.
    pub(super) fn check(&self) -> Result<(), PreparationError> {
        let positive = |number: f64| number > 0.0 && number.is_finite();
        let checks = [
            ("rotate", Some(self.rotate), self.rotate.is_finite(), "a finite angle in rad"),
            ("outlier_slope", self.outlier_slope, self.outlier_slope.is_none_or(positive), "a positive, finite number"),
            ("s_filter", self.s_filter, self.s_filter.is_none_or(positive), "a positive, finite length in m"),
            ("l_filter", self.l_filter, self.l_filter.is_none_or(positive), "a positive, finite length in m"),
            ("outliers", self.outliers, self.outliers.is_none_or(positive), "a positive, finite number"),
            ("pixel", self.pixel, self.pixel.is_none_or(|pixel| PIXELS.contains(&pixel)), "from 1e-15 to 1e3, in m"),
            ("cutoff", self.cutoff, self.cutoff.is_none_or(f64::is_finite), "a finite length in m"),
            ("scale", Some(self.scale), self.scale.is_finite(), "a finite number"),
        ];
        if let Some((key, Some(found), _, expected)) = checks.into_iter().find(|(_, _, good, _)| !good) {
            return Err(PreparationError::Value { key, found, expected });
        }
        match (self.s_filter, self.l_filter) {
            (Some(s_filter), Some(l_filter)) if s_filter >= l_filter => {
                Err(PreparationError::Filters { s_filter, l_filter })
            }
            _ => Ok(()),
        }
    }

    /// Levels and fills the patch; gives the number of points that were missing and got a height.
    pub(super) fn level_and_fill(
        &self,
        patch: &mut Patch,
        closed: bool,
        beyond: &[usize],
        report: &mut Vec<String>,
    ) -> Result<usize, PreparationError> {
        let points = patch.heights.len() - beyond.len();
        let measured = patch.heights.len() - patch.missing();
        refuse_none(patch, points, 0)?;
        self.level(patch, closed, report);
        let mut outliers = 0;
        if let Some(limit) = self.outlier_slope {
            let before = rms(&patch.heights);
            outliers = remove_slope_outliers(patch, limit, closed);
            report.push(format!(
                "outliers by slope: {outliers} of {measured} points are on spikes or in pits with slopes above {limit}: {}",
                change(before, &patch.heights)
            ));
            refuse_none(patch, points, outliers)?;
            if outliers > 0 {
                self.level(patch, closed, report);
            }
        }
        if let Some(limit) = self.outliers {
            let before = rms(&patch.heights);
            let (count, distance) = remove_outliers(&mut patch.heights, limit).ok_or(PreparationError::NoDeviation)?;
            outliers += count;
            report.push(format!(
                "outliers: {count} of {measured} points lie more than {} from the median ({limit} robust standard \
                 deviations): {}",
                Length(distance),
                change(before, &patch.heights)
            ));
            refuse_none(patch, points, outliers)?;
            if count > 0 {
                self.level(patch, closed, report);
            }
        }
        let missing = patch.missing() - beyond.len();
        if missing == 0 {
            return Ok(0);
        }
        let how = self.fill.ok_or(PreparationError::Missing { missing, outliers, points })?;
        let before = rms(&patch.heights);
        fill(patch, how, closed);
        beyond.iter().for_each(|cell| patch.heights[*cell] = f64::NAN);
        let what = match how {
            Fill::Level => "got the mean of the others",
            Fill::Interpolate => "were interpolated from those around them",
        };
        report
            .push(format!("{missing} of {points} points were missing and {what}: {}", change(before, &patch.heights)));
        report.extend(rougher_by_filling(before, rms(&patch.heights), self.outliers.is_some()));
        Ok(missing)
    }

    fn level(&self, patch: &mut Patch, closed: bool, report: &mut Vec<String>) {
        let what = match (self.level, closed) {
            (Level::None, _) => return,
            (Level::Mean, _) => "the mean",
            (Level::Plane, true) => "the mean and the radial slope",
            (Level::Plane, false) => "the least-squares plane",
            (Level::Quadratic, true) => "the mean, the radial slope and the radial curvature",
            (Level::Quadratic, false) => "the least-squares surface of second order",
        };
        let before = rms(&patch.heights);
        level(&mut patch.heights, patch.rows, self.level, closed);
        report.push(format!("levelled by {what}: {}", change(before, &patch.heights)));
    }
}

impl Default for Preparation {
    /// Returns [`Preparation::NONE`].
    fn default() -> Self {
        Self::NONE
    }
}

/// Refuses a patch of so many points of which none has a height, so many of them because they were outliers.
fn refuse_none(patch: &Patch, points: usize, outliers: usize) -> Result<(), PreparationError> {
    if patch.missing() == patch.heights.len() {
        return Err(PreparationError::AllMissing { outliers, points });
    }
    Ok(())
}

/// Heights before their preparation.
#[derive(Debug, Clone, PartialEq)]
pub enum RawHeights {
    /// One height for every cell of the body, m, column by column.
    OnMesh(Vec<f64>),
    /// A patch with a pitch of its own.
    Patch(Patch),
}

/// Heights ready for the first step.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// One height for every cell of the body, m, column by column.
    pub heights: Vec<f64>,
    /// Fraction of the points that `cutoff` cut; none without it.
    pub cut: Option<f64>,
    /// Report of the steps, one a line, for people, with the rms height (about the mean) after those that may change it.
    pub report: Vec<String>,
    /// The patch from which the heights come, prepared, before it was brought onto the mesh and scaled; none if they were on
    /// the mesh.
    pub patch: Option<Patch>,
}

impl Preparation {
    /// Brings heights onto every cell of `body`: mirrored along x if asked for, cropped, unrolled, turned, flipped,
    /// levelled, freed of outliers, filled, read with another pitch, filtered, cut, brought onto the mesh, repeated or extended,
    /// scaled.
    ///
    /// Heights that are already on the mesh come through bit for bit when nothing is asked for. With `pixel` they are
    /// taken as a patch of that pitch, and as one of the cells' pitch where they are cropped, unrolled or turned by other
    /// than half a turn; `repeat` or `extend` alone leave them alone, for they cover the whole body.
    ///
    /// # Errors
    /// [`PreparationError`] when points are missing and not filled, the patch does not cover the body, or a number
    /// makes no sense.
    pub fn apply(&self, raw: RawHeights, mirror: bool, body: Body, mesh: &Mesh) -> Result<Prepared, PreparationError> {
        self.check()?;
        let mut report = Vec::new();
        let (mut patch, on_mesh) = self.as_patch(raw, body, mesh);
        check_grid(&patch)?;
        // Cells beyond the pin's outline take no part: they are as missing points that nobody misses.
        let beyond: Vec<usize> = if on_mesh && body == Body::Pin { mesh.absent_cells().collect() } else { Vec::new() };
        beyond.iter().for_each(|cell| patch.heights[*cell] = f64::NAN);
        // Missing points are told and filled; what is infinite was never measured.
        self.refuse_heights(&patch.heights, |height| height.is_infinite())?;
        report.extend(stand_in(&patch.heights).map(|warning| format!("warning: {warning}")));
        let largest = patch.heights.iter().fold(0.0, |largest: f64, height| largest.max(height.abs()));
        let closed = on_mesh && body == Body::Disc;
        if mirror {
            reverse_along(&mut patch);
            report.push("mirrored along the sliding direction".to_owned());
        }
        let Self { crop, unroll, flip, .. } = *self;
        report.extend(straighten(&mut patch, crop, unroll, Turn::new(self.rotate), flip)?);
        let missing = self.level_and_fill(&mut patch, closed, &beyond, &mut report)?;
        if let Some(pixel) = self.pixel {
            (patch.column_pitch, patch.row_pitch) = (pixel, pixel);
            report.push(format!("pixel pitch taken as {}", Length(pixel)));
        }
        if !beyond.is_empty() && (self.s_filter.is_some() || self.l_filter.is_some()) {
            // A filter at the pin's rim looks beyond it.
            fill(&mut patch, Fill::Interpolate, closed);
        }
        report.extend(filter(&mut patch, self.s_filter, self.l_filter, closed)?);
        if self.extend.is_some() && !on_mesh {
            take_out_plane(&mut patch, self.level, &mut report);
        }
        let cut = self.cutoff.map(|cutoff| {
            let before = rms(&patch.heights);
            let cut = cut(&mut patch.heights, cutoff);
            let step = format!("cut at {} above the mean: {:.3} % of points", Length(cutoff), 100.0 * cut);
            report.push(format!("{step}, {}", change(before, &patch.heights)));
            cut
        });
        let (mut heights, patch) = if on_mesh {
            report.extend(odd_rms(rms(&patch.heights) * self.scale.abs()).map(|warning| format!("warning: {warning}")));
            (patch.heights, None)
        } else {
            report.extend(warnings(&patch, missing, self.scale, body, mesh));
            let heights = self.onto_mesh(&patch, body, mesh, &mut report)?;
            report.extend(flat(&heights, largest, &patch, body));
            (heights, Some(patch))
        };
        if self.scale != 1.0 {
            let before = rms(&heights);
            heights.iter_mut().for_each(|height| *height *= self.scale);
            report.push(format!("heights times {}: {}", self.scale, change(before, &heights)));
        }
        if body == Body::Pin {
            mesh.absent_cells().for_each(|cell| heights[cell] = 0.0);
        }
        self.refuse_heights(&heights, |height| !height.is_finite())?;
        Ok(Prepared { heights, cut, report, patch })
    }

    /// Heights of every cell from a patch that is ready.
    fn onto_mesh(
        &self,
        patch: &Patch,
        body: Body,
        mesh: &Mesh,
        report: &mut Vec<String>,
    ) -> Result<Vec<f64>, PreparationError> {
        let (heights, step) = match self.extend {
            Some(extension) => {
                let heights = extend(patch, extension, body, mesh, report)?;
                (heights, format!("from the patch to the {}", body.name()))
            }
            None => (resample(patch, self.repeat, body, mesh)?, laid(patch, self.repeat, body, mesh)),
        };
        // A profile has no width of its own.
        let narrow = patch.height() < mesh.row_height() && !matches!(self.extend, Some(Extension::Isotropic { .. }));
        if patch.length() < mesh.column_width() || narrow {
            let [patch, cell] = [[patch.length(), patch.height()], [mesh.column_width(), mesh.row_height()]]
                .map(|[length, height]| format!("{} by {}", Length(length), Length(height)));
            report.push(format!(
                "warning: the patch of {patch} is smaller than a cell of {cell}, which leaves nothing of its roughness: check the \
                 unit of its pitch (of a list, that of x and y), or take smaller cells"
            ));
        }
        report.push(format!("{step}: {}", change(rms(&patch.heights), &heights)));
        Ok(heights)
    }

    fn refuse_heights(&self, heights: &[f64], refused: impl Fn(f64) -> bool) -> Result<(), PreparationError> {
        match heights.iter().filter(|height| refused(**height)).count() {
            0 => Ok(()),
            count => Err(PreparationError::NotFinite { count, points: heights.len(), scale: self.scale }),
        }
    }

    /// The heights as a patch, and whether they are on the mesh and stay there.
    fn as_patch(&self, raw: RawHeights, body: Body, mesh: &Mesh) -> (Patch, bool) {
        match raw {
            RawHeights::Patch(patch) => (patch, false),
            RawHeights::OnMesh(heights) => {
                let patch = Patch {
                    columns: body.columns(mesh),
                    rows: mesh.rows(),
                    column_pitch: mesh.column_width(),
                    row_pitch: mesh.row_height(),
                    heights,
                };
                let turn = Turn::new(self.rotate);
                let keeps_its_points = self.crop.is_none() && self.unroll.is_none() && turn.is_half_turns();
                (patch, self.pixel.is_none() && keeps_its_points)
            }
        }
    }
}

fn check_grid(patch: &Patch) -> Result<(), PreparationError> {
    let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
    let sized = !heights.is_empty() && columns.checked_mul(rows) == Some(heights.len());
    let pitched = column_pitch > 0.0 && row_pitch > 0.0 && patch.length().is_finite() && patch.height().is_finite();
    if sized && pitched {
        Ok(())
    } else {
        Err(PreparationError::Grid { columns, rows, points: heights.len(), column_pitch, row_pitch })
    }
}

/// Cuts what stands higher than `cutoff` above the mean down to that level, in place; gives the fraction of points cut:
/// the material ratio of the Abbott-Firestone curve at that level.
fn cut(heights: &mut [f64], cutoff: f64) -> f64 {
    let ceiling = mean(heights) + cutoff;
    let points = heights.iter().filter(|height| !height.is_nan()).count();
    let mut count = 0usize;
    for height in heights.iter_mut().filter(|height| **height > ceiling) {
        *height = ceiling;
        count += 1;
    }
    count as f64 / points as f64
}

/// Says how the patch came onto the mesh.
fn laid(patch: &Patch, repeat: bool, body: Body, mesh: &Mesh) -> String {
    let sizes = [patch.length(), patch.height()];
    let times = [body.length(mesh) / sizes[0], mesh.rows() as f64 * mesh.row_height() / sizes[1]];
    let across =
        if repeat && times[1] > 1.0 + SAME { format!("{:.2} times across the track", times[1]) } else { String::new() };
    // A patch of one line of points is the same all over in the other direction.
    let laid = match (patch.columns, patch.rows) {
        (1, 2..) if across.is_empty() => format!("profile of {} laid across the track", Length(sizes[1])),
        (1, 2..) => format!("profile of {} repeated {across}, mirrored at the seams", Length(sizes[1])),
        (2.., 1) => on_body(&format!("profile of {}", Length(sizes[0])), repeat, times[0], "", body),
        _ => {
            let patch = format!("patch of {} by {}", Length(sizes[0]), Length(sizes[1]));
            let across = if across.is_empty() { across } else { format!(" and {across}") };
            on_body(&patch, repeat, times[0], &across, body)
        }
    };
    format!("{laid}; {}", heights_of_cells(patch, mesh))
}

/// Lengths that differ by less than this part are the same length.
const SAME: f64 = 1e-9;
/// Distances of points that differ from a cell by less than this part are about a cell.
const ABOUT: f64 = 0.01;

/// Says what was laid along the body, so many times if it is repeated.
fn on_body(what: &str, repeat: bool, times: f64, across: &str, body: Body) -> String {
    match (repeat, body) {
        (true, Body::Disc) => format!("{what} repeated {times:.2} times round the ring{across}, mirrored at the seams"),
        (true, Body::Pin) => format!("{what} repeated along the pin{across}, mirrored at the seams"),
        (false, Body::Disc) => format!(
            "{what} laid round the ring without repeating: a step may be left where the ring closes (repeat = true leaves none)"
        ),
        (false, Body::Pin) => format!("{what} laid over the pin"),
    }
}

/// Says how the heights of cells come from those of points.
fn heights_of_cells(patch: &Patch, mesh: &Mesh) -> String {
    let cell = [mesh.column_width(), mesh.row_height()];
    let way = |pitch: f64, cell: f64| {
        let apart = format!("points {} apart", Length(pitch));
        match pitch / cell {
            finer if finer < 1.0 - ABOUT => format!("the mean over {apart}"),
            same if same <= 1.0 + ABOUT => format!("interpolated between {apart} (about a cell)"),
            _ => format!("interpolated between {apart}"),
        }
    };
    let (along, across) = (way(patch.column_pitch, cell[0]), way(patch.row_pitch, cell[1]));
    let ways = match (patch.columns, patch.rows) {
        (1, 2..) => format!("{across} across sliding, the same all along it"),
        (2.., 1) => format!("{along} along sliding, the same all across it"),
        _ if along == across => along,
        _ => format!("{along} along sliding, {across} across it"),
    };
    format!("the height of a cell of {} by {} is {ways}", Length(cell[0]), Length(cell[1]))
}
