//! Digests of the content of a run file, by which anyone can tell whether it is still what was written, and
//! [`verify`] does: SHA-256, 64 hexadecimal digits.
//!
//! Every dataset has the attribute `sha256`, the digest of its values as they lie in memory, the least byte first; a map
//! has one for each moment. Digests of the attributes are attributes of the root:
//!
//! | attribute | of | held by |
//! |---|---|---|
//! | `attributes_sha256` | texts, which scales a dataset has, and the order in groups | |
//! | `numbers_sha256` | every other attribute: numbers, texts of a fixed length | `attributes_sha256`, being a text |
//! | `execution_sha256` | the attributes of the root that differ between runs of equal results | there wherever `numbers_sha256` is |
//!
//! The first alone is in files of before there were the others; such a file holds as it did then.
//!
//! Each is the SHA-256 of lines, in the order of their bytes. What has a line break in it takes more lines; a link has the lines
//! of what it leads to, with its own path.

use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

use hdf5::types::{TypeDescriptor, VarLenArray, VarLenAscii, VarLenUnicode};
use hdf5::{
    Attribute, Dataset, File, Group, IndexType, IterationOrder, Location, LocationType, ObjectReference1,
    ReferencedObject,
};
use plateau_core::observe::event::EVENT_QUANTITIES;
use plateau_core::observe::{Map, MapValues};
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::hdf5_file::{self, in_words, text_of, texts_of, write_text};
use crate::input::sha256_of;
use crate::run_file::layout::{EVENT, MAP_TIME, PIN_BASE, TIME, event_path, map_path, series_path};
use crate::run_file::reader::reason;
use crate::run_file::{ReadError, RunFile, State};

/// Attribute of a dataset.
pub(super) const DIGEST: &str = "sha256";

/// Digests of the datasets that grow, taken of the values that are handed to the library.
#[derive(Debug, Default)]
pub(super) struct Digests {
    /// Digests of the datasets with one dimension, up to now.
    columns: BTreeMap<String, Sha256>,
    /// Digests of the maps, one for each moment.
    maps: BTreeMap<&'static str, Vec<String>>,
}

impl Digests {
    /// Takes values that were appended to a dataset with one dimension.
    pub(super) fn append(&mut self, path: &str, values: &[f64]) {
        update(self.columns.entry(path.to_owned()).or_default(), values);
    }

    pub(super) fn append_map(&mut self, path: &'static str, digest: String) {
        self.maps.entry(path).or_default().push(digest);
    }

    pub(super) fn maps(&self) -> usize {
        self.maps.values().map(Vec::len).sum()
    }

    /// Tells whether a map was the same at every one of several moments.
    pub(super) fn is_constant(&self, path: &str) -> bool {
        let digests = self.maps.get(path).map_or(&[][..], Vec::as_slice);
        digests.len() > 1 && digests.iter().all(|digest| *digest == digests[0])
    }

    /// Writes the digests of all that was appended.
    pub(super) fn write(&self, file: &File) -> hdf5::Result<()> {
        for (path, hasher) in &self.columns {
            write_text(&*file.dataset(path)?, DIGEST, &format!("{:x}", hasher.clone().finalize()))?;
        }
        for (path, digests) in &self.maps {
            let texts: Result<Vec<_>, _> = digests.iter().map(|digest| VarLenUnicode::from_str(digest)).collect();
            let texts = texts.map_err(in_words)?;
            file.dataset(path)?.new_attr_builder().with_data(&texts).create(DIGEST)?;
        }
        Ok(())
    }
}

pub(super) fn of_floats(values: &[f64]) -> String {
    let mut hasher = Sha256::new();
    update(&mut hasher, values);
    format!("{:x}", hasher.finalize())
}

/// Takes floating-point values as they lie in memory, the least byte first.
fn update(hasher: &mut Sha256, values: &[f64]) {
    for values in values.chunks(512) {
        let bytes: Vec<_> = values.iter().map(|value| value.to_le_bytes()).collect();
        hasher.update(bytes.as_flattened());
    }
}

/// Attribute of the root: digest of the texts.
pub(super) const ATTRIBUTES_DIGEST: &str = "attributes_sha256";
/// Attribute of the root: digest of numbers, and of all else that is no text of any length.
pub(super) const NUMBERS_DIGEST: &str = "numbers_sha256";
/// Attribute of the root: digest of what tells how the run was carried out. It is of a kind that `attributes_sha256` passes over,
/// so that this is equal where the results are.
pub(super) const EXECUTION_DIGEST: &str = "execution_sha256";

