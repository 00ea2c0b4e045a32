//! Studies: many runs of one scene with other values of some keys, and what is asked of them (docs/study.md).
//!
//! ```text
//! study file     document       the text, with places
//!                factor_keys, response_keys, build  from its keys to a Study (contents)
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
mod contents;
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

use std::path::Path;
use std::sync::Arc;

use document::Document;

use crate::scene::{Locator, Origin, Problem, not_toml};
use crate::{hdf5_file, input, limits};

pub use contents::{DesignSource, Order, Replicates, Study, StudyError};

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
