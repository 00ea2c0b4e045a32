//! Record of a run of a study: what it is the result of (the scene without what does not show in it, the content of the files that it
//! read, and the generation of the program's numbers), how it ended, and its series.

use std::collections::{BTreeMap, HashMap};
use std::convert::Infallible;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::{DeflateDecoder, DeflateEncoder};
use plateau_core::observe::event::event_quantity;
use plateau_core::observe::{EXTRAS, quantities};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::input::sha256;
use crate::scene::schema::{self, Role};
use crate::scene::{BaseSource, HeightSource, Scene};
use crate::{generation, limits};

/// Digests of files, each read once.
#[derive(Debug, Default)]
pub struct Digests(Mutex<BTreeMap<PathBuf, String>>);

impl Digests {
    /// SHA-256 of a file, 64 hexadecimal digits.
    pub fn of(&self, path: &Path) -> io::Result<String> {
        let known = || self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(digest) = known().get(path) {
            return Ok(digest.clone());
        }
        let digest = sha256(path)?;
        known().insert(path.to_owned(), digest.clone());
        Ok(digest)
    }

    /// The files that were asked for.
    pub fn files(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).keys().cloned().collect()
    }
}

/// Identity of a result. Workers, names of files and titles do not count, nor does the revision of the program as long as it
/// computes the same numbers.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Identity {
    /// Generation of the program's numbers: [`crate::generation`]. 0 in records of programs that did not count them.
    pub generation: u32,
    /// SHA-256 of what shows in results of the resolved scene.
    pub scene: String,
    /// SHA-256 of what was read of each file that shows in results, by what it is for.
    pub files: BTreeMap<String, String>,
}

impl Identity {
    /// Identifies a scene whose surfaces have such `inputs`: files, with the digest of what was read. A file that was read twice and
    /// changed in between has both.
    pub fn of(scene: &Scene, inputs: &[(PathBuf, String)]) -> Self {
        let digests = |path: &Path| -> Vec<&str> {
            inputs.iter().filter(|(input, _)| input == path).map(|(_, digest)| digest.as_str()).collect()
        };
        let found = Self::with(scene, |path| Ok::<_, Infallible>(digests(path).join("+")));
        found.unwrap_or_else(|(_, never)| match never {})
    }

    /// Identifies a scene whose surfaces were not read yet, by the files as they are now.
    pub fn expected(scene: &Scene, digests: &Digests) -> Result<Self, (PathBuf, io::Error)> {
        Self::with(scene, |path| digests.of(path))
    }

    fn with<E>(scene: &Scene, digest: impl Fn(&Path) -> Result<String, E>) -> Result<Self, (PathBuf, E)> {
        let mut hasher = Sha256::new();
        for line in lines(&scene.resolved, shows) {
            hasher.update(line);
            hasher.update("\n");
        }
        let mut files = BTreeMap::new();
        if let Some((_, digest)) = scene.cycle.as_ref().and_then(|operation| operation.file.as_ref()) {
            files.insert("operation.cycle".to_owned(), digest.clone());
        }
        for (key, path) in surface_files(scene) {
            files.insert(key.to_owned(), digest(path).map_err(|error| (path.to_owned(), error))?);
        }
        Ok(Self { generation: generation::current(), scene: format!("{:x}", hasher.finalize()), files })
    }

    /// Digest of all of it, 64 hexadecimal digits: the name of the result.
    pub fn name(&self) -> String {
        let mut hasher = Sha256::new();
        hasher.update(format!("{}\n{}\n", self.generation, self.scene));
        self.files.iter().for_each(|(key, digest)| hasher.update(format!("{key} {digest}\n")));
        format!("{:x}", hasher.finalize())
    }

    /// Name of the run file of this result, such as `run-0054-3fa9c2d1.h5`: the number of its run in the study, for people, and letters
    /// that no other scene, generation or choice of maps has.
    pub fn run_file(&self, number: usize, scene: &Scene) -> String {
        let mut hasher = Sha256::new_with_prefix(self.name());
        let of_maps = |key: &str| matches!(schema::role(key), Role::Maps | Role::MapTimes);
        lines(&scene.resolved, of_maps).for_each(|line| hasher.update(line));
        let digest = format!("{:x}", hasher.finalize());
        format!("run-{number:04}-{}.h5", &digest[..8])
    }
}

