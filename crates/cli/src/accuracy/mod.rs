//! What `plateau accuracy` found, as tables and sentences, CSV and JSON; it is found by [`plateau_run::accuracy`].

mod documents;
mod text;

pub use documents::{Making, csv, json};
pub use text::text;
