//! Run files, read: also such that are still written, or whose run was killed. Of a file it is not known at first whether it is a run
//! file: what is read of it is checked, and refused with its path. The mean contact area at the end of a run.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use hdf5::{Dataset, H5Type};
use ndarray::s;
use plateau_core::acceleration::Chosen;
use plateau_core::model::material::Status;
use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::Base;
use plateau_core::observe::running_in::{Drift, NotDefined, RUN_IN, pulse_time, time_to, time_to_in_contact};
use plateau_core::observe::window_mean::{Cumulative, LEAST_PARTS, WindowMean, last_tenth};
use plateau_core::observe::{EXTRAS, Map, MapValues, quantities};
use thiserror::Error;

use crate::hdf5_file::{self, OpenError};
use crate::run_file::error::ReadError;
use crate::run_file::header::{Header, InputFile, State};
use crate::run_file::layout::{
    ACCELERATION, FORMAT_VERSION, MAP_TIME, PIN_BASE, Statuses, TIME, TIME_OF_SERIES, map_path, series_path,
};
use crate::scene::mesh::{Cells, Refused};
use crate::scene::schema::choices::{SHAPE, Shape};
use crate::scene::{self, is_study};
use crate::text::{short, shown_title};
use crate::timestamp::from_iso_8601;
use crate::units::{self, Dimension};
use crate::{input, limits, number};

/// A series of a run file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Series {
    /// Name of its dataset below `/series`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Meaning of the series, in words.
    pub long_name: String,
}

/// A file of which it is not yet known whether it is a run file.
struct Opening<'a> {
    pub(super) path: &'a Path,
    pub(super) file: &'a hdf5::File,
}

