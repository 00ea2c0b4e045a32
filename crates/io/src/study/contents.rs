//! A study, read and checked.

use std::path::PathBuf;

use plateau_study::design::Kind;
use thiserror::Error;

use super::factor::Factor;
use super::response::Response;
use super::value_table::Points;
use crate::scene::{Origin, Problem};
use crate::text;

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
