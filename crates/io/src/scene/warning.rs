//! What is legal in a scene and yet deserves attention.

use std::fmt;

use serde::{Serialize, Serializer};

use super::error::Origin;

/// One thing that a scene can hardly mean: where, which key, what was found, which bound it misses, what to do.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// Where the key was given.
    #[serde(serialize_with = "as_text")]
    pub place: Origin,
    /// Full path of the key.
    pub key: String,
    /// What was found, with its number.
    pub found: String,
    /// The bound that it misses, with its number.
    pub bound: String,
    /// What to do.
    pub advice: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place, key, found, bound, advice } = self;
        write!(f, "{place}: {key}: {found}, {bound}; {advice}")
    }
}

fn as_text<S: Serializer>(place: &Origin, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(place)
}