/// Place, for each run, of the first one with the same identity: its own unless it repeats another run.
pub fn firsts(identities: &[String]) -> Vec<usize> {
    let mut known = HashMap::new();
    identities.iter().enumerate().map(|(place, identity)| *known.entry(identity).or_insert(place)).collect()
}

/// The lines of a resolved scene, one key each, of some keys, and the heads of its tables.
fn lines(resolved: &str, is_of: impl Fn(&str) -> bool) -> impl Iterator<Item = &str> {
    let mut table = "";
    resolved.lines().filter(move |line| {
        if let Some(name) = line.strip_prefix('[') {
            table = name.trim_end_matches(']');
        }
        line.split_once(" = ").is_none_or(|(name, _)| is_of(&schema::join(table, name)))
    })
}

/// Tells whether a key shows in the series of its run. Of files the content counts, not the name.
fn shows(key: &str) -> bool {
    !matches!(schema::role(key), Role::Nothing | Role::Maps | Role::MapTimes) && !schema::is_input(key)
}

/// The files of surfaces whose content shows in results, and what they are for.
fn surface_files(scene: &Scene) -> impl Iterator<Item = (&'static str, &PathBuf)> {
    let base = match &scene.pin_base {
        BaseSource::File { path, .. } | BaseSource::Image { path, .. } => Some(path),
        BaseSource::Synthetic(_) | BaseSource::Uniform(_) => None,
    };
    let all = [
        ("disc.surface", heights(&scene.disc_surface.source)),
        ("pin.surface", heights(&scene.pin_surface.source)),
        ("pin.base", base),
    ];
    all.into_iter().filter_map(|(key, path)| Some((key, path?)))
}

fn heights(source: &HeightSource) -> Option<&PathBuf> {
    match source {
        HeightSource::File { path, .. } => Some(path),
        HeightSource::Synthetic(_) | HeightSource::Flat => None,
    }
}

/// A run that has ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Name of [`of`](Self::of), the identity of the run.
    pub identity: String,
    /// The same in parts, by which it can be told why another run is not this one.
    #[serde(default)]
    pub of: Identity,
    /// Number of the run in the study, from 1; for people.
    pub run: usize,
    /// End of the run.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Wall time, s.
    pub wall_time: f64,
    /// The machine.
    pub host: String,
    /// Time at which it ended.
    pub end_time: String,
}

/// End of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "state", rename_all = "lowercase")]
pub enum Outcome {
    /// All steps were taken.
    Finished {
        /// Number of steps.
        steps: u64,
        /// The time, s, until which it was to go on: the last step ends there, or less than a step before or behind it.
        #[serde(default)]
        until: f64,
        /// The series.
        series: Packed,
        /// Quantities of the events of its cycle, one value for each event.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        events: Option<Packed>,
        /// Time of a pulse of its contact area, s, at least; none where nothing pulses at constant load and speed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pulse_time: Option<f64>,
    },
    /// Run that could not begin or go on.
    Failed {
        /// Reason why it failed.
        error: String,
    },
}

impl Outcome {
    /// The series of a run that has finished; none of one that failed, and none where it does not hold what it says.
    pub fn series(&self) -> Option<Series> {
        let Self::Finished { until, series, events, pulse_time, .. } = self else { return None };
        let series = Series { until: *until, pulse_time: *pulse_time, ..series.unpack()? };
        let Some(events) = events else { return Some(series) };
        let Series { names, columns, .. } = events.unpack()?;
        Some(Series { events: names.into_iter().zip(columns).collect(), ..series })
    }
}

/// Name of a column of [`Series`] that is none of the run file: simulated revolutions since t = 0.
pub const REVOLUTIONS: &str = "simulated_revolutions";

/// Name of the series of the time in contact, which runs with a cycle have.
pub const CONTACT_TIME: &str = "contact_time";

