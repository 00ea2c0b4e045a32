//! Images read as pictures, of every format.

use std::fs;

use plateau_io::surface::stated_pixel;
use proptest::prelude::*;
use proptest::sample::Index;

use super::bytes::changes;
use super::harness::{Fuzz, corpus_of};

#[test]
fn changed_images_are_read_or_refused() {
    let folders = ["pictures", "surfaces"].map(|name| fs::read_dir(corpus_of(name)).unwrap());
    let mut paths: Vec<_> = folders.into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ["jpg", "png", "tif"].iter().any(|one| ending == *one)));
    paths.sort();
    assert!(paths.len() > 10, "the corpus is not here");
    let files: Vec<Vec<u8>> = paths.iter().map(|path| fs::read(path).unwrap()).collect();
    let strategy = (any::<Index>(), changes()).prop_map(move |(file, changes)| {
        let mut content = files[file.index(files.len())].clone();
        changes.iter().for_each(|change| change.apply(&mut content));
        content
    });
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed");
    Fuzz { corpus: "pictures", cases: 2000, least_accepted: 100 }.run(strategy, |content| {
        fs::write(&path, content).unwrap();
        match stated_pixel(&path) {
            Err(error) => prop_assert!(!error.to_string().is_empty()),
            Ok(pixel) => {
                prop_assert!(pixel.is_none_or(|pixel| pixel > 0.0 && pixel.is_finite()));
                return Ok(true);
            }
        }
        Ok(false)
    });
}
