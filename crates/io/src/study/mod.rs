//! Studies: many runs of one scene with other values of some keys, and what is asked of them (docs/study.md).
//!
//! ```text
//! study file     document       the text, with places
//!                keys, build    from its keys to a Study
//!                factor, response   values of the factors; questions to the series of a run, what series need, bounds of responses
//!                value_table    points of a design in a table
//!                plan           the Study; the design, its points and replicates -> the runs, each a list of --set arguments
//! results        record         what a result is the result of, and what is kept of it
//!                journal        where records are kept while many processes make them
//!                results        all of them, and as text, a line for each run
//!                results_file   all of them in one HDF5 file
//! ```

mod build;
mod document;
pub mod factor;
pub mod journal;
mod keys;
pub mod plan;
pub mod record;
pub mod response;
pub mod results;
pub mod results_file;
mod value_table;

pub use plan::{DesignSource, Order, Replicates, Study, StudyError};
