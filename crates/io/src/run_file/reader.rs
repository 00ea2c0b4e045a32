//! Run files, read: also such that are still written, or whose run was killed.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use plateau_core::acceleration::Chosen;
use plateau_core::model::mesh::Mesh;
use plateau_core::observe::{Map, MapValues};

use super::error::ReadError;
use super::header::InputFile;
use super::layout::{ACCELERATION, MAP_TIME, PIN_BASE, TIME, map_path, series_path};
use super::opening::{Opening, Series, reason};
use super::state::State;
use super::status::Statuses;
use crate::hdf5_file::{self, OpenError};
use crate::syntax::is_study;
use crate::text::{short, shown_title};
use crate::timestamp::from_iso_8601;
use crate::{limits, regular};

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
    ///
    /// # Errors
    /// [`ReadError`] when there is no file, it is no run file, or it is damaged.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let system = |error: std::io::Error| ReadError::of_system(path, &error);
        let is_hdf5 = hdf5_file::is_hdf5(path).map_err(system)?;
        if !is_hdf5 {
            return Err(ReadError::NotHdf5 { path: path.into(), expected: expected_of(path) });
        }
        let damaged = |error: hdf5::Error| ReadError::of_library(path, reason(&error));
        hdf5_file::guarded(0, || {
            let file = hdf5_file::open(path).map_err(|error| match error {
                OpenError::System(error) => system(error),
                OpenError::Hdf5(error) => damaged(error),
                elsewhere => ReadError::Elsewhere { path: path.into(), reason: elsewhere.to_string() },
            })?;
            Self::read(&Opening { path, file: &file })
        })
    }

    /// All of a file but series and maps.
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

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Title of the scene.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// How its run ended.
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

    /// What the acceleration that its run chose was like; none if it chose none, or has not ended.
    pub fn chosen_acceleration(&self) -> Option<Chosen> {
        serde_json::from_str(&self.attribute(ACCELERATION)?).ok()
    }

    /// When its run began.
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
    ///
    /// # Errors
    /// [`ReadError::Damaged`] when they cannot be read or are fewer than the times.
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

    /// Whether a map was recorded, at whatever times there are.
    pub fn has_map(&self, map: Map) -> bool {
        self.file.link_exists(map_path(map))
    }

    /// The values of a map, column by column, at the time of that index; nothing if it was not recorded.
    ///
    /// # Errors
    /// [`ReadError::Damaged`] when they cannot be read or do not fit the mesh.
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
    ///
    /// # Errors
    /// [`ReadError::Damaged`] when it cannot be read or does not fit the mesh.
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
}

/// What is expected in place of a file that is not HDF5, and which command makes it: of a scene or a study that was named in its place.
fn expected_of(path: &Path) -> String {
    let shown = path.display();
    let expected = "expected a run file of plateau, which";
    if path.extension().is_none_or(|ending| ending != "toml") {
        return format!("{expected} `plateau run` writes");
    }
    let table = regular::read_to_string(path, limits::STUDY).ok().and_then(|text| text.parse::<toml::Table>().ok());
    if table.is_some_and(|table| is_study(|key| table.contains_key(key))) {
        return format!(
            "{expected} `plateau run` writes of a scene; this is a study, whose figures `plateau sweep effects {shown}` draws"
        );
    }
    format!("{expected} `plateau run {shown}` writes")
}
