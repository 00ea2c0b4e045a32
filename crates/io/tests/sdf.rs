//! SDF files of other programs, and damaged ones.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::surface::Patch;
use plateau_io::surface::sdf::{self, SdfError};

/// Reads the whole content of a file.
fn read(content: &[u8]) -> Result<Patch, SdfError> {
    sdf::read(content, content.len() as u64).map(|surface| surface.patch)
}

/// A file of `tests/surfaces`.
fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/surfaces").join(name)
}

/// The measured surface that comes with the project.
fn afm() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/surfaces/afm_256x256.sdf")
}

/// A file of the folder of surfaces that may not be committed; says so and gives nothing where it is absent.
fn shared(name: &str) -> Option<PathBuf> {
    let named = std::env::var_os("PLATEAU_SHARED").map(PathBuf::from);
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|folder| folder.join("shared"));
    let found =
        named.into_iter().chain(above).map(|folder| folder.join("surfaces").join(name)).find(|path| path.exists());
    if found.is_none() {
        println!("skipped: {name} is not here (set PLATEAU_SHARED to the folder that holds surfaces/{name})");
    }
    found
}

/// Sa, Sq, Sz of the heights with the least-squares plane taken out, m, by Cholesky's decomposition of the normal
/// equations in coordinates from −1 to 1.
fn roughness(patch: &Patch) -> [f64; 3] {
    let unit = |index: usize, count: usize| 2.0 * (index as f64 + 0.5) / count as f64 - 1.0;
    let offset = patch.heights.iter().copied().find(|z| !z.is_nan()).unwrap();
    let points: Vec<([f64; 3], f64)> = (patch.heights.iter().enumerate())
        .filter(|(_, z)| !z.is_nan())
        .map(|(i, z)| ([1.0, unit(i / patch.rows, patch.columns), unit(i % patch.rows, patch.rows)], z - offset))
        .collect();
    let (mut normal, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
    for (basis, z) in &points {
        for i in 0..3 {
            right[i] += basis[i] * z;
            for j in 0..3 {
                normal[i][j] += basis[i] * basis[j];
            }
        }
    }
    let mut lower = [[0.0_f64; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let rest = normal[i][j] - (0..j).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
            lower[i][j] = if i == j { rest.sqrt() } else { rest / lower[j][j] };
        }
    }
    let mut plane = right;
    for i in 0..3 {
        plane[i] = (plane[i] - (0..i).map(|k| lower[i][k] * plane[k]).sum::<f64>()) / lower[i][i];
    }
    for i in (0..3).rev() {
        plane[i] = (plane[i] - (i + 1..3).map(|k| lower[k][i] * plane[k]).sum::<f64>()) / lower[i][i];
    }
    let residuals: Vec<f64> = points.iter().map(|(b, z)| z - (0..3).map(|k| plane[k] * b[k]).sum::<f64>()).collect();
    let count = residuals.len() as f64;
    let highest = residuals.iter().copied().fold(f64::MIN, f64::max);
    let lowest = residuals.iter().copied().fold(f64::MAX, f64::min);
    let absolute = residuals.iter().map(|z| z.abs()).sum::<f64>() / count;
    let square = residuals.iter().map(|z| z * z).sum::<f64>() / count;
    [absolute, square.sqrt(), highest - lowest]
}

fn read_sample(name: &str) -> Patch {
    read(&fs::read(sample(name)).unwrap()).unwrap()
}

/// Largest difference of two patches that miss the same points.
fn difference(one: &Patch, other: &Patch) -> f64 {
    assert_eq!((one.columns, one.rows), (other.columns, other.rows));
    let pairs = one.heights.iter().zip(&other.heights);
    pairs
        .filter(|(a, b)| {
            assert_eq!(a.is_nan(), b.is_nan());
            !a.is_nan()
        })
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

#[test]
fn samples_have_the_size_and_the_missing_points_of_their_description() {
    // README-sdfio.md: 48 columns by 32 rows, 2 um along x, 3 um along y; rows 10 to 13 and columns 20 to 29 missing.
    for name in ["iso1_surface", "iso1_surface_int32", "iso1_surface_binary64"] {
        for kind in ["ascii", "binary"] {
            let patch = read_sample(&format!("{name}_{kind}.sdf"));
            assert_eq!((patch.columns, patch.rows), (48, 32));
            assert_eq!((patch.column_pitch, patch.row_pitch), (2e-6, 3e-6));
            for (index, height) in patch.heights.iter().enumerate() {
                let hole = (20..=29).contains(&(index / 32)) && (10..=13).contains(&(index % 32));
                assert_eq!(height.is_nan(), hole, "{name}_{kind}: {index}");
            }
        }
    }
}

#[test]
fn ascii_and_binary_and_all_types_hold_the_same_surface() {
    // Half of the quantum of the coarser file: 1e-10 m for int16, 1e-13 m for int32; fifteen digits of up to 1.5 um in
    // ASCII binary64.
    let exact = read_sample("iso1_surface_binary64_binary.sdf");
    for (name, tolerance) in [("iso1_surface", 0.5e-10), ("iso1_surface_int32", 0.5e-13)] {
        let binary = read_sample(&format!("{name}_binary.sdf"));
        assert_eq!(difference(&binary, &read_sample(&format!("{name}_ascii.sdf"))), 0.0);
        assert!(difference(&binary, &exact) <= tolerance * 1.000_001, "{name}");
    }
    assert!(difference(&exact, &read_sample("iso1_surface_binary64_ascii.sdf")) < 1e-20);
    // First number of iso1_surface_ascii.sdf: 10000 quanta of 1e-10 m.
    assert!((exact.heights[0] - 1e-6).abs() < 1e-20);
}

#[test]
fn x_runs_along_a_profile_and_y_from_profile_to_profile() {
    // The surface that MountainsMap wrote is 30 y + x nm but for the missing last point of the first profile
    // (input_iso2_ascii.sdf); as binary64 it is up to 4.1e-15 m off.
    for (name, tolerance) in [("int32", 1e-20), ("binary64", 5e-15)] {
        for kind in ["ascii", "binary"] {
            let patch = read_sample(&format!("mm11_iso1_{kind}_{name}.sdf"));
            assert_eq!((patch.columns, patch.rows), (30, 20));
            assert_eq!((patch.column_pitch, patch.row_pitch, patch.missing()), (1e-6, 1e-6, 1));
            for (index, height) in patch.heights.iter().enumerate() {
                if height.is_nan() {
                    assert_eq!((index % 20, index / 20), (0, 29));
                    continue;
                }
                let expected = (30 * (index % 20) + index / 20) as f64 * 1e-9;
                assert!((height - expected).abs() < tolerance, "{name} {kind} {index}: {height}, {expected}");
            }
        }
    }
}

#[test]
fn int8_and_binary32_are_read_too() {
    // The ISO-2.0 samples turned into ISO-1.0: the counts have 2 bytes there instead of 4. The text holds 7 digits of
    // binary32 numbers up to 1.5 um.
    for (name, tolerance) in [("int8", 0.0), ("binary32", 1e-12)] {
        let mut binary = fs::read(sample(&format!("iso2_surface_{name}_binary.sdf"))).unwrap();
        binary.drain(48..50);
        binary.drain(44..46);
        binary[..8].copy_from_slice(b"bISO-1.0");
        let ascii = fs::read(sample(&format!("iso2_surface_{name}_ascii.sdf"))).unwrap();
        let ascii = [b"aISO-1.0", &ascii[8..]].concat();
        let binary = read(&binary).unwrap();
        assert_eq!(binary.missing(), 40);
        assert!(difference(&binary, &read(&ascii).unwrap()) <= tolerance, "{name}");
    }
}

/// Sa, Sq, Sz in um, on which surfalize 0.19.2, slippy 0.5.2 and SurfaceTopography 1.27.1 agree.
fn check_roughness(patch: &Patch, expected: [f64; 3]) {
    for (found, expected) in roughness(patch).iter().zip(expected) {
        assert!((found * 1e6 / expected - 1.0).abs() < 1e-6, "{found}, expected {expected} um");
    }
}

const AFM: [f64; 3] = [0.007850630292339372, 0.010084618656752626, 0.05503606503315581];

#[test]
fn roughness_of_the_afm_surface_is_that_of_other_programs() {
    let patch = read(&fs::read(afm()).unwrap()).unwrap();
    assert_eq!((patch.columns, patch.rows, patch.missing()), (256, 256, 0));
    assert_eq!((patch.column_pitch, patch.row_pitch), (1.953125e-9, 1.953125e-9));
    check_roughness(&patch, AFM);
}

#[test]
fn roughness_of_other_measured_surfaces_is_that_of_other_programs() {
    // An integer file is rounded to its quantum q, Sz therefore off by up to q: 3.6e-11 m for the int32 file of the
    // first surface, whose 76 mm offset leaves no more. Its levelled int16 file has q = 3.3e-11 m.
    let alicona = [0.2301961080656221, 0.28982210278362935, 2.086315790293156];
    let within_quantum = |patch: &Patch, quantum: f64| {
        let [absolute, square, range] = roughness(patch);
        assert!((absolute * 1e6 / alicona[0] - 1.0).abs() < 1e-6, "{absolute}");
        assert!((square * 1e6 / alicona[1] - 1.0).abs() < 1e-6, "{square}");
        assert!((range - alicona[2] * 1e-6).abs() < 1.01 * quantum, "{range}");
    };
    for (name, quantum) in [("iso1_int32", 3.56e-11), ("iso1_int16_ascii", 3.29e-11)] {
        if let Some(path) = shared(&format!("alicona_200x296_{name}.sdf")) {
            let patch = read(&fs::read(path).unwrap()).unwrap();
            assert_eq!((patch.columns, patch.rows), (200, 296));
            within_quantum(&patch, quantum);
        }
    }
    if let Some(path) = shared("lay_plu_384x288_iso1_binary64.sdf") {
        let patch = read(&fs::read(path).unwrap()).unwrap();
        assert_eq!((patch.columns, patch.rows), (384, 288));
        check_roughness(&patch, [0.01533611760776031, 0.01870224097567825, 0.5793340174370769]);
    }
    if let Some(path) = shared("frt_missing_150x300_iso1_int32.sdf") {
        let patch = read(&fs::read(path).unwrap()).unwrap();
        assert_eq!((patch.columns, patch.rows), (150, 300));
        assert_eq!(patch.missing() as f64 / 45_000.0, 0.27364444444444447);
        check_roughness(&patch, [1.0794543419468134, 8.716550224820224, 308.6614791135221]);
    }
}

#[test]
fn truncation_anywhere_is_an_error_or_only_costs_the_trailer() {
    for name in ["iso1_surface_ascii", "iso1_surface_binary", "mm11_iso1_ascii_int32", "mm11_iso1_binary_binary64"] {
        let content = fs::read(sample(&format!("{name}.sdf"))).unwrap();
        let whole = read(&content).unwrap();
        let text = name.contains("ascii");
        // Where the data end: the second line "*", or the bytes that the header promises.
        let star = |from: usize| content[from..].windows(2).position(|pair| pair == b"\n*").map_or(0, |at| from + at);
        let size = if name.contains("binary64") { 8 } else { 2 };
        let end = if text { star(star(0) + 2) + 2 } else { 81 + whole.heights.len() * size };
        for length in 0..content.len() {
            match read(&content[..length]) {
                Ok(patch) => {
                    assert!(length >= end, "{name} read from {length} bytes");
                    assert_eq!(patch.heights.len(), whole.heights.len());
                    assert_eq!(difference(&patch, &whole), 0.0);
                }
                Err(_) => assert!(length < end, "{name} not read from {length} bytes"),
            }
        }
    }
}

#[test]
fn a_damaged_binary_header_is_an_error_that_says_where() {
    let content = fs::read(sample("iso1_surface_int32_binary.sdf")).unwrap();
    let damaged = |offset: usize, bytes: &[u8]| {
        let mut content = content.clone();
        content[offset..offset + bytes.len()].copy_from_slice(bytes);
        read(&content).unwrap_err().to_string()
    };
    let real = |value: f64| value.to_le_bytes();
    for (offset, bytes, message) in [
        (
            7,
            b"1".to_vec(),
            "this is not an SDF file: starts with \"bISO-1.1\", expected \"aISO-1.0\", \"aISO-2.0\", \"aBCR-1.0\" or the same with \"b\"",
        ),
        (42, vec![0, 0], "byte 42: NumPoints is 0, expected at least 1"),
        (44, vec![0, 0], "byte 44: NumProfiles is 0, expected at least 1"),
        (
            44,
            vec![33, 0],
            "the file is truncated: ends at byte 6225, expected 6417 bytes for 48 x 33 heights of 4 bytes",
        ),
        (
            42,
            vec![255; 4],
            "the file is truncated: ends at byte 6225, expected 17179344981 bytes for 65535 x 65535 heights of 4 bytes",
        ),
        (46, real(f64::NAN).to_vec(), "byte 46: Xscale is NaN, expected a positive, finite number"),
        (54, real(f64::INFINITY).to_vec(), "byte 54: Yscale is inf, expected a positive, finite number"),
        (62, real(0.0).to_vec(), "byte 62: Zscale is 0, expected a positive, finite number"),
        (62, real(-1.0).to_vec(), "byte 62: Zscale is -1, expected a positive, finite number"),
        (78, vec![1], "byte 78: Compression is 1, expected 0: compressed data are not read"),
        (79, vec![1], "byte 79: DataType is 1, expected 3 (binary32), 4 (int8), 5 (int16), 6 (int32) or 7 (binary64)"),
        (79, vec![7], "the file is truncated: ends at byte 6225, expected 12369 bytes for 48 x 32 heights of 8 bytes"),
        (80, vec![1], "byte 80: CheckType is 1, expected 0: data with check sums are not read"),
        (62, real(1e302).to_vec(), "byte 81: found the height \"inf\", expected a finite number times Zscale"),
    ] {
        assert_eq!(damaged(offset, &bytes), message);
    }
}

#[test]
fn a_damaged_text_is_an_error_that_says_where() {
    let content = String::from_utf8(fs::read(sample("iso1_surface_ascii.sdf")).unwrap()).unwrap();
    let first = content.lines().nth(14).unwrap();
    for (from, to, message) in [
        ("aISO-1.0", "aISO-1.00", "this is not an SDF file: starts with \"aISO-1.00\", expected"),
        ("NumPoints = 48", "NumPoints = 48.5", "line 5: NumPoints is \"48.5\", expected a whole number"),
        ("NumPoints = 48", "NumPoints = -1", "line 5: NumPoints is -1, expected at least 1"),
        ("NumPoints = 48", "NumPoints: 48", "line 5: found \"NumPoints: 48\", expected a header field"),
        ("NumPoints = 48", "NumPoints = 47", "line 46: more heights than NumPoints x NumProfiles = 47 x 32"),
        ("NumPoints = 48", "NumPoints = 49", "line 47: the data end after 1536 heights, expected NumPoints x"),
        ("NumPoints = 48", "NumPoints = 4000000000000", "the file is truncated: ends at byte"),
        ("NumProfiles = 32", "NumPoints = 32", "line 6: the field NumPoints stands twice"),
        ("Zscale = 1.00000000000000e-010\r\n", "", "line 13: the header ends without the field Zscale"),
        ("Zscale = 1.00000000000000e-010", "Zscale = -0", "line 9: Zscale is -0, expected a positive, finite number"),
        ("Zscale = 1.00000000000000e-010", "Zscale = 1e400", "line 9: Zscale is inf, expected a positive"),
        ("Xscale = 2", "Xscale = NaN2", "line 7: Xscale is \"NaN2.00000000000000e-006\", expected a positive"),
        ("DataType = 5", "DataType = 0", "line 12: DataType is 0, expected 3 (binary32)"),
        (first, "1.5", "line 15: found the height \"1.5\", expected an int16 number"),
        (first, "32768", "line 15: found the height \"32768\", expected an int16 number"),
        (first, "inf", "line 15: found the height \"inf\", expected an int16 number"),
    ] {
        let found = read(content.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
        assert!(found.starts_with(message), "{found}\nexpected {message}");
    }
    let infinite = content.replacen("DataType = 5", "DataType = 7", 1).replacen(first, "inf", 1);
    assert!(matches!(read(infinite.as_bytes()), Err(SdfError::Height { .. })));
}

#[test]
fn line_ends_blanks_and_order_of_the_text_do_not_matter() {
    let content = String::from_utf8(fs::read(sample("iso1_surface_ascii.sdf")).unwrap()).unwrap();
    let expected = read(content.as_bytes()).unwrap();
    let swapped = content.replacen("NumPoints = 48\r\nNumProfiles = 32", "numprofiles=32\r\n\r\nNUMPOINTS =48", 1);
    for text in [content.replace("\r\n", "\n"), content.replace(' ', "  "), format!("\u{feff} {content}"), swapped] {
        assert_eq!(difference(&read(text.as_bytes()).unwrap(), &expected), 0.0);
    }
}