/// Attributes of the root that differ between runs of equal results, and have a digest of their own, so that the others do not
/// differ.
const OF_THE_EXECUTION: [&str; 7] =
    ["decomposition", "host", "instruction_set", "start_time", "end_time", "workers", "wall_time"];

/// Writes the digests of the attributes that are there. No attribute may be written afterwards.
pub(super) fn write_attribute_digests(file: &File) -> hdf5::Result<()> {
    let execution = VarLenAscii::from_ascii(&of_execution(file)?).map_err(in_words)?;
    file.new_attr::<VarLenAscii>().create(EXECUTION_DIGEST)?.write_scalar(&execution)?;
    write_text(file, NUMBERS_DIGEST, &of_numbers(file)?)?;
    write_text(file, ATTRIBUTES_DIGEST, &of_texts(file)?)
}

/// Digest of the texts among the attributes, of the scales of datasets, and of what is in groups: of one line
/// `path@attribute=text` or `path: members` for each. A dataset's scales are the paths in `DIMENSION_LIST`; several texts, paths
/// or members, these as they were made, are separated by commas. What tells of the execution is left out.
pub(super) fn of_texts(file: &File) -> hdf5::Result<String> {
    let mut lines = lines_of_attributes(file, |path, name, attribute| {
        // What is left out must be readable all the same.
        let texts = texts(file, attribute)?.filter(|_| !OF_THE_EXECUTION.contains(&name) && name != ATTRIBUTES_DIGEST);
        Ok(texts.map(|texts| format!("{path}@{name}={}\n", texts.join(","))))
    })?;
    let mut groups = vec![file.as_group()?];
    while let Some(group) = groups.pop() {
        lines.push(format!("{}: {}\n", group.name(), members(&group)?.join(",")));
        groups.extend(group.groups()?);
    }
    Ok(digest(lines))
}

/// Digest of all other attributes: of one line `path@attribute=values` for each, several values separated by commas. A whole
/// number has its decimal digits, any other number the 16 hexadecimal digits of its 64 bits as IEEE 754 has them, of whatever width
/// the file keeps them. A text is as it is. Of anything else, such as references, the line ends behind the name.
pub(super) fn of_numbers(file: &File) -> hdf5::Result<String> {
    let lines = lines_of_attributes(file, |path, name, attribute| {
        let is_left_out = path == "/" && (OF_THE_EXECUTION.contains(&name) || name == EXECUTION_DIGEST);
        let is_number = !is_left_out && texts(file, attribute)?.is_none();
        is_number.then(|| line(file, path, name, attribute)).transpose()
    })?;
    Ok(digest(lines))
}

/// Digest of the attributes of the root that tell how the run was carried out, texts and numbers, each with a line as in
/// [`of_numbers`].
pub(super) fn of_execution(file: &File) -> hdf5::Result<String> {
    let names = file.attr_names()?.into_iter().filter(|name| OF_THE_EXECUTION.contains(&name.as_str()));
    let lines = names.map(|name| line(file, "/", &name, &file.attr(&name)?)).collect::<hdf5::Result<_>>()?;
    Ok(digest(lines))
}

/// The lines of the attributes of all groups, datasets and named types, of which `line` is given path, name and attribute.
fn lines_of_attributes(
    file: &File,
    line: impl Fn(&str, &str, &Attribute) -> hdf5::Result<Option<String>>,
) -> hdf5::Result<Vec<String>> {
    let mut lines = Vec::new();
    let mut add = |path: &str, location: &Location| -> hdf5::Result<()> {
        for name in location.attr_names()? {
            lines.extend(line(path, &name, &location.attr(&name)?)?);
        }
        Ok(())
    };
    let mut groups = vec![file.as_group()?];
    while let Some(group) = groups.pop() {
        add(&group.name(), &group)?;
        for member in members(&group)? {
            if group.loc_type_by_name(&member)? == LocationType::Dataset {
                let path = format!("{}/{member}", group.name().trim_end_matches('/'));
                add(&path, &*group.dataset(&member)?)?;
            }
        }
        for datatype in group.committed_datatypes()? {
            add(&datatype.name(), &datatype)?;
        }
        groups.extend(group.groups()?);
    }
    Ok(lines)
}

