//! The parameters of measured surfaces against those that other programs compute: `values.json` in the folder of shared
//! surfaces, made with surfalize 0.19.2, slippy 0.5.2 and SurfaceTopography 1.27.1 after taking out the least-squares plane.

use std::path::{Path, PathBuf};

use plateau_core::surface::describe::{Description, Grid, PARAMETERS, Unit};
use plateau_core::surface::{Level, level};
use plateau_io::surface::{Measured, ReadOptions, read};
use serde_json::Value;

/// A file with the letter that its values start with.
struct Row {
    file: &'static str,
    letter: &'static str,
    /// Distance of neighbouring stored heights, µm: the values are those of the heights before they were rounded to it.
    step: f64,
    /// Sal, µm, and Str by another way to interpolate (see [`autocorrelation_is_that_of_a_finer_interpolation`]).
    spatial: Option<(f64, Option<f64>)>,
}

const fn row(file: &'static str, letter: &'static str, step: f64, spatial: Option<(f64, Option<f64>)>) -> Row {
    Row { file, letter, step, spatial }
}

const ROWS: &[Row] = &[
    row("alicona_200x296_iso1_int32.sdf", "A", 3.5558e-5, Some((12.406849, Some(0.460349)))),
    row("alicona_200x296_iso1_int16_ascii.sdf", "A", 3.2845e-5, Some((12.406893, Some(0.460352)))),
    row("lay_plu_384x288_iso1_binary64.sdf", "D", 0.0, Some((49.100353, None))),
    row("afm_256x256_iso2_int32.sdf", "E", 3.009e-10, None),
    row("frt_missing_150x300_iso1_int32.sdf", "F", 1.414e-7, None),
    row("pypi_afm_256x256_iso1_binary64.sdf", "G", 0.0, Some((0.060459, Some(0.698083)))),
];

/// The folder of shared surfaces, which is beside the repository, if it is there.
fn shared() -> Option<PathBuf> {
    let named = std::env::var_os("PLATEAU_SHARED").map(PathBuf::from);
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|folder| folder.join("shared"));
    let folder = named.into_iter().chain(above).map(|folder| folder.join("surfaces")).find(|folder| folder.is_dir());
    if folder.is_none() {
        println!("skipped: the shared surfaces are not here (set PLATEAU_SHARED to the folder that holds surfaces)");
    }
    folder
}

/// A levelled surface with what the peers say of it.
struct Compared {
    row: &'static Row,
    description: Description,
    /// Shorter of the two distances of neighbouring points, m.
    pitch: f64,
    peers: Value,
}

/// Every shared surface that is read.
fn surfaces() -> Vec<Compared> {
    let Some(folder) = shared() else { return Vec::new() };
    let text = std::fs::read_to_string(folder.join("values.json")).expect("values.json");
    // Python writes NaN, for which JSON has null.
    let values: Value = serde_json::from_str(&text.replace("NaN", "null")).expect("values.json");
    let values = values.as_object().expect("an object");
    let mut surfaces = Vec::new();
    for row in ROWS {
        let measured = read(&folder.join(row.file), &ReadOptions::default());
        let measured = measured.unwrap_or_else(|error| panic!("{}: {error}", row.file));
        let (_, peers) = values.iter().find(|(name, _)| name.starts_with(row.letter)).expect("values of the file");
        let pitch = measured.pitch.map_or(f64::NAN, |[x, y]| x.min(y));
        surfaces.push(Compared { row, description: describe(measured), pitch, peers: peers.clone() });
    }
    surfaces
}

fn describe(measured: Measured) -> Description {
    let Measured { columns, rows, pitch, mut heights, .. } = measured;
    level(&mut heights, rows, Level::Plane, false);
    Description::of(&Grid { columns, rows, pitch, heights: &heights }).expect("a measured point")
}

impl Compared {
    /// A parameter in the units of the peers: µm, and percent.
    fn own(&self, symbol: &str) -> f64 {
        let parameter = PARAMETERS.iter().find(|parameter| parameter.symbol == symbol).expect("a parameter");
        let value = (parameter.value)(&self.description).expect("a pitch");
        match parameter.unit {
            Unit::Height | Unit::Length => value * 1e6,
            Unit::Percent => value * 100.0,
            Unit::Number => value,
            Unit::Angle => value.to_degrees(),
        }
    }

    /// Holds a parameter against the value of a peer, if it has one; says whether it has.
    fn agrees(&self, peer: &str, symbol: &str, tolerance: impl Fn(f64) -> f64) -> bool {
        let Some(expected) = self.peers[peer][symbol].as_f64() else { return false };
        let (found, tolerance) = (self.own(symbol), tolerance(expected));
        let file = self.row.file;
        assert!((found - expected).abs() <= tolerance, "{file}, {symbol}: {found}, {peer} {expected} ± {tolerance:e}");
        true
    }
}

#[test]
fn height_parameters_are_those_of_other_programs() {
    for surface in surfaces() {
        // Beside 1e-6 there is what the file has rounded: of a single height half a step; in skewness and kurtosis, which
        // are means over all n points, 3 and 4 relative errors step/√12 of a height over Sq √n, taken 10 times.
        let step = surface.row.step;
        let points = surface.description.measured as f64;
        let relative_step = step / (surface.own("Sq") * points.sqrt());
        let mut compared = 0;
        for peer in ["own", "surfalize", "slippy"] {
            for symbol in ["Sa", "Sq", "Sp", "Sv", "Sz"] {
                compared += usize::from(surface.agrees(peer, symbol, |value| 1e-6 * value + step));
            }
            for symbol in ["Ssk", "Sku"] {
                let tolerance = |value: f64| 1e-6 * value.abs() + 12.0 * relative_step * value.abs().max(1.0);
                compared += usize::from(surface.agrees(peer, symbol, tolerance));
            }
        }
        assert!(compared >= 11, "{}: {compared} values", surface.row.file);
    }
}