impl Opening<'_> {
    /// Refuses another format than those that are read here, and what is no version at all.
    fn check_version(&self) -> Result<(), ReadError> {
        // As a floating-point number, for as a whole one the library would read NaN as 0, and 1.5 as 1.
        let found = hdf5_file::number_attribute::<f64>(self.file, "format_version").ok().flatten();
        let found = found.ok_or_else(|| self.foreign("root attribute format_version"))?;
        if (1..=FORMAT_VERSION).any(|known| f64::from(known) == found) {
            return Ok(());
        }
        if found.is_finite() && found.fract() == 0.0 && found > f64::from(FORMAT_VERSION) {
            return Err(ReadError::Newer(self.path.into(), found as i64));
        }
        Err(self.damaged(format!(
            "its format_version is {}, expected a whole number from 1 to {FORMAT_VERSION}",
            number::plain(found)
        )))
    }

    /// The mesh, as the scene has it; the coordinates must be those of this mesh.
    pub(super) fn mesh(&self, scene: &toml::Table) -> Result<Mesh, ReadError> {
        let value = |key: &str| scene.get("mesh").and_then(|mesh| mesh.get(key));
        let incomplete = |key: &str| self.damaged(format!("its scene has no usable mesh.{key}"));
        let length = |key: &'static str| {
            let usable = |text: &toml::Value| units::parse(text.as_str()?, Dimension::Length).ok();
            value(key).map(|value| usable(value).ok_or_else(|| incomplete(key))).transpose()
        };
        let count = |key: &'static str| {
            let usable = |number: &toml::Value| u64::try_from(number.as_integer()?).ok();
            value(key).map(|value| usable(value).ok_or_else(|| incomplete(key))).transpose()
        };
        let shape = match value("shape") {
            // Files of before there was a choice have none.
            None => Shape::Rectangle,
            Some(word) => {
                let known = SHAPE.iter().find(|(known, _)| word.as_str() == Some(*known));
                known.ok_or_else(|| incomplete("shape"))?.1
            }
        };
        let refused = |Refused { message, .. }: Refused| self.damaged(format!("its mesh: {message}"));
        let cells = Cells::read(shape, length, count, incomplete, refused)?;
        for (name, expected) in ["radius", "disc_angle", "pin_angle"].into_iter().zip(cells.counts) {
            let found = self.dataset(name)?.size();
            if found as u64 != expected {
                return Err(self.damaged(format!("/{name} has {found} values, expected {expected} as in its scene")));
            }
        }
        cells.mesh().map_err(refused)
    }

    /// The series, in the order in which they are reported.
    pub(super) fn series(&self) -> Result<Vec<Series>, ReadError> {
        let group =
            self.file.group("series").map_err(|_| ReadError::Foreign(self.path.into(), "group /series".into()))?;
        let names = group.member_names().map_err(|error| self.damaged(reason(&error)))?;
        // Their time is no series.
        let series = names.into_iter().filter(|name| series_path(name) != TIME_OF_SERIES).map(|name| {
            let dataset = self.dataset(&series_path(&name))?;
            let text = |attribute| match hdf5_file::text_attribute(&dataset, attribute) {
                Ok(text) => Ok(text.unwrap_or_default()),
                Err(error) => Err(self.damaged(format!("/series/{name}: {}", reason(&error)))),
            };
            Ok(Series { unit: text("units")?, long_name: text("long_name")?, name })
        });
        let mut series: Vec<Series> = series.collect::<Result<_, _>>()?;
        // As they are reported; what is not known here comes last.
        let place = |name: &str| quantities(EXTRAS).position(|quantity| quantity.name == name).unwrap_or(usize::MAX);
        series.sort_by(|one, other| (place(&one.name), &one.name).cmp(&(place(&other.name), &other.name)));
        Ok(series)
    }

    pub(super) fn dataset(&self, path: &str) -> Result<Dataset, ReadError> {
        if !self.file.link_exists(path) {
            return Err(ReadError::Foreign(self.path.into(), format!("dataset /{path}")));
        }
        let dataset = self.file.dataset(path).and_then(|dataset| {
            hdf5_file::refuse_hollow(&dataset)?;
            Ok(dataset)
        });
        dataset.map_err(|error| self.damaged(format!("/{path}: {}", reason(&error))))
    }

    /// All values of a dataset with one dimension.
    pub(super) fn all(&self, path: &str) -> Result<Vec<f64>, ReadError> {
        let values = self.dataset(path)?.read_1d::<f64>();
        values.map(|values| values.to_vec()).map_err(|error| self.damaged(format!("/{path}: {}", reason(&error))))
    }

    /// The first values of a dataset with one dimension.
    pub(super) fn start(&self, path: &str, count: usize) -> Result<Vec<f64>, ReadError> {
        let dataset = self.dataset(path)?;
        if dataset.ndim() != 1 || dataset.size() < count {
            return Err(self.damaged(format!("/{path} has shape {:?}, expected {count} values", dataset.shape())));
        }
        let values = dataset.read_slice_1d::<f64, _>(s![..count]);
        values.map(|values| values.to_vec()).map_err(|error| self.damaged(format!("/{path}: {}", reason(&error))))
    }

    /// The values of a map at one time.
    pub(super) fn level<T: H5Type>(
        &self,
        path: &str,
        index: usize,
        (columns, rows): (usize, usize),
    ) -> Result<Vec<T>, ReadError> {
        let dataset = self.dataset(path)?;
        match dataset.shape()[..] {
            [levels, c, r] if index < levels && (c, r) == (columns, rows) => {
                let values = dataset.read_slice_2d::<T, _>(s![index, .., ..]);
                let values = values.map_err(|error| self.damaged(format!("/{path}: {}", reason(&error))))?;
                Ok(values.into_raw_vec_and_offset().0)
            }
            _ => Err(self.damaged(format!(
                "/{path} has shape {:?}, expected ({} or more, {columns}, {rows})",
                dataset.shape(),
                index + 1
            ))),
        }
    }

    /// Error of a file that lacks what every run file has.
    pub(super) fn foreign(&self, missing: &str) -> ReadError {
        // What `sweep collect` writes.
        let is_study = self.file.attr("base_scene").is_ok();
        let advice = if is_study {
            "; it has the results of a study, which `plateau sweep effects STUDY.toml` draws"
        } else {
            ""
        };
        ReadError::Foreign(self.path.into(), format!("{missing}{advice}"))
    }

    /// Error of a run file that is not as it was written.
    pub(super) fn damaged(&self, reason: impl Into<String>) -> ReadError {
        ReadError::of_library(self.path, reason)
    }
}

/// Message of the library, on one line.
pub(super) fn reason(error: &hdf5::Error) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A run file as it was when it was opened: what is appended later is not seen.
pub struct RunFile {
    path: PathBuf,
    pub(super) file: hdf5::File,
    title: String,
    state: State,
    scene: toml::Table,
    mesh: Mesh,
    time: Vec<f64>,
    map_time: Vec<f64>,
    series: Vec<Series>,
}

