//! Sentences that the report of a preparation has in common.

use super::level::rms;
use super::{Body, Length, Patch};
use crate::model::mesh::Mesh;

/// What a step made of the rms height.
pub(super) fn change(before: f64, heights: &[f64]) -> String {
    format!("rms {} -> {}", Length(before), Length(rms(heights)))
}

/// How the patch came onto the mesh, in words.
pub(super) fn laid(patch: &Patch, repeat: bool, body: Body, mesh: &Mesh) -> String {
    let sizes = [patch.length(), patch.height()];
    let times = [body.length(mesh) / sizes[0], mesh.rows() as f64 * mesh.row_height() / sizes[1]];
    let across =
        if repeat && times[1] > 1.0 + SAME { format!("{:.2} times across the track", times[1]) } else { String::new() };
    let laid = match Line::of(patch) {
        Some(Line::Across) if across.is_empty() => format!("profile of {} laid across the track", Length(sizes[1])),
        Some(Line::Across) => format!("profile of {} repeated {across}, mirrored at the seams", Length(sizes[1])),
        Some(Line::Along) => on_body(&format!("profile of {}", Length(sizes[0])), repeat, times[0], "", body),
        None => {
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

/// A patch of one line of points, the same all over in the other direction.
enum Line {
    Along,
    Across,
}

impl Line {
    fn of(patch: &Patch) -> Option<Self> {
        match (patch.columns, patch.rows) {
            (1, 2..) => Some(Self::Across),
            (2.., 1) => Some(Self::Along),
            _ => None,
        }
    }
}

/// What was laid along the body, so many times if it is repeated.
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

/// How the heights of cells come from those of points, in words.
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
    let ways = match Line::of(patch) {
        Some(Line::Across) => format!("{across} across sliding, the same all along it"),
        Some(Line::Along) => format!("{along} along sliding, the same all across it"),
        None if along == across => along,
        None => format!("{along} along sliding, {across} across it"),
    };
    format!("the height of a cell of {} by {} is {ways}", Length(cell[0]), Length(cell[1]))
}