#[test]
fn the_core_is_that_of_other_programs() {
    for surface in surfaces() {
        // The shared folder's own tolerances; surfalize takes 10 000 quantiles for the curve, we every point.
        let mut compared = 0;
        for (symbol, relative, absolute) in
            [("Sk", 5e-3, 0.0), ("Spk", 5e-3, 0.0), ("Svk", 5e-3, 0.0), ("Smr1", 0.0, 0.05), ("Smr2", 0.0, 0.05)]
        {
            compared += usize::from(surface.agrees("surfalize", symbol, |value| relative * value + absolute));
        }
        // It refuses surfaces with missing points. A curve from every point by another program agrees there, but for the
        // peaks: a spike of 234 µm on one of 32 686 points counts whole with us, half by the trapezoidal rule there.
        if surface.row.letter == "F" {
            for symbol in ["Sk", "Svk"] {
                compared += usize::from(surface.agrees("exact_sk", symbol, |value| 5e-3 * value));
            }
            for symbol in ["Smr1", "Smr2"] {
                compared += usize::from(surface.agrees("exact_sk", symbol, |_| 0.05));
            }
            let half_a_spike = surface.own("Sp") / 2.0 / surface.description.measured as f64;
            let peaks = 2.0 * half_a_spike / surface.description.core.peak_ratio;
            compared += usize::from(surface.agrees("exact_sk", "Spk", |value| 5e-3 * value + peaks));
        }
        assert_eq!(compared, 5, "{}", surface.row.file);
    }
}

#[test]
fn volumes_are_those_of_other_programs() {
    for surface in surfaces().iter().filter(|surface| surface.row.letter != "F") {
        // A measured tolerance, not a derived one: the largest difference is 3.6e-3, Vmp of B. surfalize sums 10 000 classes
        // up to the one before the material ratio; its rule in NumPy with that class put back is within 2e-4 of ours on B,
        // 7.3e-4 on all. Vvv of D keeps 1.8e-3, probably for its deep pits in the last few classes. The definition itself
        // is held by the uniform distribution in the tests of core.
        for symbol in ["Vmp", "Vmc", "Vvc", "Vvv", "Sxp"] {
            assert!(surface.agrees("surfalize", symbol, |value| 4e-3 * value), "{}", surface.row.file);
        }
    }
}

#[test]
fn slopes_are_those_of_surfalize_and_nearly_those_of_surface_topography() {
    for surface in surfaces() {
        let file = surface.row.file;
        // Rounding adds step/√12 twice to every difference, against Sdq times the pitch: once at random, which most of it
        // cancels over n points (three of its standard errors), once squared, which it does not.
        let part = surface.row.step / (surface.own("Sdq") * surface.pitch * 1e6);
        let points = surface.description.measured as f64;
        let rounded = |value: f64| (1e-9 + 3.0 * part / points.sqrt() + part * part) * value;
        if surface.row.letter != "F" {
            assert!(surface.agrees("surfalize", "Sdq", rounded), "{file}");
            assert!(surface.agrees("surfalize", "Sdr", |value| 2.0 * rounded(value)), "{file}");
            // SurfaceTopography leaves out the differences along x in the last row, and those along y in the last column:
            // of 75 to 384, with slopes like the others'.
            let peer = surface.peers["SurfaceTopography"]["rms_gradient"].as_f64().expect("a slope");
            let ratio = surface.own("Sdq") / peer;
            assert!((ratio - 1.0).abs() < 1.0 / 75.0 && ratio != 1.0, "{file}: {ratio}");
        }
    }
}

#[test]
fn autocorrelation_is_that_of_a_finer_interpolation() {
    // The same autocorrelation in NumPy and SciPy (fftconvolve over the overlap), followed from no lag to the edge of the
    // window in 3600 directions with cubic splines. Ours is linear between lines of the grid of lags: with a slope of
    // about 1/28 a point, the curvature between two lags moves the end by less than 0.1 points of 28 or more (A, D, G) or
    // 0.1 of 6 (B, C, where the shortest direction is along the grid, so that nothing is interpolated across).
    let mut compared = 0;
    for surface in surfaces() {
        let Some((length, ratio)) = surface.row.spatial else { continue };
        let (file, found) = (surface.row.file, surface.own("Sal"));
        assert!((found / length - 1.0).abs() < 0.1 / 28.0, "{file}: Sal {found}, expected {length}");
        let spatial = surface.description.autocorrelation.expect("a pitch");
        match ratio {
            Some(ratio) => assert!((spatial.aspect_ratio / ratio - 1.0).abs() < 0.2 / 28.0, "{file}: {spatial:?}"),
            // The lay does not end within the window.
            None => assert!(spatial.aspect_ratio.is_nan() && spatial.aspect_ratio_below < 0.5, "{file}: {spatial:?}"),
        }
        compared += 1;
    }
    assert!(compared >= 4 || shared().is_none());
}

#[test]
fn autocorrelation_lengths_are_nearly_those_of_surfalize() {
    for surface in surfaces().iter().filter(|surface| surface.row.letter != "F") {
        // It looks for the crossing of a spline at 1000 places from no lag to the first lag below the threshold, and takes
        // the shortest of all: up to a point of 1000 too short, beside the difference of the interpolations.
        assert!(surface.agrees("surfalize", "Sal", |value| (0.1 / 28.0 + 1e-3) * value), "{}", surface.row.file);
    }
}
