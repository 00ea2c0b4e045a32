//! How changed files are tried, again and again or for some time, and kept when they fail.

use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestError, TestRng, TestRunner};
use sha2::{Digest, Sha256};

/// Longest that one file may take, without optimisation: they have a few kB.
const LONGEST: Duration = Duration::from_secs(20);
/// Most memory that all tests of this program may take together, in kB.
const MOST_MEMORY: u64 = 2 << 20;

/// A kind of files.
pub(super) struct Fuzz {
    /// Folder of `tests/corpus` that takes what fails.
    pub(super) corpus: &'static str,
    /// Changes that are tried by default.
    pub(super) cases: u32,
    /// At least one in so many is still accepted, else hardly anything behind the first checks is reached.
    pub(super) least_accepted: u32,
}

/// A folder of kept files.
pub(super) fn corpus_of(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(name)
}

/// The files of a kind that failed before.
pub(super) fn found(name: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(corpus_of(name)).into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = entries
        .filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("found-")))
        .collect();
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), fs::read(path).unwrap())).collect()
}

impl Fuzz {
    /// Tries files. `check` says whether one was accepted, and fails where there was no answer.
    pub(super) fn run(
        &self,
        strategy: impl Strategy<Value = Vec<u8>>,
        check: impl Fn(&[u8]) -> Result<bool, TestCaseError>,
    ) {
        let timed = |content: &[u8]| {
            let start = Instant::now();
            let answer = check(content);
            prop_assert!(start.elapsed() < LONGEST, "{:?} for one file", start.elapsed());
            answer
        };
        for (path, content) in found(self.corpus) {
            timed(&content).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        }
        let seconds = std::env::var("PLATEAU_FUZZ_SECONDS").ok().map(|text| text.parse().unwrap());
        let (start, tried, accepted) = (Instant::now(), Cell::new(0_u32), Cell::new(0_u32));
        let duration = Duration::from_secs(seconds.unwrap_or(0));
        loop {
            // A runner counts over all its runs and does nothing once it has enough, so each batch has its own.
            // A defect in the bounds of memory makes each try slow: made smaller for half a minute at most.
            let config =
                Config { cases: self.cases, failure_persistence: None, max_shrink_time: 30_000, ..Config::default() };
            let mut runner = match seconds {
                None => TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::default())),
                Some(_) => TestRunner::new(config),
            };
            let before = tried.get();
            let result = runner.run(&strategy, |content| {
                tried.set(tried.get() + 1);
                accepted.set(accepted.get() + u32::from(timed(&content)?));
                Ok(())
            });
            if let Err(TestError::Fail(reason, content)) = &result {
                self.keep(content, &reason.to_string());
            }
            result.unwrap();
            assert!(tried.get() >= before + self.cases, "a batch must try files");
            if start.elapsed() >= duration {
                break;
            }
        }
        let (tried, accepted, memory) = (tried.get(), accepted.get(), peak_memory());
        let corpus = self.corpus;
        println!(
            "{corpus}: {tried} files in {:.0?}, {accepted} accepted, at most {memory:?} kB of memory",
            start.elapsed()
        );
        assert!(
            accepted > tried / self.least_accepted,
            "{corpus}: so few of {tried} files are still accepted ({accepted}) that the readers are hardly reached"
        );
        assert!(memory.is_none_or(|kilobytes| kilobytes < MOST_MEMORY), "{memory:?} kB of memory");
    }

    fn keep(&self, content: &[u8], reason: &str) -> ! {
        let name = format!("found-{:.12}", format!("{:x}", Sha256::digest(content)));
        let path = corpus_of(self.corpus).join(name);
        fs::create_dir_all(corpus_of(self.corpus)).unwrap();
        fs::write(&path, content).unwrap();
        panic!("{reason}; the file is {} now", path.display());
    }
}

/// Most memory that this process has taken so far, in kB, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix("kB")?.trim().parse().ok())
}
