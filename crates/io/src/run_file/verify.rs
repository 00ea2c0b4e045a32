//! Tells whether a run file still holds what was written.

use std::path::Path;

use hdf5::Dataset;
use plateau_core::observe::event::EVENT_QUANTITIES;
use plateau_core::observe::{Map, MapValues};

use super::digest::{
    ATTRIBUTES_DIGEST, DIGEST, EXECUTION_DIGEST, NUMBERS_DIGEST, of_execution, of_floats, of_numbers, of_texts, texts,
};
use super::layout::{EVENT, MAP_TIME, PIN_BASE, TIME, event_path, map_path, series_path};
use super::reader::reason;
use super::{ReadError, RunFile, State};
use crate::hdf5_file;
use crate::input::sha256_of;

/// Result of verifying a run file that can be opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verification {
    /// State of its run.
    pub state: State,
    /// Samples.
    pub samples: usize,
    /// Moments of which there are maps.
    pub moments: usize,
    /// Digests that hold.
    pub intact: usize,
    /// Tells whether it has digests: not before it is closed.
    pub digested: bool,
    /// Tells whether its digests are of all that it holds: those of earlier programs leave out what is no text among the attributes, and
    /// what tells how the run was carried out.
    pub covers_numbers: bool,
    /// Parts that are no longer what was written.
    pub damage: Vec<Damage>,
}

/// A part of a run file that is damaged.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Damage {
    /// Its place, such as `/disc/height at 500 s`.
    pub place: String,
    /// The sign of it.
    pub problem: String,
}

/// Compares all that a run file holds with the digests that were taken when it was written.
///
/// # Errors
/// [`ReadError`] when it cannot be opened, is no run file, or so damaged that nothing more can be said.
pub fn verify(path: &Path) -> Result<Verification, ReadError> {
    let run = RunFile::open(path)?;
    let found = Verification {
        state: run.state(),
        samples: run.time().len(),
        moments: run.map_time().len(),
        intact: 0,
        digested: run.file.attr(ATTRIBUTES_DIGEST).is_ok(),
        covers_numbers: run.file.attr(NUMBERS_DIGEST).is_ok(),
        damage: Vec::new(),
    };
    let mut check = Check { run: &run, found };
    for name in ["radius", "disc_angle", "pin_angle", TIME, MAP_TIME] {
        // Without maps there are no times of them.
        if name != MAP_TIME || run.file.link_exists(MAP_TIME) {
            check.column(name);
        }
    }
    for series in run.series() {
        check.series(&series.name);
    }
    for path in [EVENT.to_owned()].into_iter().chain(EVENT_QUANTITIES.iter().map(|quantity| event_path(quantity.name)))
    {
        if run.file.link_exists(&path) {
            check.column(&path);
        }
    }
    check.pin_base();
    for map in Map::ALL.into_iter().filter(|map| run.has_map(*map)) {
        check.map(map);
    }
    check.attributes();
    Ok(check.found)
}

struct Check<'a> {
    run: &'a RunFile,
    found: Verification,
}