/// Members of a group, in the order in which they were made.
fn members(group: &Group) -> hdf5::Result<Vec<String>> {
    group.member_names_by(IndexType::CreationOrder, IterationOrder::Increasing)
}

fn digest(mut lines: Vec<String>) -> String {
    lines.sort();
    sha256_of(lines.concat().as_bytes())
}

/// The line of an attribute of whatever kind.
fn line(file: &File, path: &str, name: &str, attribute: &Attribute) -> hdf5::Result<String> {
    let values = values(file, attribute)?.map_or_else(String::new, |values| format!("={}", values.join(",")));
    Ok(format!("{path}@{name}{values}\n"))
}

/// Values of an attribute, if it is of texts or numbers.
fn values(file: &File, attribute: &Attribute) -> hdf5::Result<Option<Vec<String>>> {
    // What an empty one is said to hold is whatever the memory held before.
    if attribute.space()?.is_null() {
        return Ok(None);
    }
    Ok(match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::Integer(_) => Some(attribute.read_raw::<i64>()?.iter().map(i64::to_string).collect()),
        TypeDescriptor::Unsigned(_) => Some(attribute.read_raw::<u64>()?.iter().map(u64::to_string).collect()),
        TypeDescriptor::Float(_) => {
            Some(attribute.read_raw::<f64>()?.iter().map(|number| format!("{:016x}", number.to_bits())).collect())
        }
        TypeDescriptor::VarLenAscii | TypeDescriptor::FixedAscii(_) | TypeDescriptor::FixedUnicode(_) => {
            text_of(attribute)?.map(|text| vec![text])
        }
        _ => texts(file, attribute)?,
    })
}

/// Texts of an attribute, if it is of a kind for which the library keeps no checksum.
pub(super) fn texts(file: &File, attribute: &Attribute) -> hdf5::Result<Option<Vec<String>>> {
    // What an empty one is said to hold is whatever the memory held before.
    if attribute.space()?.is_null() {
        return Ok(None);
    }
    let texts = match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::VarLenUnicode => texts_of(attribute)?,
        TypeDescriptor::VarLenArray(_) => {
            let scales = attribute.read_raw::<VarLenArray<ObjectReference1>>()?;
            let scales = scales.iter().flat_map(|scales| scales.iter());
            scales.map(|scale| path_of(file, scale)).collect::<hdf5::Result<_>>()?
        }
        _ => return Ok(None),
    };
    Ok(Some(texts))
}

fn path_of(file: &File, reference: &ObjectReference1) -> hdf5::Result<String> {
    match file.dereference(reference)? {
        ReferencedObject::Dataset(dataset) => Ok(dataset.name()),
        _ => Err("a reference to something else than a dataset".into()),
    }
}

/// Result of verifying a run file that can be opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verification {
    /// State of its run.
    pub state: State,
    /// Number of samples.
    pub samples: usize,
    /// Number of moments of which there are maps.
    pub moments: usize,
    /// Number of digests that hold.
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
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Damage {
    /// Place of the damage, such as `/disc/height at 500 s`.
    pub place: String,
    /// Sign of the damage, in words.
    pub problem: String,
}

/// Compares all that a run file holds with the digests that were taken when it was written.
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
    /// Checks a dataset with one dimension.
    fn column(&mut self, path: &str) {
        let values = self.guarded(path, |dataset| dataset.read_1d::<f64>());
        let values = values.map(|values| values.to_vec()).map_err(|error| reason(&error));
        self.compare(path, values.map(|values| of_floats(&values)));
    }

    /// Checks as many values of a series as there are times; where the program was killed there may be more.
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

    /// Checks a map at every moment: each has its own digest.
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

    /// Refuses a dataset of a closed file that is longer than its times; before it is closed, what comes last may have none yet.
    fn no_more_than(&self, path: &str, times: usize) -> Result<(), String> {
        let rows = self.guarded(path, |dataset| Ok(dataset.shape().first().copied().unwrap_or(0)));
        let rows = rows.map_err(|error| reason(&error))?;
        if self.found.digested && rows > times {
            return Err(format!("it is longer than what was written: {rows} in place of {times}"));
        }
        Ok(())
    }

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
