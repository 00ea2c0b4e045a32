//! Profiles in a scene: grooves along or across sliding.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::surface::Extension;
use plateau_io::scene::HeightSource;
use plateau_io::surface::{Lay, Loaded, ReadOptions, load};

use crate::surfaces::{ROWS, message, scene};

/// A profile of 101 points, 100 um apart, as text: the heights in um are those of `wave`.
fn profile_file(folder: &Path) -> PathBuf {
    let path = folder.join("profile.txt");
    let text: String =
        (0..101).map(|point| format!("{} {:.6}\n", point, wave(f64::from(point) * 1e-4) * 1e6)).collect();
    fs::write(&path, text).unwrap();
    path
}

/// A wave of 8 mm with an amplitude of 2 um, by place, m.
fn wave(place: f64) -> f64 {
    2e-6 * (std::f64::consts::TAU * place / 8e-3).sin()
}

fn profile_source(path: &Path, lay: Lay) -> HeightSource {
    let options =
        ReadOptions { unit: Some(1e-6), pitch: Some([1e-4; 2]), profile_lay: Some(lay), ..ReadOptions::default() };
    HeightSource::File { path: path.to_owned(), options }
}

#[test]
fn a_profile_becomes_grooves_along_or_across_sliding() {
    let folder = tempfile::tempdir().unwrap();
    let path = profile_file(folder.path());
    let mut scene = scene();
    let mesh = scene.parameters.mesh.clone();
    // Mean of the wave over a cell from `start` on: the difference of its integral; linear pixels differ by their curvature.
    let integral = |place: f64| -2e-6 * 8e-3 / std::f64::consts::TAU * (std::f64::consts::TAU * place / 8e-3).cos();
    let mean = |start: f64, cell: f64| (integral(start + cell) - integral(start)) / cell;
    // A pixel stands for half a pitch to both sides; a window of cells leaves at most half a pixel to either side.
    let slope = 2e-6 * std::f64::consts::TAU / 8e-3;
    let tolerance = slope * 1e-4;

    scene.disc_surface.source = profile_source(&path, Lay::Along);
    let Loaded { surfaces, report, .. } = load(&scene).unwrap();
    let columns: Vec<&[f64]> = surfaces.disc_height.chunks_exact(ROWS).collect();
    assert!(
        columns.iter().all(|column| column.iter().zip(columns[0]).all(|(a, b)| (a - b).abs() < 1e-18)),
        "grooves along"
    );
    let margin = 0.5 * (101.0 * 1e-4 - 4e-3) - 0.5e-4;
    for (row, height) in columns[0].iter().enumerate() {
        let expected = mean(margin + row as f64 * 1e-3, 1e-3);
        assert!((height - expected).abs() <= tolerance, "row {row}: {height}, expected {expected}");
    }
    assert!(columns[0][0] != columns[0][3]);
    let line = "disc.surface: profile across grooves along sliding, the same all along, points 100 um apart";
    assert!(report.iter().any(|found| found == line), "{report:?}");

    scene.disc_surface.source = HeightSource::Flat;
    scene.pin_surface.source = profile_source(&path, Lay::Across);
    scene.pin_surface.preparation.repeat = true;
    let surfaces = load(&scene).unwrap().surfaces;
    let width = mesh.column_width();
    for (column, heights) in surfaces.pin_height.chunks_exact(ROWS).enumerate().take(4) {
        assert!(heights.iter().all(|height| (height - heights[0]).abs() < 1e-18), "grooves across");
        // An instrument's peaks are positive, the pin's z grows away from the disc.
        let expected = -mean(column as f64 * width - 0.5e-4, width);
        assert!((heights[0] - expected).abs() <= tolerance, "column {column}: {}, expected {expected}", heights[0]);
    }
    // The pixel of the preparation reinterprets the distance of the points.
    let HeightSource::File { options, .. } = &mut scene.pin_surface.source else { panic!("a file") };
    options.pitch = None;
    assert!(message(&scene).contains("the file does not say the unit of the distances along the profile"));
    let HeightSource::File { options, .. } = &mut scene.pin_surface.source else { panic!("a file") };
    options.pitch = Some([5e-5; 2]);
    scene.pin_surface.preparation.pixel = Some(1e-4);
    assert_eq!(load(&scene).unwrap().surfaces.pin_height, surfaces.pin_height);
}

#[test]
fn a_profile_without_grooves_is_extended_and_one_too_short_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = profile_file(folder.path());
    let mut scene = scene();
    scene.disc_surface.source = profile_source(&path, Lay::Isotropic);
    let refused = message(&scene);
    assert!(refused.contains("isotropic") && refused.contains("extend = \"statistics\""), "{refused}");
    scene.disc_surface.preparation.extend = Some(Extension::Statistics { seed: 3 });
    let heights = load(&scene).unwrap().surfaces.disc_height;
    assert_eq!(heights.len(), scene.parameters.mesh.disc_cells());
    let (column, row) = (&heights[..ROWS], heights.iter().step_by(ROWS));
    assert!(column.iter().any(|height| *height != column[0]) && row.into_iter().any(|height| *height != heights[0]));
    scene.disc_surface.preparation.extend = None;
    scene.disc_surface.source = profile_source(&path, Lay::Across);
    assert!(message(&scene).starts_with("disc.prepare: "), "{}", message(&scene));
    scene.disc_surface.preparation.repeat = true;
    assert!(load(&scene).is_ok());
}