impl RunFile {
    /// Opens a run file and reads all of it but series and maps.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let system = |error: std::io::Error| ReadError::of_system(path, &error);
        let is_hdf5 = hdf5_file::is_hdf5(path).map_err(system)?;
        if !is_hdf5 {
            return Err(ReadError::NotHdf5(path.into(), expected_of(path)));
        }
        let damaged = |error: hdf5::Error| ReadError::of_library(path, reason(&error));
        hdf5_file::guarded(0, || {
            let file = hdf5_file::open(path).map_err(|error| match error {
                OpenError::System(error) => system(error),
                OpenError::Hdf5(error) => damaged(error),
                elsewhere => ReadError::Elsewhere(path.into(), elsewhere.to_string()),
            })?;
            Self::read(&Opening { path, file: &file })
        })
    }

    fn read(opening: &Opening<'_>) -> Result<Self, ReadError> {
        opening.check_version()?;
        let text = |name: &str| {
            let text =
                hdf5_file::text_attribute(opening.file, name).map_err(|error| opening.damaged(reason(&error)))?;
            text.ok_or_else(|| opening.foreign(&format!("root attribute {name}")))
        };
        let state = text("state")?;
        let state = State::of(&state).ok_or_else(|| {
            let known = State::ALL.map(State::name).join(", ");
            opening.damaged(format!("its state is \"{}\", expected {known}", short(&state).escape_debug()))
        })?;
        let scene: toml::Table = text("scene")?.parse().map_err(|error: toml::de::Error| {
            // The line of TOML that it shows may be all of a text that somebody else has made.
            opening.damaged(format!("its scene is not TOML: {}", shown_title(error.message())))
        })?;
        let mesh = opening.mesh(&scene)?;
        let time = opening.all(TIME)?;
        let map_time = if opening.file.link_exists(MAP_TIME) { opening.all(MAP_TIME)? } else { Vec::new() };
        Ok(Self {
            path: opening.path.into(),
            file: opening.file.clone(),
            title: text("title")?,
            state,
            scene,
            mesh,
            time,
            map_time,
            series: opening.series()?,
        })
    }

    /// The same file by another name than that by which it was opened.
    pub(super) fn known_as(self, path: &Path) -> Self {
        Self { path: path.into(), ..self }
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Title of the scene.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// State of its run.
    pub fn state(&self) -> State {
        self.state
    }

    /// A text of its root attributes, such as `program` or `host`, if it is there.
    pub fn attribute(&self, name: &str) -> Option<String> {
        hdf5_file::text_attribute(&self.file, name).ok().flatten()
    }

    /// The files that its run has read, as far as they can be told.
    pub fn inputs(&self) -> Vec<InputFile> {
        let document: serde_json::Value =
            self.attribute("inputs").and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        let entry = |entry: &serde_json::Value| {
            let text = |name: &str| entry.get(name).and_then(|value| value.as_str()).map(str::to_owned);
            Some(InputFile { path: text("path")?, sha256: text("sha256")? })
        };
        document.as_array().into_iter().flatten().filter_map(entry).collect()
    }

    /// A number of its root attributes, such as `workers` or `wall_time`, if it is there.
    pub fn number(&self, name: &str) -> Option<f64> {
        hdf5_file::number_attribute(&self.file, name).ok()?
    }

    /// Acceleration that its run chose; none if it chose none, or has not ended.
    pub fn chosen_acceleration(&self) -> Option<Chosen> {
        serde_json::from_str(&self.attribute(ACCELERATION)?).ok()
    }

    /// Time at which its run began.
    pub fn start_time(&self) -> Option<SystemTime> {
        from_iso_8601(&self.attribute("start_time")?)
    }

    /// The whole resolved scene.
    pub fn scene(&self) -> &toml::Table {
        &self.scene
    }

    /// The ring mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Times of the samples, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Times of the maps, s.
    pub fn map_time(&self) -> &[f64] {
        &self.map_time
    }

    /// The series that it has besides the times, in the order in which they are reported.
    pub fn series(&self) -> &[Series] {
        &self.series
    }

    /// Values of a series, one for each time; nothing if it has no such series.
    pub fn values(&self, name: &str) -> Result<Option<Vec<f64>>, ReadError> {
        self.first_values(name, self.time.len())
    }

    /// The first values of a series, of which there may be fewer than times where the power has failed.
    pub(super) fn first_values(&self, name: &str, count: usize) -> Result<Option<Vec<f64>>, ReadError> {
        if !self.series.iter().any(|series| series.name == name) {
            return Ok(None);
        }
        let opening = Opening { path: &self.path, file: &self.file };
        opening.start(&series_path(name), count).map(Some)
    }

    /// Samples of which every series has a value.
    pub(super) fn whole_samples(&self) -> usize {
        let lengths =
            self.series.iter().filter_map(|series| Some(self.file.dataset(&series_path(&series.name)).ok()?.size()));
        lengths.chain([self.time.len()]).min().unwrap_or(0)
    }

    /// Moments up to the first of which a map cannot be read.
    pub(super) fn whole_moments(&self) -> usize {
        let readable = |moment| Map::ALL.into_iter().all(|map| self.map(map, moment).is_ok());
        (0..self.map_time.len()).take_while(|moment| readable(*moment)).count()
    }

    /// Tells whether a map was recorded, at whatever times there are.
    pub fn has_map(&self, map: Map) -> bool {
        self.file.link_exists(map_path(map))
    }

    /// The values of a map, column by column, at the time of that index; nothing if it was not recorded.
    pub fn map(&self, map: Map, index: usize) -> Result<Option<MapValues>, ReadError> {
        if !self.has_map(map) {
            return Ok(None);
        }
        let opening = Opening { path: &self.path, file: &self.file };
        let columns = if map.on_disc() { self.mesh.disc_columns() } else { self.mesh.pin_columns() };
        let shape = (columns, self.mesh.rows());
        if map.is_status() {
            let values = opening.level::<u8>(map_path(map), index, shape)?;
            let largest = Statuses::of(&self.mesh).largest(map);
            match values.iter().find(|value| **value > largest) {
                Some(value) => Err(opening.damaged(format!("{} has {value}, which is not a status", map_path(map)))),
                None => Ok(Some(MapValues::Status(values))),
            }
        } else {
            opening.level::<f64>(map_path(map), index, shape).map(|values| Some(MapValues::Float(values)))
        }
    }

    /// Base of every pin cell, column by column: 0 where it is resin, 1 where it is fibre,
    /// [`ABSENT`](plateau_core::observe::ABSENT) beyond the pin's outline; nothing if it was not recorded.
    pub fn pin_base(&self) -> Result<Option<Vec<u8>>, ReadError> {
        if !self.file.link_exists(PIN_BASE) {
            return Ok(None);
        }
        let opening = Opening { path: &self.path, file: &self.file };
        let base = opening.dataset(PIN_BASE)?.read_2d::<u8>();
        let base = base.map_err(|error| opening.damaged(format!("/{PIN_BASE}: {}", reason(&error))))?;
        let expected = (self.mesh.pin_columns(), self.mesh.rows());
        if base.dim() != expected {
            return Err(opening.damaged(format!("/{PIN_BASE} has shape {:?}, expected {expected:?}", base.dim())));
        }
        Ok(Some(base.into_raw_vec_and_offset().0))
    }

    /// Base of every pin cell, column by column, resin beyond the pin's outline; nothing if it was not recorded.
    pub(super) fn bases(&self) -> Result<Option<Vec<Base>>, ReadError> {
        let of = |base: u8| if base == Status::Primary as u8 { Base::Primary } else { Base::Resin };
        Ok(self.pin_base()?.map(|found| found.into_iter().map(of).collect()))
    }
}

