//! Damaged surface files of every format: whatever the bytes, a surface or an error, in bounded time and memory.
//!
//! The files of `tests/corpus/surfaces` are changed at random, byte by byte, and archives also entry by entry. Some
//! thousand changes are tried by default, always the same; `PLATEAU_FUZZ_SECONDS=600` tries new ones for ten minutes. A
//! file that fails is put into the corpus, so that it is tried first from then on. A new format is covered as soon as
//! the corpus has a file of it.

use std::cell::Cell;
use std::fs;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use plateau_io::surface::{Decimal, Lay, ReadOptions, read};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngAlgorithm, TestError, TestRng, TestRunner};
use sha2::{Digest, Sha256};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// Changes that are tried by default.
const CASES: u32 = 2000;
/// Longest that one file may take; they have a few kB.
const LONGEST: Duration = Duration::from_secs(5);
/// Bytes at the start of a file that are changed more often than others.
const HEAD: usize = 128;
/// Most memory that the whole test may take, in kB.
const MOST_MEMORY: u64 = 1 << 20;

/// A place in a file: in its first bytes, where headers are, or anywhere.
#[derive(Debug, Clone, Copy)]
struct Place {
    index: Index,
    head: bool,
}

impl Place {
    fn within(self, content: &[u8]) -> usize {
        self.index.index(if self.head { content.len().min(HEAD) } else { content.len() } + 1).min(content.len())
    }
}

/// One change of some bytes.
#[derive(Debug, Clone)]
enum Change {
    Flip(Place, u8),
    Put(Place, Vec<u8>),
    Insert(Place, Vec<u8>),
    Remove(Place, u8),
    Repeat(Place, u8, u8),
    Cut(Place),
}

impl Change {
    fn apply(&self, content: &mut Vec<u8>) {
        match self {
            Self::Flip(at, bits) => {
                let at = at.within(content);
                if let Some(byte) = content.get_mut(at) {
                    *byte ^= bits;
                }
            }
            Self::Put(at, bytes) => {
                let at = at.within(content);
                content[at..].iter_mut().zip(bytes).for_each(|(old, new)| *old = *new);
            }
            Self::Insert(at, bytes) => {
                let at = at.within(content);
                content.splice(at..at, bytes.iter().copied());
            }
            Self::Remove(at, count) => {
                let at = at.within(content);
                content.drain(at..content.len().min(at + usize::from(*count)));
            }
            Self::Repeat(at, count, times) => {
                let at = at.within(content);
                let bytes = content[at..content.len().min(at + usize::from(*count))].repeat(usize::from(*times));
                content.splice(at..at, bytes);
            }
            Self::Cut(at) => content.truncate(at.within(content)),
        }
    }
}

/// Bytes that readers stumble over: numbers at the limits of their types, words and signs of the formats.
fn odd_bytes() -> impl Strategy<Value = Vec<u8>> {
    let reals =
        [f64::NAN, f64::INFINITY, -1.0, 0.0, -0.0, 1e308, 5e-324, 1e-300].map(|real| real.to_le_bytes().to_vec());
    let integers = [0, 1, 0x7f, 0x80, 0xff, 0x7fff, 0x8000, 0xffff, i32::MAX as u32, 1 << 31, u32::MAX]
        .map(|integer| integer.to_le_bytes().to_vec());
    let words = [
        "*",
        "BAD",
        "nan",
        "inf",
        "-1",
        "0",
        "1e999",
        "2147483648",
        "18446744073709551616",
        ";",
        "=",
        ",",
        "\n",
        "\r\n",
        "<",
        "/>",
        "&a;",
        "&#0;",
        "<!DOCTYPE a [<!ENTITY b 'c'>]>",
        "<![CDATA[",
        "]]>",
        "<!--",
        "\0",
        "\u{feff}",
        "I",
        "A",
        "D",
        "NumPoints = 4294967295",
        "<Datum/>",
        "1;2;3",
        "1,234",
        "Bad\t",
        "X Size\t4294967295\n",
        "\"Horizontal\",\"99999999999\"\n",
        "#\n",
        "'fortran_order': True, ",
        "'descr': '<f8', ",
    ];
    let words = words.map(|word| word.as_bytes().to_vec());
    prop_oneof![
        prop::sample::select(reals.to_vec()),
        prop::sample::select(integers.to_vec()),
        prop::sample::select(words.to_vec()),
        prop::collection::vec(any::<u8>(), 1..9),
    ]
}

