//! Every sample file, read as other programs read it.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::surface::Patch;
use plateau_io::surface::{ReadOptions, read};
use sha2::{Digest, Sha256};

use crate::fixtures::patch_of;

/// Where sample files are: those that come with the project, and the folder of surfaces that may not be committed.
fn folders() -> Vec<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let named = std::env::var_os("PLATEAU_SHARED").map(PathBuf::from);
    let shared = named.into_iter().chain(here.ancestors().map(|folder| folder.join("shared")));
    let shared = shared.flat_map(|folder| ["surfaces", "surfaces/sdf_reader_samples"].map(|name| folder.join(name)));
    [here.join("tests/surfaces"), here.join("../../data/surfaces")].into_iter().chain(shared).collect()
}

/// SHA-256 of the heights with one NaN for all.
fn digest(patch: &Patch) -> String {
    let mut digest = Sha256::new();
    for height in &patch.heights {
        digest.update(if height.is_nan() { 0x7ff8 << 48 } else { height.to_bits() }.to_le_bytes());
    }
    format!("{:x}", digest.finalize())
}

#[test]
fn every_sample_has_the_heights_that_other_programs_read() {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/surfaces/heights.tsv");
    let table = fs::read_to_string(table).unwrap();
    let mut absent = Vec::new();
    for line in table.lines().filter(|line| !line.starts_with('#')) {
        let [name, columns, rows, x, y, missing, expected] = line.split('\t').collect::<Vec<_>>()[..] else {
            panic!("{line}");
        };
        let Some(path) = folders().into_iter().map(|folder| folder.join(name)).find(|path| path.exists()) else {
            absent.push(name);
            continue;
        };
        let measured = read(&path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(measured.instrument && measured.warnings.is_empty(), "{name}: {:?}", measured.warnings);
        let patch = patch_of(measured);
        assert_eq!((patch.columns, patch.rows), (columns.parse().unwrap(), rows.parse().unwrap()), "{name}");
        assert_eq!((patch.column_pitch, patch.row_pitch), (x.parse().unwrap(), y.parse().unwrap()), "{name}");
        assert_eq!(patch.missing(), missing.parse::<usize>().unwrap(), "{name}");
        assert_eq!(digest(&patch), expected, "{name}");
    }
    for with_the_project in ["afm_256x256.sdf", "bcr1_surface_uint16_binary.sdf"] {
        assert!(!absent.contains(&with_the_project), "{with_the_project} comes with the project");
    }
    if !absent.is_empty() {
        println!("skipped, for PLATEAU_SHARED does not tell the folder that holds surfaces/: {}", absent.join(", "));
    }
}
