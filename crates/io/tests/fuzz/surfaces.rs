//! Surface files of every format. A new format is covered as soon as the corpus has a file of it.

use std::fs;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};

use plateau_io::surface::{Decimal, Lay, ReadOptions, read};
use proptest::prelude::*;
use proptest::sample::Index;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::bytes::changes;
use super::harness::{Fuzz, corpus_of};

/// An archive with one of its entries changed and everything else as it should be; nothing for other files.
fn with_entry_changed(content: &[u8], entry: Index, change: impl Fn(&mut Vec<u8>)) -> Option<Vec<u8>> {
    let mut archive = ZipArchive::new(Cursor::new(content)).ok()?;
    let mut changed = ZipWriter::new(Cursor::new(Vec::new()));
    let which = entry.index(archive.len().max(1));
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).ok()?;
        let mut content = Vec::new();
        entry.by_ref().take(1 << 20).read_to_end(&mut content).ok()?;
        if index == which {
            change(&mut content);
        }
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        changed.start_file(entry.name().ok()?, options).ok()?;
        changed.write_all(&content).ok()?;
    }
    Some(changed.finish().ok()?.into_inner())
}

/// Every file of the corpus, in the order of their names.
fn corpus_files() -> Vec<(PathBuf, Vec<u8>)> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(corpus_of("surfaces")).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_none_or(|ending| ending != "md"));
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), fs::read(path).unwrap())).collect()
}

/// Options of which one suits each format: a format refuses what has no meaning for it.
fn all_options() -> [ReadOptions; 6] {
    let pitch = Some([1e-6, 2e-6]);
    let images = ReadOptions { pitch, height_range: Some([0.0, 1e-6]), ..ReadOptions::default() };
    let tables = ReadOptions { pitch, unit: Some(1e-6), ..ReadOptions::default() };
    let arrays = ReadOptions { pitch, dataset: Some("a".into()), ..ReadOptions::default() };
    let profiles = ReadOptions { profile_lay: Some(Lay::Along), ..ReadOptions::default() };
    let skipping = ReadOptions { skip: Some(2), decimal: Some(Decimal::Comma), ..tables.clone() };
    [ReadOptions::default(), images, tables, arrays, profiles, skipping]
}

/// Reads a file; what comes out must be an error with a text or a surface. Says which.
fn check(path: &Path) -> Result<bool, TestCaseError> {
    let mut is_read = false;
    for options in all_options() {
        match read(path, &options) {
            Err(error) => prop_assert!(!error.to_string().is_empty()),
            Ok(measured) => {
                is_read = true;
                prop_assert_eq!(Some(measured.heights.len()), measured.columns.checked_mul(measured.rows));
                prop_assert!(!measured.heights.is_empty());
                prop_assert!(measured.heights.iter().all(|height| !height.is_infinite()));
                prop_assert!(measured.pitch.iter().flatten().all(|pitch| *pitch > 0.0 && pitch.is_finite()));
            }
        }
    }
    Ok(is_read)
}

#[test]
fn every_file_of_the_corpus_is_read_or_refused() {
    let files = corpus_files();
    assert!(files.len() > 20, "the corpus is not here");
    let refused =
        files.iter().filter(|(path, _)| !check(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())));
    let refused: Vec<_> = refused.map(|(path, _)| path.file_name().unwrap_or_default().to_string_lossy()).collect();
    // What random changes found is mostly damaged; the others are good.
    let good: Vec<_> = refused.into_iter().filter(|name| !name.starts_with("found-")).collect();
    assert_eq!(good, [""; 0], "the files that are changed must be good ones");
}

#[test]
fn changed_files_are_read_or_refused() {
    let files: Vec<Vec<u8>> = corpus_files().into_iter().map(|(_, content)| content).collect();
    let strategy =
        (any::<Index>(), any::<Index>(), any::<bool>(), changes()).prop_map(move |(file, entry, inside, changes)| {
            let content = &files[file.index(files.len())];
            let change = |content: &mut Vec<u8>| changes.iter().for_each(|change| change.apply(content));
            inside.then(|| with_entry_changed(content, entry, change)).flatten().unwrap_or_else(|| {
                let mut content = content.clone();
                change(&mut content);
                content
            })
        });
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed");
    Fuzz { corpus: "surfaces", cases: 2000, least_accepted: 100 }.run(strategy, |content| {
        fs::write(&path, content).unwrap();
        check(&path)
    });
}
