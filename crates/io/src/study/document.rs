//! A study file as it stands in the text (formats.md).

use serde::Deserialize;
use toml::{Spanned, Value};

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    pub version: Spanned<i64>,
    pub title: Option<String>,
    pub base: Spanned<String>,
    #[serde(default)]
    pub set: Vec<Spanned<String>>,
    pub design: Spanned<String>,
    pub resolution: Option<Spanned<u32>>,
    pub generators: Option<Spanned<Vec<String>>>,
    pub points: Option<Spanned<usize>>,
    pub alpha: Option<Spanned<String>>,
    pub centre_points: Option<Spanned<usize>>,
    pub file: Option<Spanned<String>>,
    pub order: Option<Spanned<String>>,
    pub seed: Option<Spanned<u64>>,
    pub replicates: Option<Replicates>,
    pub directory: Option<String>,
    pub series: Option<Vec<Spanned<String>>>,
    #[serde(default)]
    pub factor: Vec<Factor>,
    #[serde(default)]
    pub response: Vec<Response>,
}

/// `[replicates]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Replicates {
    pub keys: Spanned<Vec<Spanned<String>>>,
    pub seeds: Spanned<Vec<Spanned<i64>>>,
}

/// `[[factor]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Factor {
    pub name: Option<Spanned<String>>,
    pub key: Spanned<Keys>,
    pub levels: Option<Spanned<Vec<Spanned<Value>>>>,
    pub range: Option<Spanned<[Spanned<Value>; 2]>>,
    pub scale: Option<Spanned<String>>,
}

/// One key path, or several that are always set alike.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Keys(pub Vec<String>);

impl<'de> Deserialize<'de> for Keys {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = || serde::de::Error::custom("expected a key path such as \"operation.normal_force\", or a list");
        match Value::deserialize(deserializer)? {
            Value::String(key) => Ok(Self(vec![key])),
            Value::Array(keys) if !keys.is_empty() => {
                let keys = keys.iter().map(|key| key.as_str().map(str::to_owned));
                keys.collect::<Option<_>>().map(Self).ok_or_else(expected)
            }
            _ => Err(expected()),
        }
    }
}

/// `[[response]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Response {
    pub name: Spanned<String>,
    pub dataset: Spanned<String>,
    pub at: Option<Spanned<String>>,
    pub mean: Option<Spanned<[Spanned<String>; 2]>>,
    pub reaches: Option<Spanned<f64>>,
}