/// Tells what is expected in place of a file that is not HDF5, and which command makes it: also of a scene or study that was named.
fn expected_of(path: &Path) -> String {
    let shown = path.display();
    let expected = "expected a run file of plateau, which";
    if path.extension().is_none_or(|ending| ending != "toml") {
        return format!("{expected} `plateau run` writes");
    }
    let table = input::read_to_string(path, limits::STUDY).ok().and_then(|text| text.parse::<toml::Table>().ok());
    if table.is_some_and(|table| is_study(|key| table.contains_key(key))) {
        return format!(
            "{expected} `plateau run` writes of a scene; this is a study, whose figures `plateau sweep effects {shown}` draws"
        );
    }
    format!("{expected} `plateau run {shown}` writes")
}

impl Header {
    pub(super) fn of(run: &RunFile) -> Result<Self, ReadError> {
        let damaged = |reason: String| ReadError::of_library(run.path(), reason);
        let text = |name: &str| run.attribute(name).ok_or_else(|| damaged(format!("it has no {name}")));
        let has = |name: &str| run.series().iter().any(|series| series.name == name);
        let base = run.bases()?.ok_or_else(|| damaged("it has no base of the pin".to_owned()))?;
        let seeds: serde_json::Map<String, serde_json::Value> = json(run.path(), "seeds", &text("seeds")?)?;
        let inputs: Vec<InputFile> = json(run.path(), "inputs", &text("inputs")?)?;
        let seeds = seeds.into_iter().map(|(key, seed)| match seed.as_u64() {
            Some(number) => Ok((key, number)),
            None => Err(damaged(format!("the seed of {} is {}", short(&key), short(&seed.to_string())))),
        });
        Ok(Self {
            title: run.title().to_owned(),
            mesh: run.mesh().clone(),
            pin_base: base,
            maps: Map::ALL.into_iter().filter(|map| run.has_map(*map)).collect(),
            extras: EXTRAS.iter().copied().filter(|extra| has(extra.quantities[0].name)).collect(),
            expected_samples: run.time().len() as u64,
            scene: text("scene")?,
            program: text("program")?,
            source_revision: text("source_revision")?,
            host: text("host")?,
            workers: run.number("workers").ok_or_else(|| damaged("it has no workers".to_owned()))? as usize,
            decomposition: text("decomposition")?,
            instruction_set: text("instruction_set")?,
            seeds: seeds.collect::<Result<_, _>>()?,
            inputs,
            surfaces: text("surfaces")?.lines().map(str::to_owned).collect(),
        })
    }
}