impl Check<'_> {
    /// A dataset with one dimension.
    fn column(&mut self, path: &str) {
        let values = self.guarded(path, |dataset| dataset.read_1d::<f64>());
        let values = values.map(|values| values.to_vec()).map_err(|error| reason(&error));
        self.compare(path, values.map(|values| of_floats(&values)));
    }

    /// As many values as there are times; where the program was killed there may be more.
    fn series(&mut self, name: &str) {
        let path = series_path(name);
        let values = self.run.values(name).map(Option::unwrap_or_default).map_err(in_short);
        let all = |values: Vec<f64>| self.no_more_than(&path, self.run.time().len()).map(|()| of_floats(&values));
        let found = values.and_then(all);
        self.compare(&path, found);
    }

    fn pin_base(&mut self) {
        let base = self.run.pin_base().map(Option::unwrap_or_default).map_err(in_short);
        self.compare(PIN_BASE, base.map(|base| sha256_of(&base)));
    }

    /// Every moment has its own digest.
    fn map(&mut self, map: Map) {
        let path = map_path(map);
        if let Err(problem) = self.no_more_than(path, self.run.map_time().len()) {
            self.found.damage.push(Damage { place: format!("/{path}"), problem });
        }
        let written = self.written(path);
        for (moment, time) in self.run.map_time().iter().enumerate() {
            let found = match self.run.map(map, moment) {
                Ok(Some(MapValues::Float(values))) => Ok(of_floats(&values)),
                Ok(Some(MapValues::Status(values))) => Ok(sha256_of(&values)),
                Ok(None) => Err("it is not there".to_owned()),
                Err(error) => Err(in_short(error)),
            };
            let written = match &written {
                Ok(None) => Ok(None),
                Ok(Some(digests)) => {
                    digests.get(moment).cloned().map(Some).ok_or_else(|| "it has no digest".to_owned())
                }
                Err(error) => Err(error.clone()),
            };
            self.judge(format!("/{path} at {time} s"), found, written);
        }
    }

    fn attributes(&mut self) {
        self.attribute_digest("attributes", ATTRIBUTES_DIGEST, of_texts);
        // That it is there is held by the digest before: it is one of the texts.
        if self.found.digested && self.found.covers_numbers {
            self.attribute_digest("numbers among the attributes", NUMBERS_DIGEST, of_numbers);
            self.attribute_digest("attributes of machine and time", EXECUTION_DIGEST, of_execution);
        }
    }

    fn attribute_digest(&mut self, place: &str, attribute: &str, digest: fn(&hdf5::File) -> hdf5::Result<String>) {
        let file = &self.run.file;
        let found = hdf5_file::guarded(0, || digest(file)).map_err(|error| reason(&error));
        let written = hdf5_file::text_attribute(file, attribute).map_err(|error| reason(&error));
        self.judge(place.to_owned(), found, written);
    }

    /// That a dataset of a closed file goes no further than its times; before, what comes last may have none yet.
    fn no_more_than(&self, path: &str, times: usize) -> Result<(), String> {
        let rows = self.guarded(path, |dataset| Ok(dataset.shape().first().copied().unwrap_or(0)));
        let rows = rows.map_err(|error| reason(&error))?;
        if self.found.digested && rows > times {
            return Err(format!("it is longer than what was written: {rows} in place of {times}"));
        }
        Ok(())
    }

    /// A dataset that has one digest.
    fn compare(&mut self, path: &str, found: Result<String, String>) {
        let written = self.written(path).map(|digests| digests.and_then(|digests| digests.first().cloned()));
        self.judge(format!("/{path}"), found, written);
    }

    /// The digests of a dataset, if it has any.
    fn written(&self, path: &str) -> Result<Option<Vec<String>>, String> {
        let digests = self.guarded(path, |dataset| {
            if dataset.attr_names()?.iter().any(|name| name == DIGEST) {
                texts(&self.run.file, &dataset.attr(DIGEST)?)
            } else {
                Ok(None)
            }
        });
        digests.map_err(|error| reason(&error))
    }

    fn judge(&mut self, place: String, found: Result<String, String>, written: Result<Option<String>, String>) {
        let problem = match (found, written) {
            (Ok(found), Ok(Some(written))) if found == written => {
                self.found.intact += 1;
                return;
            }
            (Ok(_), Ok(None)) if !self.found.digested => return,
            (Err(error), _) | (_, Err(error)) => error,
            (Ok(_), Ok(None)) => "it has no digest".to_owned(),
            (Ok(found), Ok(Some(written))) => {
                format!("it is not what was written: SHA-256 {found}, expected {written}")
            }
        };
        self.found.damage.push(Damage { place, problem });
    }

    /// Does `work` on a dataset with no more memory than it needs.
    fn guarded<T>(&self, path: &str, work: impl FnOnce(&Dataset) -> hdf5::Result<T>) -> hdf5::Result<T> {
        let dataset = self.run.file.dataset(path)?;
        hdf5_file::refuse_hollow(&dataset)?;
        hdf5_file::guarded(dataset.size().saturating_mul(size_of::<f64>()), || work(&dataset))
    }
}

/// Problem with a part of a file, without what is said of the file.
fn in_short(error: ReadError) -> String {
    match error {
        ReadError::Damaged(_, reason) => reason,
        error => error.to_string(),
    }
}
