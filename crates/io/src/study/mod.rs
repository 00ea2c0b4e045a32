//! Studies: many runs of one scene with other values of some keys, and what is asked of them (docs/study.md).
//!
//! ```text
//! study file     document       the text, with places
//!                factor_keys, response_keys, build  from its keys to a Study
//!                factor, response   values of the factors, questions to the series of a run
//!                response_series    series that no run would record, bounds of responses
//!                value_table    points of a design in a table
//!                plan           the design, its points and replicates -> the runs, each a list of --set arguments
//! results        record         what a result is the result of, and what is kept of it
//!                journal        where records are kept while many processes make them
//!                results        all of them, and as text, a line for each run
//!                results_file   all of them in one HDF5 file
//! ```

mod build;
mod document;
pub mod factor;
mod factor_keys;
pub mod journal;
pub mod plan;
pub mod record;
pub mod response;
mod response_keys;
pub mod response_series;
pub mod results;
pub mod results_file;
mod value_table;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use document::Document;
use factor::Factor;
use plateau_study::design::Kind;
use response::Response;
use thiserror::Error;
use value_table::Points;

use crate::scene::{Locator, Origin, Problem, not_toml};
use crate::{hdf5_file, input, limits, text};

/// The table, among the results of a study, of responses that come from elsewhere.
const IMPORTED: &str = "imported.csv";

/// A study, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Title; the file's stem if the study gives none.
    pub title: String,
    /// The study file.
    pub path: PathBuf,
    /// The study file and the tables that it names; scenes and what they read are not among them.
    pub files: Vec<PathBuf>,
    /// The scene that is varied; none of a study whose responses are all imported.
    pub base: Option<PathBuf>,
    /// Place in the study that names it.
    pub base_place: Origin,
    /// Folder of the results.
    pub directory: PathBuf,
    /// Name of the design.
    pub design: String,
    /// Arguments of `--set` for every run.
    pub sets: Vec<String>,
    /// Seed of the order and of designs that are drawn by lot.
    pub seed: u64,
    /// Source of the points.
    pub source: DesignSource,
    /// Factors that are varied.
    pub factors: Vec<Factor>,
    /// Seeds with which every point is run, if there are several.
    pub replicates: Option<Replicates>,
    /// In which order runs are made.
    pub order: Order,
    /// Responses that are asked of the runs.
    pub responses: Vec<Response>,
    /// The series that are kept; all unless given.
    pub series: Option<Vec<String>>,
}

/// Source of the points of a study.
#[derive(Debug, Clone, PartialEq)]
pub enum DesignSource {
    /// A design that the program makes, with so many centre points besides those of its kind.
    Kind(Kind, usize),
    /// A table of one's own.
    File(Points),
}

/// Seeds with which every point is run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Replicates {
    /// Keys that are set to the seed.
    pub keys: Vec<String>,
    /// The seeds.
    pub seeds: Vec<i64>,
}

/// In which order runs are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// By lot, so that what drifts meanwhile is not taken for an effect.
    Random,
    /// As the design has them.
    Standard,
}

/// Reason why a study cannot be used: everything that is wrong with it.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}", text::problems(.0))]
pub struct StudyError(pub Vec<Problem>);

impl Study {
    /// Tells whether all responses come from elsewhere, so that runs need not be made.
    pub fn is_imported(&self) -> bool {
        !self.responses.is_empty() && self.responses.iter().all(Response::is_imported)
    }

    /// All that is read of a study but its scenes and what those read: the study file, the tables that it names, its base scene, and
    /// what is kept of its results.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let kept = ["journal", "under-way"].map(|name| self.directory.join(name));
        let files =
            |folder: PathBuf| std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let mut inputs = self.files.clone();
        inputs.extend(self.base.clone());
        inputs.push(self.directory.join(IMPORTED));
        inputs.extend(kept.into_iter().flat_map(files));
        inputs
    }
}

impl Study {
    /// Reads the study at `path`. Whether the scenes of its runs can be built is seen when they are planned.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let file: Arc<Path> = path.into();
        let at = |origin: Origin, message: String| StudyError(vec![Problem::without_key(&origin, message)]);
        let text = input::read_to_string(path, limits::STUDY).map_err(|error| {
            let (what, system) = if hdf5_file::is_hdf5(path).unwrap_or(false) {
                ("this is an HDF5 file, expected a study, which is a text in TOML".to_owned(), None)
            } else {
                (format!("cannot read the study: {error}"), error.raw_os_error())
            };
            StudyError(vec![Problem { system, ..Problem::without_key(&Origin::File(file.clone()), what) }])
        })?;
        let locator = Locator::new(file.clone(), &text);
        let located = |error: &toml::de::Error, message: String| {
            at(error.span().map_or(Origin::File(file.clone()), |span| locator.origin(span)), message)
        };
        let table: toml::Table = text.parse().map_err(|error| located(&error, not_toml(&text, &error)))?;
        if is_scene(&table) {
            let message = "this is a scene, expected a study; `plateau run` and `plateau check` take scenes";
            return Err(at(Origin::File(file.clone()), message.to_owned()));
        }
        let document: Document =
            toml::from_str(&text).map_err(|error| located(&error, document::with_advice(error.message())))?;
        build::build(document, path, &locator).map_err(StudyError)
    }
}

/// Tells whether this is a scene: it has a table that only scenes have, and nothing that every study has.
fn is_scene(table: &toml::Table) -> bool {
    let has = |keys: &[&str]| keys.iter().any(|key| table.contains_key(*key));
    let tables = ["mesh", "operation", "contact", "materials", "plateaus", "disc", "pin", "extends"];
    has(&tables) && !has(&["design", "factor", "base"])
}

#[cfg(test)]
#[path = "../../tests/unit/study.rs"]
mod tests;
