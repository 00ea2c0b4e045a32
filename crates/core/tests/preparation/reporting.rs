//! What the report of a preparation says of the way onto the mesh.

use super::*;

/// Cells of 50 um on a ring of 138.2 mm by 4 mm.
fn mesh() -> Mesh {
    Mesh::new(80, 2765, 160, 20e-3, 24e-3).unwrap()
}

fn of_pitch(columns: usize, rows: usize, [column_pitch, row_pitch]: [f64; 2]) -> Patch {
    Patch { column_pitch, row_pitch, ..patch(columns, rows, 1.0, rough) }
}

/// What is said of a patch that was laid onto the disc, but for what became of its rms height.
fn told(patch: &Patch, repeat: bool) -> String {
    let raw = RawHeights::Patch(patch.clone());
    let report = Preparation { repeat, ..Preparation::NONE }.apply(raw, false, Body::Disc, &mesh()).unwrap().report;
    let laid = report.iter().find(|line| line.contains("the height of a cell")).unwrap();
    laid.split(": rms").next().unwrap().to_owned()
}

#[test]
fn a_profile_is_laid_in_the_direction_in_which_it_was_traced() {
    let round = Body::Disc.length(&mesh());
    assert_eq!(
        told(&of_pitch(1, 3000, [round, 0.5e-6]), true),
        "profile of 1.5 mm repeated 2.67 times across the track, mirrored at the seams; the height of a cell of 49.99 um by \
         50 um is the mean over points 500 nm apart across sliding, the same all along it"
    );
    assert_eq!(
        told(&of_pitch(1, 5000, [round, 1e-6]), false),
        "profile of 5 mm laid across the track; the height of a cell of 49.99 um by 50 um is the mean over points 1 um apart \
         across sliding, the same all along it"
    );
    assert_eq!(
        told(&of_pitch(4800, 1, [1e-6, 4e-3]), true),
        "profile of 4.8 mm repeated 28.80 times round the ring, mirrored at the seams; the height of a cell of 49.99 um by \
         50 um is the mean over points 1 um apart along sliding, the same all across it"
    );
}

#[test]
fn points_as_far_apart_as_cells_are_said_to_be() {
    let told = |pitch: [f64; 2]| told(&of_pitch(10, 10, pitch), true).split("; ").nth(1).unwrap().to_owned();
    let cell = "the height of a cell of 49.99 um by 50 um is";
    assert_eq!(told([50e-6; 2]), format!("{cell} interpolated between points 50 um apart (about a cell)"));
    assert_eq!(told([1e-6; 2]), format!("{cell} the mean over points 1 um apart"));
    assert_eq!(
        told([200e-6, 2e-6]),
        format!(
            "{cell} interpolated between points 200 um apart along sliding, the mean over points 2 um apart across it"
        )
    );
}
