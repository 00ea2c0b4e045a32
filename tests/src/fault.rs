//! Calls that change files and fail, or are the last that a process makes: every one of them in turn.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::program::{Outcome, repository, run};

/// What happens at a call that changes a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The process is killed before it.
    Kill,
    /// The process is killed in the midst of it, at the end of a page of memory; no system stops elsewhere.
    Half,
    /// It fails as on a full disc.
    Once,
    /// It fails as on a full disc, and so do all that follow.
    Full,
}

impl Fault {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Kill, Self::Half, Self::Once, Self::Full];

    fn name(self) -> &'static str {
        match self {
            Self::Kill => "kill",
            Self::Half => "half",
            Self::Once => "once",
            Self::Full => "full",
        }
    }
}

/// How many calls that change files a command makes.
///
/// # Panics
/// When it fails.
pub fn count(mut command: Command) -> usize {
    let count = tempfile::NamedTempFile::new().expect("a temporary file");
    command.env("LD_PRELOAD", shim("fault")).env("PLATEAU_FAULT", "none:0").env("PLATEAU_FAULT_COUNT", count.path());
    let outcome = run(command);
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    let count = fs::read_to_string(count.path()).expect("the number of calls");
    count.parse().unwrap_or_else(|_| panic!("the calls of a program that is not linked dynamically: {count:?}"))
}

/// Runs a command whose call of that number, counted from 1, meets a fault. A panic of the program is one here.
///
/// # Panics
/// When the program panics.
pub fn strike(mut command: Command, fault: Fault, call: usize) -> Outcome {
    command.env("LD_PRELOAD", shim("fault")).env("PLATEAU_FAULT", format!("{}:{call}", fault.name()));
    let outcome = run(command);
    assert!(
        outcome.status.is_none_or(|status| status <= 2) && !outcome.stderr.contains("panicked"),
        "{fault:?} at call {call}: {outcome:?}"
    );
    outcome
}

/// Runs a command to which the system gives so many threads and no more.
pub fn without_threads(mut command: Command, threads: usize) -> Outcome {
    command.env("LD_PRELOAD", shim("fault")).env("PLATEAU_THREADS", threads.to_string()).env_remove("RUST_BACKTRACE");
    run(command)
}

/// The library of a file in `tests/src` that stands before the C library, built once.
///
/// # Panics
/// When there is no C compiler.
pub fn shim(name: &str) -> PathBuf {
    static SHIMS: Mutex<BTreeMap<String, PathBuf>> = Mutex::new(BTreeMap::new());
    let build = || {
        let directory = tempfile::tempdir().expect("a temporary directory").keep();
        let (source, library) =
            (repository().join("tests/src").join(name).with_extension("c"), directory.join(name).with_extension("so"));
        let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
        let mut command = Command::new(compiler);
        command.args(["-shared", "-fPIC", "-O1", "-o"]).args([&library, &source]).arg("-ldl");
        assert!(command.status().expect("a C compiler").success(), "{command:?}");
        library
    };
    SHIMS.lock().unwrap_or_else(PoisonError::into_inner).entry(name.to_owned()).or_insert_with(build).clone()
}
