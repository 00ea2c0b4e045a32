//! Where the benchmarks run, as far as the system (Linux) tells, and what they were built from, with and how.

use std::fmt;
use std::fs;

use serde::Serialize;

/// A machine.
#[derive(Debug, Serialize)]
pub struct Machine {
    processor: String,
    /// Threads that can run at once.
    cores: usize,
    /// Operating system and its version.
    system: String,
    /// Threads that wanted to run when the benchmark started, mean over the last minute: what else was going on.
    load: Option<f64>,
}

/// Threads that can run at once.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

impl Machine {
    /// This machine, now.
    pub fn this() -> Self {
        let first = |path, prefix: &str| {
            let text = fs::read_to_string(path).ok()?;
            let value = text.lines().find_map(|line| line.strip_prefix(prefix))?;
            Some(value.trim_matches([' ', '\t', ':', '"']).to_owned())
        };
        let word = |path: &str| fs::read_to_string(path).ok()?.split_whitespace().next().map(str::to_owned);
        let kernel = format!("{} {}", std::env::consts::OS, word("/proc/sys/kernel/osrelease").unwrap_or_default());
        let distribution = first("/etc/os-release", "PRETTY_NAME=");
        Self {
            processor: first("/proc/cpuinfo", "model name").unwrap_or_else(|| std::env::consts::ARCH.into()),
            cores: cores(),
            system: distribution.map_or(kernel.clone(), |name| format!("{name}, {kernel}")),
            load: word("/proc/loadavg").and_then(|load| load.parse().ok()),
        }
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {} cores, {}", self.processor, self.cores, self.system)?;
        self.load.map_or(Ok(()), |load| write!(f, ", load {load} before"))
    }
}

/// A build of this program.
#[derive(Debug, Serialize)]
pub struct Build {
    version: &'static str,
    /// Revision of the source; `-modified` where the source differed from it.
    revision: &'static str,
    /// Compiler and its version.
    compiler: &'static str,
    /// Profile, `release` or `debug`.
    profile: &'static str,
    /// Machine and system that it was built for.
    target: &'static str,
    /// Flags of the compiler beside those of the profile.
    flags: &'static str,
}

impl Build {
    /// This build.
    pub fn this() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            revision: env!("BENCH_REVISION"),
            compiler: env!("BENCH_COMPILER"),
            profile: env!("BENCH_PROFILE"),
            target: env!("BENCH_TARGET"),
            flags: env!("BENCH_FLAGS"),
        }
    }
}

impl fmt::Display for Build {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { revision, compiler, profile, target, flags, .. } = self;
        let (commit, changed) = revision.split_once('-').map_or((*revision, ""), |(commit, _)| (commit, ", changed"));
        let commit = commit.get(..12).unwrap_or(commit);
        write!(f, "revision {commit}{changed}, {compiler}, {profile} for {target}")?;
        if flags.is_empty() { Ok(()) } else { write!(f, ", flags {flags}") }
    }
}