fn json<T: serde::de::DeserializeOwned>(path: &Path, name: &str, text: &str) -> Result<T, ReadError> {
    serde_json::from_str(text)
        .map_err(|error| ReadError::of_library(path, format!("its {name}: {}", shown_title(&error.to_string()))))
}

/// Contact area of a run at its end.
#[derive(Debug, Clone, Copy)]
pub struct ContactArea {
    /// The mean over the last tenth of the run, m², as far as it is recorded: see [`last_tenth`]. Of a run with a cycle over the time
    /// in contact.
    pub last_tenth: Option<WindowMean>,
    /// Change of the mean in the second half of the run, or why that is not told.
    pub drift: Result<Drift, NoDrift>,
    /// Time at which it has come to 90 % of its value at the end, s, or why that is not defined; with a cycle over the time in contact.
    pub running_in: Result<f64, NotDefined>,
}

/// Reason why it is not told whether a run is still running in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum NoDrift {
    /// The contact area follows load and speed.
    #[error("cannot be told: with a cycle the contact area follows load and speed")]
    Cycle,
    /// Samples or simulated revolutions that are too few to compare.
    #[error(
        "cannot be told: too few samples or simulated revolutions; {LEAST_PARTS} in each quarter of the second half are needed"
    )]
    TooShort,
}

impl RunFile {
    /// The contact area at the end of the run, as far as it is recorded.
    pub fn contact_area(&self) -> Result<ContactArea, ReadError> {
        let integral = self.values("contact_area_integral")?.unwrap_or_default();
        // Without the integral there are no samples of it.
        let time = if integral.is_empty() { &[] } else { self.time() };
        let revolutions = self.revolutions()?.unwrap_or_default();
        let samples = Cumulative { time, integral: &integral, revolutions: &revolutions };
        let contact_time = self.values("contact_time")?;
        let window = last_tenth(samples.time, samples.revolutions);
        Ok(match contact_time {
            Some(contact_time) => ContactArea {
                last_tenth: window.and_then(|(from, to)| samples.mean_in_contact(&contact_time, from, to)),
                drift: Err(NoDrift::Cycle),
                running_in: time_to_in_contact(RUN_IN, &samples, &contact_time),
            },
            None => {
                let pulse_time = self.pulse_time();
                ContactArea {
                    last_tenth: window.and_then(|(from, to)| Some(samples.mean(from, to)?.of_pulses(pulse_time))),
                    drift: Drift::of(&samples, pulse_time).ok_or(NoDrift::TooShort),
                    running_in: time_to(RUN_IN, &samples, pulse_time),
                }
            }
        })
    }

    /// Time of a pulse of the contact area, s, at least; none where nothing pulses, or the file does not tell.
    fn pulse_time(&self) -> Option<f64> {
        let scene = scene::of_text(self.path(), &self.attribute("scene")?).ok()?;
        pulse_time(&scene.parameters, &self.bases().ok()??)
    }

    /// Simulated revolutions from t = 0 to every sample, where the sliding distance is recorded: a simulated revolution stands
    /// for as many as the time acceleration says.
    fn revolutions(&self) -> Result<Option<Vec<f64>>, ReadError> {
        let Some(distance) = self.values("sliding_distance")? else { return Ok(None) };
        let accelerations = match self.values("time_acceleration")? {
            Some(chosen) => chosen,
            None => vec![self.given_acceleration().unwrap_or(1.0); distance.len()],
        };
        let way = TAU * self.mesh().mean_radius();
        let (mut before, mut turns) = (0.0, 0.0);
        let turned = distance.iter().zip(&accelerations).map(|(distance, acceleration)| {
            turns += (distance - before) / (way * acceleration);
            before = *distance;
            turns
        });
        Ok(Some(turned.collect()))
    }

    /// The time acceleration of the scene, if that is a number.
    pub fn given_acceleration(&self) -> Option<f64> {
        let given = self.scene().get("numerics").and_then(|numerics| numerics.get("time_acceleration"));
        given.and_then(|given| given.as_float().or_else(|| given.as_integer().map(|given| given as f64)))
    }
}
