//! All results of a study: what came of its runs, and one file of them.

mod file;
mod results;

pub use super::record::unit_of;
pub use file::{error_name, finished, is_collected};
pub use results::{CollectError, Collected, CollectedRun, State};
