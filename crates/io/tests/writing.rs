//! Surfaces written and read again.

use std::fs;
use std::path::Path;

use plateau_core::surface::Patch;
use plateau_io::surface::sdf::{Dialect, Encoding, SdfKind};
use plateau_io::surface::{Format, ReadOptions, WriteError, read, write};

use crate::fixtures::{entries, patch_of, place};

/// Heights of every size and sign, missing points at the corners and in a row, pitches that decimals round.
fn patch(columns: usize, rows: usize) -> Patch {
    let mut heights: Vec<f64> = (0..columns * rows).map(|i| 1e-6 * (0.7 * i as f64).sin() / 3.0).collect();
    for (index, height) in [-0.0, 5e-324, -1e-310, 1e3, -1e3, 0.1, 1.0 / 3.0].iter().enumerate() {
        heights[index * 3 % (columns * rows)] = *height;
    }
    for index in [0, rows - 1, columns * rows - 1, columns * rows / 2, columns * rows / 2 + 1] {
        heights[index % (columns * rows)] = f64::NAN;
    }
    Patch { columns, rows, column_pitch: 1e-6 / 3.0, row_pitch: 0.1, heights }
}

fn check_equal(found: &Patch, expected: &Patch) {
    assert_eq!((found.columns, found.rows), (expected.columns, expected.rows));
    assert_eq!((found.column_pitch, found.row_pitch), (expected.column_pitch, expected.row_pitch));
    for (found, expected) in found.heights.iter().zip(&expected.heights) {
        assert!(found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan()), "{found} {expected}");
    }
}

fn read_patch(path: &Path) -> Patch {
    let measured = read(path, &ReadOptions::default()).unwrap();
    assert_eq!(measured.warnings, [""; 0]);
    patch_of(measured)
}

#[test]
fn what_was_written_is_read_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    for (columns, rows) in [(17, 40), (40, 17), (9, 1), (1, 9), (1, 1)] {
        let patch = patch(columns, rows);
        for name in ["out.sdf", "out.H5"] {
            let path = folder.path().join(name);
            write(&path, &patch, true).unwrap();
            check_equal(&read_patch(&path), &patch);
        }
        // An array has no pitch.
        let path = folder.path().join("out.npy");
        write(&path, &patch, true).unwrap();
        let size = 128 + 8 * patch.heights.len() as u64;
        assert_eq!(fs::metadata(&path).unwrap().len(), size, "data start at a multiple of 64");
        assert_eq!(read(&path, &ReadOptions::default()).unwrap().pitch, None);
        let options = ReadOptions { pitch: Some([patch.column_pitch, patch.row_pitch]), ..ReadOptions::default() };
        check_equal(&patch_of(read(&path, &options).unwrap()), &patch);
    }
}

#[test]
fn sdf_is_iso_1_and_binary_unless_there_are_too_many_points_or_some_are_missing() {
    let (_folder, path) = place("out.sdf");
    for (columns, missing, dialect, encoding) in [
        (65_535, false, Dialect::Iso1, Encoding::Binary),
        (65_536, true, Dialect::Iso1, Encoding::Ascii),
        (65_536, false, Dialect::Iso2, Encoding::Binary),
    ] {
        let mut patch = patch(columns, 1);
        if !missing {
            patch.heights.iter_mut().filter(|height| height.is_nan()).for_each(|height| *height = 0.0);
        }
        write(&path, &patch, true).unwrap();
        let kind = SdfKind { dialect, encoding };
        assert_eq!(read(&path, &ReadOptions::default()).unwrap().format, Format::Sdf(kind));
        check_equal(&read_patch(&path), &patch);
    }
}

#[test]
fn an_existing_file_is_replaced_only_when_that_is_asked_for_and_never_damaged() {
    let (folder, path) = place("out.h5");
    fs::write(&path, "precious").unwrap();
    let error = write(&path, &patch(4, 5), false).unwrap_err();
    assert!(matches!(error, WriteError::Exists { .. }));
    let mut wrong = patch(4, 5);
    wrong.heights[7] = f64::INFINITY;
    let found = write(&path, &wrong, true).unwrap_err().to_string();
    assert!(found.ends_with("out.h5: the height at (column 1, row 2) is infinite"), "{found}");
    assert_eq!(fs::read(&path).unwrap(), b"precious");
    write(&path, &patch(4, 5), true).unwrap();
    check_equal(&read_patch(&path), &patch(4, 5));
    assert_eq!(entries(folder.path()), ["out.h5"]);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_a_folder_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let (file, link) = (folder.path().join("file.sdf"), folder.path().join("link.sdf"));
    fs::write(&file, "old").unwrap();
    std::os::unix::fs::symlink("file.sdf", &link).unwrap();
    write(&link, &patch(3, 3), true).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    check_equal(&read_patch(&file), &patch(3, 3));
    let inner = folder.path().join("folder.sdf");
    fs::create_dir(&inner).unwrap();
    assert!(matches!(write(&inner, &patch(3, 3), true), Err(WriteError::NotAFile { .. })));
}

#[test]
fn what_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str, patch: &Patch| {
        let path = folder.path().join(name);
        let found = write(&path, patch, false).unwrap_err().to_string();
        found.replace(&folder.path().display().to_string(), "FOLDER")
    };
    let good = patch(3, 4);
    let flat = Patch { row_pitch: 0.0, ..good.clone() };
    let short = Patch { rows: 5, ..good.clone() };
    let empty = Patch { rows: 0, heights: Vec::new(), ..good.clone() };
    for (name, patch, expected) in [
        ("a.csv", &good, "FOLDER/a.csv: ending .csv, expected the ending .sdf, .npy or .h5"),
        ("a", &good, "FOLDER/a: no ending, expected the ending .sdf, .npy or .h5"),
        ("a.sdf", &flat, "FOLDER/a.sdf: the pitch is 0 m, expected a positive, finite number"),
        ("a.sdf", &short, "FOLDER/a.sdf: 12 heights are not 3 x 5 points"),
        ("a.h5", &empty, "FOLDER/a.h5: 0 heights are not 3 x 0 points"),
        ("no/a.sdf", &good, "writing FOLDER/no/a.sdf failed: No such file or directory (os error 2)"),
    ] {
        assert_eq!(message(name, patch), expected);
    }
    assert_eq!(entries(folder.path()), [""; 0]);
}
