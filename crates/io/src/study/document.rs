//! A study file as it stands in the text (docs/studies.md).

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use toml::{Spanned, Value};

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    pub version: Spanned<i64>,
    pub title: Option<String>,
    pub base: Option<Spanned<String>>,
    #[serde(default)]
    pub set: Vec<Spanned<String>>,
    pub design: Spanned<String>,
    pub resolution: Option<Spanned<u32>>,
    pub generators: Option<Spanned<Vec<String>>>,
    pub points: Option<Spanned<usize>>,
    pub trajectories: Option<Spanned<usize>>,
    pub levels: Option<Spanned<usize>>,
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
    #[expect(dead_code, reason = "`plateau fit` reads it")]
    pub fit: Option<IgnoredAny>,
}

/// `[replicates]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Replicates {
    pub keys: Option<Spanned<Vec<Spanned<String>>>>,
    pub seeds: Spanned<Vec<Spanned<i64>>>,
}

/// `[[factor]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Factor {
    pub name: Option<Spanned<String>>,
    /// Absent of a factor that is set elsewhere, as on a rig.
    pub key: Option<Spanned<Keys>>,
    pub levels: Option<Spanned<Vec<Spanned<Value>>>>,
    pub range: Option<Spanned<[Spanned<Value>; 2]>>,
    pub scale: Option<Spanned<String>>,
}

/// One key path, or several that are always set alike.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Keys(pub Vec<String>);

impl<'de> Deserialize<'de> for Keys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = || Error::custom("expected a key path such as \"operation.normal_force\", or a list");
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
    pub dataset: Option<Spanned<String>>,
    pub imported: Option<Spanned<bool>>,
    pub unit: Option<Spanned<String>>,
    pub transform: Option<Spanned<String>>,
    pub at: Option<Spanned<String>>,
    pub mean: Option<Spanned<Mean>>,
    pub reaches: Option<Spanned<f64>>,
    pub event: Option<Spanned<Value>>,
    #[expect(dead_code, reason = "`plateau fit` reads it")]
    pub measured: Option<IgnoredAny>,
    #[expect(dead_code, reason = "`plateau fit` reads it")]
    pub uncertainty: Option<IgnoredAny>,
    pub measured_file: Option<Spanned<String>>,
    #[expect(dead_code, reason = "`plateau fit` reads it")]
    pub correlation_time: Option<IgnoredAny>,
}

/// Over what a mean is taken.
#[derive(Debug)]
pub(super) enum Mean {
    /// `"last tenth"`.
    LastTenth,
    /// From one time to another.
    Between([Spanned<String>; 2]),
}

impl<'de> Deserialize<'de> for Mean {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(MeanVisitor)
    }
}

struct MeanVisitor;

impl<'de> Visitor<'de> for MeanVisitor {
    type Value = Mean;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"last tenth\", or two times such as [\"50 s\", \"100 s\"]")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Mean, E> {
        if text == "last tenth" {
            Ok(Mean::LastTenth)
        } else {
            Err(E::invalid_value(serde::de::Unexpected::Str(text), &self))
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut times: A) -> Result<Mean, A::Error> {
        let mut next = |count| times.next_element()?.ok_or_else(|| A::Error::invalid_length(count, &MeanVisitor));
        let between = [next(0)?, next(1)?];
        match times.next_element::<Spanned<String>>()? {
            None => Ok(Mean::Between(between)),
            Some(_) => Err(A::Error::invalid_length(3, &self)),
        }
    }
}
