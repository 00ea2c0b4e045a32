//! Measured patches that are smaller than the ring, tiled and extended by their statistics, held against the patches themselves.

use std::f64::consts::TAU;
use std::path::Path;

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::describe::{Description, Grid, PARAMETERS, sampling_errors};
use plateau_core::surface::{Body, Extension, Fill, Level, Patch, Preparation, RawHeights};
use plateau_io::surface::{ReadOptions, read};

/// Files that are handed to developers and not part of the repository: those of their list that are read as they are.
const SURFACES: [&str; 5] = [
    "alicona_200x296_iso1_int32.sdf",
    "lay_plu_384x288_iso1_binary64.sdf",
    "afm_256x256_iso2_int32.sdf",
    "frt_missing_150x300_iso1_int32.sdf",
    "pypi_afm_256x256_iso1_binary64.sdf",
];

/// What is compared.
const COMPARED: [&str; 8] = ["Sa", "Sq", "Ssk", "Sku", "Sk", "Sdq", "Sal", "Str"];

/// A track of this width, cells of `cell`, `rows` of them, and a ring of `columns`.
struct Track {
    cell: f64,
    rows: usize,
    columns: usize,
    /// Shorter side of the patches.
    patch: f64,
}

/// Of 4 mm and 40 mm.
const TRACKS: [Track; 2] = [
    Track { cell: 50e-6, rows: 80, columns: 400, patch: 2.4e-3 },
    Track { cell: 40e-3 / 120.0, rows: 120, columns: 450, patch: 15e-3 },
];

/// A file as a patch whose shorter side is so long: its pixels have the proportions of the file and the size that fits.
fn patch(name: &str, side: f64) -> Option<Patch> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/surfaces").join(name);
    if !path.is_file() {
        println!("skipped: {} is not there", path.display());
        return None;
    }
    let measured = read(&path, &ReadOptions::default()).unwrap();
    let [x, y] = measured.pitch.unwrap();
    let (columns, rows) = (measured.columns, measured.rows);
    let factor = side / (columns as f64 * x).min(rows as f64 * y);
    let heights = measured.heights;
    Some(Patch { columns, rows, column_pitch: factor * x, row_pitch: factor * y, heights })
}

fn describe(patch: &Patch) -> Description {
    Description::of(&Grid::of(patch)).unwrap()
}

/// Places of the compared parameters in [`PARAMETERS`].
fn compared() -> impl Iterator<Item = (&'static str, usize)> {
    COMPARED.into_iter().map(|symbol| (symbol, PARAMETERS.iter().position(|known| known.symbol == symbol).unwrap()))
}

/// √(Σρ²/N): the standard error of the autocorrelation of N heights far from no lag (Bartlett 1946). The sum is over lags up to
/// a third of the patch, every other one in either direction.
fn correlation_error(cells: &Patch) -> f64 {
    let (columns, rows) = (cells.columns, cells.rows);
    let mean = cells.heights.iter().sum::<f64>() / cells.heights.len() as f64;
    let at = |column: usize, row: usize| cells.heights[column * rows + row] - mean;
    let correlation = |x: usize, y: isize| {
        let (mut sum, mut count) = (0.0, 0.0);
        for column in 0..columns - x {
            for row in y.min(0).unsigned_abs()..rows - y.max(0).unsigned_abs() {
                sum += at(column, row) * at(column + x, row.saturating_add_signed(y));
                count += 1.0;
            }
        }
        sum / count
    };
    let variance = correlation(0, 0);
    let reach = (rows / 3) as isize / 2 * 2;
    let mut squares = 0.0;
    for x in (0..columns / 3).step_by(2) {
        for y in (-reach..=reach).step_by(2) {
            // Lags (−x, −y) and the three between.
            squares += if x == 0 { 4.0 } else { 8.0 } * (correlation(x, y) / variance).powi(2);
        }
    }
    (squares / (columns * rows) as f64).sqrt()
}

/// Parameters of rings made of each surface are those of the patch within its sampling error.
///
/// The standard error of the patch's parameters is that of the jackknife over blocks, and where the parameter is a place at
/// which the autocorrelation ρ falls to 0.2, with that of ρ: of a Gaussian ρ = exp(−(x/ℓ)²) the slope there is
/// x dρ/dx = 2 ρ ln ρ = −0.64, so Sal has the relative error σ_ρ/0.64, and the ratio Str √2 of that. A random ring has the
/// same errors of its own, less by the root of the areas; one that is tiled has parts of the patch once more often than others,
/// an error like that. Three such errors. Str is compared where it is
/// determined, also without any one of the blocks; else it has no error.
fn assert_within_sampling_error(track: &Track) {
    let Track { cell, rows, columns, patch: side } = *track;
    let (mean, half) = (cell * columns as f64 / TAU, 0.5 * cell * rows as f64);
    let mesh = Mesh::new(rows, columns, 10, mean - half, mean + half).unwrap();
    let preparation = Preparation {
        level: Level::Plane,
        outliers: Some(6.0),
        fill: Some(Fill::Interpolate),
        ..Preparation::default()
    };
    let tiled = Preparation { repeat: true, ..preparation };
    let extended = Preparation { extend: Some(Extension::Statistics { seed: 1 }), ..preparation };
    for name in SURFACES {
        let Some(raw) = patch(name, side) else { continue };
        for (way, preparation) in [("tiled", tiled), ("extended", extended)] {
            let prepared = preparation.apply(RawHeights::Patch(raw.clone()), false, Body::Disc, &mesh).unwrap();
            let cells = prepared.patch.unwrap().cell_averages(&mesh).unwrap();
            let errors = sampling_errors(&Grid::of(&cells));
            let found = describe(&Patch { columns, rows, heights: prepared.heights, ..cells.clone() });
            let expected = describe(&cells);
            let rho = correlation_error(&cells) / 0.64;
            let more = (1.0 + cells.heights.len() as f64 / (columns * rows) as f64).sqrt();
            for (symbol, place) in compared() {
                let [found, expected] = [&found, &expected].map(|of| (PARAMETERS[place].value)(of).unwrap());
                let error = more
                    * match symbol {
                        "Sal" => errors[place].hypot(rho * expected),
                        "Str" => errors[place].hypot(2.0_f64.sqrt() * rho * expected),
                        _ => errors[place],
                    };
                let off = (found - expected) / error;
                println!("{name}, {way}: {symbol} {found:.4e}, patch {expected:.4e} ± {error:.1e}: {off:+.1}");
                assert!(
                    off.abs() < 3.0 || symbol == "Str" && off.is_nan(),
                    "{name}, {way}: {symbol} {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn rings_on_a_track_of_4_mm_are_like_their_patches() {
    assert_within_sampling_error(&TRACKS[0]);
}

#[test]
fn rings_on_a_track_of_40_mm_are_like_their_patches() {
    assert_within_sampling_error(&TRACKS[1]);
}