/// The series of a run: equally long columns, time being the first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    pub(super) names: Vec<String>,
    pub(super) columns: Vec<Vec<f64>>,
    /// Quantities of the events of the run, by their names: equally long columns of another length.
    pub(super) events: Vec<(String, Vec<f64>)>,
    /// The time, s, until which the run was to go on; 0 where nobody has said.
    pub(super) until: f64,
    /// Time of a pulse of its contact area, s, at least, if that is known.
    pub(super) pulse_time: Option<f64>,
}

/// Beginning of the dataset of a quantity of events, as against that of a series.
pub const EVENT: &str = "event/";

/// Dataset of a series, or of a quantity of events, in a run file.
pub fn dataset_of(series: &str) -> String {
    if series.starts_with(EVENT) { format!("/{series}") } else { format!("/series/{series}") }
}

/// SI unit of a series, or of a quantity of events.
pub fn unit_of(series: &str) -> &'static str {
    if let Some(name) = series.strip_prefix(EVENT) {
        return event_quantity(name).map_or("1", |quantity| quantity.unit);
    }
    quantities(EXTRAS).find(|quantity| quantity.name == series).map_or("1", |quantity| quantity.unit)
}

impl Series {
    /// Columns and their names, `time` first.
    pub fn new(names: Vec<String>, columns: Vec<Vec<f64>>) -> Self {
        Self { names, columns, ..Self::default() }
    }

    /// Times of the samples, s.
    pub fn time(&self) -> &[f64] {
        self.columns.first().map_or(&[], Vec::as_slice)
    }

    /// A series.
    pub fn values(&self, name: &str) -> Option<&[f64]> {
        let column = self.names.iter().position(|known| known == name)?;
        self.columns.get(column).map(Vec::as_slice)
    }

    /// A quantity of the events, one value for each.
    pub fn of_events(&self, name: &str) -> Option<&[f64]> {
        self.events.iter().find(|(known, _)| known == name).map(|(_, values)| values.as_slice())
    }

    /// Names of the columns, `time` first.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Packs the columns: every bit is kept.
    pub fn pack(&self) -> Packed {
        let values: Vec<[u8; 8]> = self.columns.iter().flatten().map(|value| value.to_le_bytes()).collect();
        // Bytes of equal weight side by side are more alike.
        let shuffled: Vec<u8> = (0..8).flat_map(|byte| values.iter().map(move |value| value[byte])).collect();
        let mut packed = Vec::new();
        // Reading from memory cannot fail.
        let _ = DeflateEncoder::new(shuffled.as_slice(), Compression::fast()).read_to_end(&mut packed);
        Packed { columns: self.names.clone(), samples: self.time().len(), data: STANDARD.encode(packed) }
    }
}

/// Series as they stand in a journal: all columns one after the other, the bytes of equal weight of all numbers (IEEE 754
/// binary64, the least first) side by side, deflated, in Base64.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Packed {
    columns: Vec<String>,
    samples: usize,
    data: String,
}

impl Packed {
    /// Names of the columns.
    pub fn names(&self) -> &[String] {
        &self.columns
    }

    /// The series; none if the text is not what [`Series::pack`] made.
    pub fn unpack(&self) -> Option<Series> {
        let count = self.columns.len().checked_mul(self.samples).filter(|count| *count <= limits::RECORD_NUMBERS)?;
        let bytes = count.checked_mul(8)?;
        let mut shuffled = Vec::new();
        let packed = STANDARD.decode(&self.data).ok()?;
        DeflateDecoder::new(packed.as_slice()).take(bytes as u64 + 1).read_to_end(&mut shuffled).ok()?;
        if shuffled.len() != bytes {
            return None;
        }
        let value = |at: usize| f64::from_le_bytes(std::array::from_fn(|byte| shuffled[byte * count + at]));
        let column = |column: usize| (0..self.samples).map(|sample| value(column * self.samples + sample)).collect();
        Some(Series::new(self.columns.clone(), (0..self.columns.len()).map(column).collect()))
    }
}

#[cfg(test)]
#[path = "../../tests/unit/study/record.rs"]
mod tests;
