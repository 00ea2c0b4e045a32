//! A file of which it is not yet known whether it is a run file: what is read of it is checked, and refused with its path.

use std::path::Path;

use hdf5::{Dataset, H5Type};
use ndarray::s;
use plateau_core::model::mesh::Mesh;
use plateau_core::observe::{EXTRAS, quantities};

use super::error::ReadError;
use super::layout::{FORMAT_VERSION, TIME_OF_SERIES, series_path};
use crate::hdf5_file;
use crate::number;
use crate::scene::mesh::{Geometry, Refused};
use crate::scene::schema::choices::{SHAPE, Shape};
use crate::units::{self, Dimension};

/// A series of a run file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Series {
    /// Name of its dataset below `/series`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// What it is, in words.
    pub long_name: String,
}

/// A file of which it is not yet known whether it is a run file.
pub(super) struct Opening<'a> {
    pub(super) path: &'a Path,
    pub(super) file: &'a hdf5::File,
}

impl Opening<'_> {
    /// Refuses another format than those that are read here, and what is no version at all.
    pub(super) fn check_version(&self) -> Result<(), ReadError> {
        // As a floating-point number, for as a whole one the library would read NaN as 0, and 1.5 as 1.
        let found = hdf5_file::number_attribute::<f64>(self.file, "format_version").ok().flatten();
        let found = found.ok_or_else(|| self.foreign("root attribute format_version"))?;
        if (1..=FORMAT_VERSION).any(|known| f64::from(known) == found) {
            return Ok(());
        }
        if found.is_finite() && found.fract() == 0.0 && found > f64::from(FORMAT_VERSION) {
            return Err(ReadError::Newer { path: self.path.into(), found: found as i64, expected: FORMAT_VERSION });
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
        let cells = Geometry::read(shape, length, count, incomplete)?.cells().map_err(refused)?;
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
        let group = self
            .file
            .group("series")
            .map_err(|_| ReadError::Foreign { path: self.path.into(), missing: "group /series".into() })?;
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

    /// A dataset that is there and has data.
    pub(super) fn dataset(&self, path: &str) -> Result<Dataset, ReadError> {
        if !self.file.link_exists(path) {
            return Err(ReadError::Foreign { path: self.path.into(), missing: format!("dataset /{path}") });
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

    /// Of a file that lacks what every run file has.
    pub(super) fn foreign(&self, missing: &str) -> ReadError {
        // What `sweep collect` writes.
        let is_study = self.file.attr("base_scene").is_ok();
        let advice = if is_study {
            "; it has the results of a study, which `plateau sweep effects STUDY.toml` draws"
        } else {
            ""
        };
        ReadError::Foreign { path: self.path.into(), missing: format!("{missing}{advice}") }
    }

    /// Of a run file that is not as it was written.
    pub(super) fn damaged(&self, reason: impl Into<String>) -> ReadError {
        ReadError::of_library(self.path, reason)
    }
}

/// What the library said, on one line.
pub(super) fn reason(error: &hdf5::Error) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
