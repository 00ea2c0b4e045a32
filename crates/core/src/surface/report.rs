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
    let way = |pitch: f64, cell: f64| if pitch > cell { "interpolated" } else { "averaged" };
    let along = way(patch.column_pitch, mesh.column_width());
    let across = way(patch.row_pitch, mesh.row_height());
    let ways = if along == across { along.to_owned() } else { format!("{along} along, {across} across sliding") };
    let size = format!("patch of {} by {}", Length(patch.length()), Length(patch.height()));
    let across = mesh.rows() as f64 * mesh.row_height() / patch.height();
    let across = if across > 1.0 + 1e-9 { format!(" and {across:.2} times across the track") } else { String::new() };
    let laid = match (repeat, body) {
        (true, Body::Disc) => {
            let times = body.length(mesh) / patch.length();
            format!("{size} repeated {times:.2} times round the ring{across}, mirrored at the seams")
        }
        (true, Body::Pin) => format!("{size} repeated along the pin{across}, mirrored at the seams"),
        (false, Body::Disc) => format!(
            "{size} laid round the ring without repeating: a step may be left where the ring closes \
             (repeat = true leaves none)"
        ),
        (false, Body::Pin) => format!("{size} laid over the pin"),
    };
    format!(
        "{laid}; {ways} from pixels of {} by {} to cells of {} by {}",
        Length(patch.column_pitch),
        Length(patch.row_pitch),
        Length(mesh.column_width()),
        Length(mesh.row_height())
    )
}
