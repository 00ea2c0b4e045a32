//! Where the benchmarks run, as far as the system (Linux) tells, and what they were built from, with and how.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

/// A machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name.
    pub processor: String,
    /// Threads that can run at once.
    pub cores: usize,
    /// Memory, bytes; none where the system does not tell.
    pub memory_bytes: Option<u64>,
    /// Data caches of one core, the nearest first.
    pub caches: Vec<Cache>,
    /// Operating system and its version.
    pub system: String,
    /// Threads that wanted to run when the benchmark started, mean over the last minute: what else was going on.
    pub load: Option<f64>,
}

/// A data cache of one core, which others may share.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cache {
    /// 1, 2, ..
    pub level: u32,
    /// Size, bytes.
    pub bytes: u64,
    /// Cores that share it, this one included.
    pub shared_by: usize,
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
        let release = word("/proc/sys/kernel/osrelease").unwrap_or_default();
        let distribution = first("/etc/os-release", "PRETTY_NAME=");
        let system = format!("{} {release}", std::env::consts::OS);
        Self {
            processor: first("/proc/cpuinfo", "model name").unwrap_or_else(|| std::env::consts::ARCH.into()),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            memory_bytes: first("/proc/meminfo", "MemTotal").and_then(|text| kilobytes(text.strip_suffix("kB")?)),
            caches: caches(),
            system: distribution.map_or(system.clone(), |name| format!("{name}, {system}")).trim().to_owned(),
            load: word("/proc/loadavg").and_then(|load| load.parse().ok()),
        }
    }
}

fn kilobytes(text: &str) -> Option<u64> {
    Some(text.trim().parse::<u64>().ok()? * 1024)
}

fn caches() -> Vec<Cache> {
    let folder = Path::new("/sys/devices/system/cpu/cpu0/cache");
    let mut caches: Vec<Cache> =
        (0..).map_while(|index| cache(&folder.join(format!("index{index}")))).flatten().collect();
    caches.sort_by_key(|cache| cache.level);
    caches
}

/// None where there is no such cache, and nothing inside where it holds no data.
fn cache(folder: &Path) -> Option<Option<Cache>> {
    let read = |name| fs::read_to_string(folder.join(name)).ok().map(|text| text.trim().to_owned());
    let kind = read("type")?;
    let bytes = kilobytes(read("size")?.strip_suffix('K')?)?;
    let level = read("level")?.parse().ok()?;
    let shared_by = read("shared_cpu_list").map_or(1, |list| processors(&list));
    Some((kind != "Instruction").then_some(Cache { level, bytes, shared_by }))
}

/// How many processors a list such as `0-3,8` names.
fn processors(list: &str) -> usize {
    let span = |part: &str| {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        Some(last.parse::<usize>().ok()?.saturating_sub(first.parse().ok()?) + 1)
    };
    list.split(',').filter_map(span).sum::<usize>().max(1)
}

/// A build of this program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Build {
    /// Version of Plateau.
    pub version: String,
    /// Revision of the source; `-modified` where the source differed from it.
    pub revision: String,
    /// Compiler and its version.
    pub compiler: String,
    /// Profile, `release` or `debug`.
    pub profile: String,
    /// Level of optimization.
    pub optimization: String,
    /// What it was built for.
    pub target: String,
    /// Flags of the compiler beside those of the profile.
    pub flags: String,
}

impl Build {
    /// This build.
    pub fn this() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            revision: env!("BENCH_REVISION").into(),
            compiler: env!("BENCH_COMPILER").into(),
            profile: env!("BENCH_PROFILE").into(),
            optimization: env!("BENCH_OPTIMIZATION").into(),
            target: env!("BENCH_TARGET").into(),
            flags: env!("BENCH_FLAGS").into(),
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn lists_of_processors_are_counted() {
        for (list, count) in [("0", 1), ("0-1", 2), ("0-3,8", 5), ("0,4,8-9", 4)] {
            assert_eq!(super::processors(list), count, "{list}");
        }
    }
}
