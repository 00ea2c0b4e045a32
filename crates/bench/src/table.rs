//! The table of a benchmark in Markdown, with machine, build and settings below it: where it ran, as far as the system (Linux) tells, and
//! what it was built from, with and how.

use std::{fmt, fs};

use plateau_io::process::{cores, load, processor};
use serde::Serialize;

use crate::race::{Measurement, Pace, Session, Spread};

/// Results of one benchmark.
#[derive(Debug, Serialize)]
pub struct Results {
    benchmark: &'static str,
    machine: Machine,
    build: Build,
    /// File name of the scene.
    scene: String,
    /// Changes of the scene.
    sets: Vec<String>,
    /// Physical time for which the pin had worn in, s.
    worn_in: f64,
    pace: Pace,
    /// True if the benchmark was only tried, on a small mesh: the numbers mean nothing.
    quick: bool,
    /// Times, in the order of the race.
    pub measurements: Vec<Measurement>,
    /// Sentences on how well the peer agrees with us.
    pub agreements: Vec<String>,
}

impl Results {
    /// Results of a benchmark that begins now, on this machine: none yet.
    pub fn begin(benchmark: &'static str, session: &Session) -> Self {
        let Session { source, pace, quick, .. } = session;
        Self {
            benchmark,
            machine: Machine::this(),
            build: Build::this(),
            scene: source.name(),
            sets: source.sets.clone(),
            worn_in: source.worn_in,
            pace: *pace,
            quick: *quick,
            measurements: Vec::new(),
            agreements: Vec::new(),
        }
    }

    /// The table, sentences on agreement, and the circumstances of the measurement.
    pub fn markdown(&self) -> String {
        let is_shared = self.measurements.iter().any(|one| one.workers > 1);
        let mut text = String::from(
            "| | mesh | workers | µs per step | range | ns per cell | load evaluations | against | ratio | range |",
        );
        text += if is_shared { " efficiency | halo bytes per step | waiting | balance |\n" } else { "\n" };
        text += "|---|---|---:|---:|---:|---:|---:|---|---:|---:|";
        text += if is_shared { "---:|---:|---:|---:|\n" } else { "\n" };
        for one in &self.measurements {
            text += &row(one, &self.measurements[one.against], is_shared);
        }
        for line in self.agreements.iter().chain([&self.circumstances()]) {
            text += &format!("\n{line}\n");
        }
        text
    }

    /// Describes scene, machine, build and settings of the measurement.
    fn circumstances(&self) -> String {
        let Self { machine, build, pace, .. } = self;
        let sets: String = self.sets.iter().map(|set| format!(" `{set}`")).collect();
        let worn_in = if self.worn_in > 0.0 { format!(", worn in for {} s", self.worn_in) } else { String::new() };
        let quick = if self.quick { " Only a look at whether it runs: the numbers mean nothing." } else { "" };
        format!(
            "{machine}; {build}; {}{sets}{worn_in}; median of {} blocks of about {} ms, measured in turn; ratio: time of a cell over \
             that of the row it is set against.{quick}",
            self.scene,
            pace.repeats,
            pace.block.as_millis()
        )
    }
}

fn row(one: &Measurement, against: &Measurement, is_shared: bool) -> String {
    let time = Spread::of(&one.microseconds_per_step);
    let ratio = one.ratio_to(against);
    let cell = time.median * 1e3 / one.mesh.pin_cells() as f64;
    let mut cells = vec![
        one.name.clone(),
        one.mesh.to_string(),
        one.workers.to_string(),
        number(time.median),
        range(time),
        number(cell),
        one.load_evaluations_per_step.map_or("–".to_owned(), number),
        format!("{}, {}, {}", against.name, against.mesh, against.workers),
        format!("{:.3}", ratio.median),
        format!("{:.3} – {:.3}", ratio.minimum, ratio.maximum),
    ];
    if is_shared {
        let workers = one.workers as f64 / against.workers as f64;
        cells.push(if workers > 1.0 { format!("{:.0} %", 100.0 / (ratio.median * workers)) } else { "–".to_owned() });
        cells.extend(one.sharing.map_or(["–"; 3].map(str::to_owned), |sharing| {
            let part = |part: f64| format!("{:.0} %", 100.0 * part);
            [format!("{:.0}", sharing.halo_bytes_per_step), part(sharing.waiting), part(sharing.balance)]
        }));
    }
    format!("| {} |\n", cells.join(" | "))
}

/// Formats the least and the largest value.
fn range(spread: Spread) -> String {
    format!("{} – {}", number(spread.minimum), number(spread.maximum))
}

/// Formats a number with at least three digits.
fn number(value: f64) -> String {
    let digits = match value {
        100.0.. => 0,
        10.0.. => 1,
        _ => 2,
    };
    format!("{value:.digits$}")
}

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

impl Machine {
    /// Describes this machine as it is now.
    pub fn this() -> Self {
        let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
        let (release, version) = (read("/etc/os-release"), read("/proc/sys/kernel/osrelease"));
        let name = release.lines().find_map(|line| line.strip_prefix("PRETTY_NAME="));
        let kernel = format!("{} {}", std::env::consts::OS, version.trim());
        let system = name.map_or(kernel.clone(), |name| format!("{}, {kernel}", name.trim_matches('"')));
        Self { processor: processor(), cores: cores(), system, load: load() }
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
    /// Describes this build.
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

#[cfg(test)]
#[path = "../tests/unit/table.rs"]
mod tests;
