//! Studies: many runs of one scene with other values of some keys, and what is asked of them (docs/studies.md).
//!
//! ```text
//! study file     document       the text
//!                factor_keys, design_keys, response_keys  what its keys say, each kind by itself
//!                build          what they say together -> Study
//!                unrecorded     series that no run would record
//!                plan           the design, its points and replicates -> the runs, each a list of --set arguments
//! results        identity       what a result is the result of
//!                record         what is kept of a run
//!                journal        where records are kept while many processes make them
//!                collected      all of them in one file
//!                results_table  all of them as text, a line for each run
//! ```

pub mod bounds;
mod build;
pub mod collected;
mod design_keys;
mod document;
pub mod factor;
mod factor_keys;
pub mod identity;
pub mod journal;
pub mod level;
mod place;
pub mod plan;
mod points_of_file;
pub mod record;
mod replicates;
pub mod response;
mod response_keys;
pub mod results_table;
mod unknown_key;
pub mod unrecorded;
pub mod value_table;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use plateau_study::design::Kind;
use thiserror::Error;

use crate::scene::{Origin, Problem};
use crate::{brief, hdf5_file, limits, regular, syntax};
use document::Document;
use factor::Factor;
use place::Place;
use points_of_file::Points;
use response::Response;

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
    /// Where the study names it.
    pub base_place: Origin,
    /// Where results are kept.
    pub directory: PathBuf,
    /// Name of the design.
    pub design: String,
    /// Arguments of `--set` for every run.
    pub sets: Vec<String>,
    /// Seed of the order and of designs that are drawn by lot.
    pub seed: u64,
    /// Where the points come from.
    pub source: DesignSource,
    /// What is varied.
    pub factors: Vec<Factor>,
    /// Seeds with which every point is run, if there are several.
    pub replicates: Option<Replicates>,
    /// In which order runs are made.
    pub order: Order,
    /// What is asked of the runs.
    pub responses: Vec<Response>,
    /// The series that are kept; all unless given.
    pub series: Option<Vec<String>>,
}

/// Where the points of a study come from.
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

/// Why a study cannot be used: everything that is wrong with it.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}", brief::problems(.0))]
pub struct StudyError(pub Vec<Problem>);

impl Study {
    /// Whether all responses come from elsewhere, so that runs need not be made.
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

    /// Reads the study at `path`. Whether the scenes of its runs can be built is seen when they are planned.
    ///
    /// # Errors
    /// [`StudyError`] with everything that is wrong, each with its place in the text.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let file: Arc<Path> = path.into();
        let at = |origin: Origin, message: String| StudyError(vec![Problem::without_key(&origin, message)]);
        let text = regular::read_to_string(path, limits::STUDY).map_err(|error| {
            let (what, system) = if hdf5_file::is_hdf5(path).unwrap_or(false) {
                ("this is an HDF5 file, expected a study, which is a text in TOML".to_owned(), None)
            } else {
                (format!("cannot read the study: {error}"), error.raw_os_error())
            };
            StudyError(vec![Problem { system, ..Problem::without_key(&Origin::File(file.clone()), what) }])
        })?;
        let place = Place { file: file.clone(), text: &text };
        let located = |error: &toml::de::Error, message: String| {
            at(error.span().map_or(Origin::File(file.clone()), |span| place.at(span.start)), message)
        };
        let table: toml::Table = text.parse().map_err(|error| located(&error, syntax::problem(&text, &error)))?;
        if is_scene(&table) {
            let message = "this is a scene, expected a study; `plateau run` and `plateau check` take scenes";
            return Err(at(Origin::File(file.clone()), message.to_owned()));
        }
        let document: Document =
            toml::from_str(&text).map_err(|error| located(&error, unknown_key::with_advice(error.message())))?;
        build::build(document, path, &place).map_err(StudyError)
    }
}

/// Whether this is a scene: it has a table that only scenes have, and nothing that every study has.
fn is_scene(table: &toml::Table) -> bool {
    let has = |keys: &[&str]| keys.iter().any(|key| table.contains_key(*key));
    let tables = ["mesh", "operation", "contact", "materials", "plateaus", "disc", "pin", "extends"];
    has(&tables) && !has(&["design", "factor", "base"])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_told_from_a_study() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let said = |text: &str| {
            std::fs::write(&path, text).unwrap();
            Study::load(&path).unwrap_err().to_string()
        };
        let scene = format!("{}: this is a scene, expected a study; `plateau run` and", path.display());
        for text in ["version = 1\n[mesh]\nrows = 8\n", "extends = \"quick.toml\"\n"] {
            assert!(said(text).starts_with(&scene), "{}", said(text));
        }
        assert!(!said("version = 1\ndesign = \"sobol\"\n[mesh]\n").contains("this is a scene"));
    }
}
