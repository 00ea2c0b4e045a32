//! SDF files of other programs, and damaged ones.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::surface::Patch;
use plateau_io::surface::sdf::{self, SdfError};

/// Reads the whole content of a file.
pub(crate) fn read(content: &[u8]) -> Result<Patch, SdfError> {
    sdf::read(content, content.len() as u64).map(|surface| surface.patch)
}

/// A file of `tests/surfaces`.
fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/surfaces").join(name)
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
fn what_is_damaged_is_an_error_that_says_where() {
    let mut found = String::new();
    let mut refuse = |what: String, content: &[u8]| {
        found.push_str(&format!("{what}\n    {}\n", read(content).unwrap_err()));
    };
    let binary = fs::read(sample("iso1_surface_int32_binary.sdf")).unwrap();
    let real = |value: f64| value.to_le_bytes();
    for (offset, bytes) in [
        (7, &b"1"[..]),
        (42, &[0, 0]),
        (44, &[0, 0]),
        (44, &[33, 0]),
        (42, &[255; 4]),
        (46, &real(f64::NAN)),
        (54, &real(f64::INFINITY)),
        (62, &real(0.0)),
        (62, &real(-1.0)),
        (78, &[1]),
        (79, &[1]),
        (79, &[7]),
        (80, &[1]),
        (62, &real(1e302)),
    ] {
        let mut content = binary.clone();
        content[offset..offset + bytes.len()].copy_from_slice(bytes);
        refuse(format!("byte {offset}: {bytes:?}"), &content);
    }
    let text = String::from_utf8(fs::read(sample("iso1_surface_ascii.sdf")).unwrap()).unwrap();
    let first = text.lines().nth(14).unwrap();
    for (from, to) in [
        ("aISO-1.0", "aISO-1.00"),
        ("NumPoints = 48", "NumPoints = 48.5"),
        ("NumPoints = 48", "NumPoints = -1"),
        ("NumPoints = 48", "NumPoints: 48"),
        ("NumPoints = 48", "NumPoints = 47"),
        ("NumPoints = 48", "NumPoints = 49"),
        ("NumPoints = 48", "NumPoints = 4000000000000"),
        ("NumProfiles = 32", "NumPoints = 32"),
        ("Zscale = 1.00000000000000e-010\r\n", ""),
        ("Zscale = 1.00000000000000e-010", "Zscale = -0"),
        ("Zscale = 1.00000000000000e-010", "Zscale = 1e400"),
        ("Xscale = 2", "Xscale = NaN2"),
        ("DataType = 5", "DataType = 0"),
        (first, "1.5"),
        (first, "32768"),
        (first, "inf"),
    ] {
        refuse(format!("{from:?} is {to:?}"), text.replacen(from, to, 1).as_bytes());
    }
    let infinite = text.replacen("DataType = 5", "DataType = 7", 1).replacen(first, "inf", 1);
    refuse("an infinite binary64".to_owned(), infinite.as_bytes());
    insta::assert_snapshot!(found);
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
