//! The parameters of measured surfaces against those that other programs compute: `values.json` in the folder of shared
//! surfaces, made with surfalize 0.19.2, slippy 0.5.2 and SurfaceTopography 1.27.1 after taking out the least-squares plane.

use std::path::{Path, PathBuf};

use plateau_core::surface::describe::{Description, Grid, PARAMETERS};
use plateau_core::surface::{Level, level};
use plateau_io::surface::{FileError, Measured, ReadOptions, read};
use serde_json::Value;

/// Files and the letter that their values start with.
const FILES: &[(&str, &str)] = &[
    ("alicona_200x296_iso1_int32.sdf", "A"),
    ("alicona_200x296_iso1_int16_ascii.sdf", "A"),
    ("dhm_grooves_75x305.txt", "B"),
    ("lay_200x200.x3p", "C"),
    ("lay_plu_384x288_iso1_binary64.sdf", "D"),
    ("afm_256x256_iso2_int32.sdf", "E"),
    ("frt_missing_150x300_iso1_int32.sdf", "F"),
    ("pypi_afm_256x256_iso1_binary64.sdf", "G"),
];

/// Formats that this version does not read yet.
const NOT_YET: &[&str] = &["dhm_grooves_75x305.txt", "lay_200x200.x3p", "afm_256x256_iso2_int32.sdf"];

/// The folder of shared surfaces, which is beside the repository, if it is there.
fn shared() -> Option<PathBuf> {
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|folder| folder.join("shared/surfaces"));
    let folder = above.into_iter().find(|folder| folder.is_dir());
    if folder.is_none() {
        println!("skipped: there is no folder shared/surfaces above this repository");
    }
    folder
}

/// A levelled surface, described.
fn describe(measured: Measured) -> Description {
    let Measured { columns, rows, pitch, mut heights, .. } = measured;
    level(&mut heights, rows, Level::Plane, false);
    Description::of(&Grid { columns, rows, pitch, heights: &heights }).expect("a measured point")
}

/// Every shared surface that is read, with what the peers say of it.
fn surfaces() -> Vec<(&'static str, Description, Value)> {
    let Some(folder) = shared() else { return Vec::new() };
    let text = std::fs::read_to_string(folder.join("values.json")).expect("values.json");
    // Python writes NaN, for which JSON has null.
    let values: Value = serde_json::from_str(&text.replace("NaN", "null")).expect("values.json");
    let values = values.as_object().expect("an object");
    let mut surfaces = Vec::new();
    for (file, letter) in FILES {
        let measured = match read(&folder.join(file), &ReadOptions::default()) {
            Err(FileError::NotReadable(format)) if NOT_YET.contains(file) => {
                println!("skipped: {file} is {format}");
                continue;
            }
            measured => measured.unwrap_or_else(|error| panic!("{file}: {error}")),
        };
        assert!(!NOT_YET.contains(file), "{file} is read by now");
        let (_, peers) = values.iter().find(|(name, _)| name.starts_with(letter)).expect("values of the file");
        surfaces.push((*file, describe(measured), peers.clone()));
    }
    surfaces
}

/// A parameter in the units of the peers: µm, and percent where the list says so.
fn value(description: &Description, symbol: &str) -> f64 {
    use plateau_core::surface::describe::Unit;
    let parameter = PARAMETERS.iter().find(|parameter| parameter.symbol == symbol).expect("a parameter");
    let value = (parameter.value)(description).expect("a pitch");
    match parameter.unit {
        Unit::Height | Unit::Length => value * 1e6,
        Unit::Percent => value * 100.0,
        Unit::Number => value,
    }
}

#[test]
fn dump() {
    for (file, description, peers) in surfaces() {
        println!("{file}");
        for parameter in PARAMETERS {
            let own = value(&description, parameter.symbol);
            let peer = |name: &str| peers[name][parameter.symbol].as_f64();
            let surfalize = peer("surfalize").unwrap_or(f64::NAN);
            println!(
                "  {:6} {own:14.8} {surfalize:14.8} {:+.1e}  {:?} {:?}",
                parameter.symbol,
                own / surfalize - 1.0,
                peer("own"),
                peer("exact_sk").map(|v| (v, own / v - 1.0))
            );
        }
        println!("  {:?}", description.autocorrelation);
    }
}