fn changes() -> impl Strategy<Value = Vec<Change>> {
    let place = || (any::<Index>(), any::<bool>()).prop_map(|(index, head)| Place { index, head });
    let change = prop_oneof![
        (place(), any::<u8>()).prop_map(|(at, bits)| Change::Flip(at, bits)),
        (place(), odd_bytes()).prop_map(|(at, bytes)| Change::Put(at, bytes)),
        (place(), odd_bytes()).prop_map(|(at, bytes)| Change::Insert(at, bytes)),
        (place(), any::<u8>()).prop_map(|(at, count)| Change::Remove(at, count)),
        (place(), any::<u8>(), any::<u8>()).prop_map(|(at, count, times)| Change::Repeat(at, count, times)),
        place().prop_map(Change::Cut),
    ];
    prop::collection::vec(change, 1..6)
}

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

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/surfaces")
}

/// Every file of the corpus, in the order of their names.
fn corpus_files() -> Vec<(PathBuf, Vec<u8>)> {
    let mut paths: Vec<PathBuf> = fs::read_dir(corpus()).unwrap().map(|entry| entry.unwrap().path()).collect();
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
    let start = Instant::now();
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
    prop_assert!(start.elapsed() < LONGEST, "{:?} for one file", start.elapsed());
    Ok(is_read)
}

/// Most memory that this process has taken so far, in kB, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix("kB")?.trim().parse().ok())
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
        (any::<Index>(), any::<Index>(), any::<bool>(), changes()).prop_map(|(file, entry, inside, changes)| {
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
    let seconds = std::env::var("PLATEAU_FUZZ_SECONDS").ok().map(|text| text.parse().unwrap());
    let (start, tried, accepted) = (Instant::now(), Cell::new(0_u32), Cell::new(0_u32));
    let duration = Duration::from_secs(seconds.unwrap_or(0));
    loop {
        // A runner counts over all its runs and does nothing once it has enough, so each batch has its own.
        // A defect in the bounds of memory makes each try slow: made smaller for half a minute at most.
        let config = Config { cases: CASES, failure_persistence: None, max_shrink_time: 30_000, ..Config::default() };
        let mut runner = match seconds {
            None => TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::default())),
            Some(_) => TestRunner::new(config),
        };
        let before = tried.get();
        let result = runner.run(&strategy, |content| {
            fs::write(&path, content).unwrap();
            tried.set(tried.get() + 1);
            accepted.set(accepted.get() + u32::from(check(&path)?));
            Ok(())
        });
        if let Err(TestError::Fail(reason, content)) = &result {
            let name = format!("found-{:.12}", format!("{:x}", Sha256::digest(content)));
            fs::write(corpus().join(&name), content).unwrap();
            panic!("{reason}; the file is {} now", corpus().join(name).display());
        }
        result.unwrap();
        assert!(tried.get() >= before + CASES, "a batch must try files");
        if start.elapsed() >= duration {
            break;
        }
    }
    let (tried, accepted) = (tried.get(), accepted.get());
    let memory = peak_memory();
    println!("{tried} changed files in {:.0?}, {accepted} read, at most {memory:?} kB of memory", start.elapsed());
    assert!(accepted > tried / 100, "so few changed files are still read that the readers are hardly reached");
    assert!(memory.is_none_or(|kilobytes| kilobytes < MOST_MEMORY), "{memory:?} kB of memory");
}
