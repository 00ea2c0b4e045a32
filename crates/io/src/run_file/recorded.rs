//! What a run file says about its run, read back.

use std::path::Path;

use plateau_core::model::material::Status;
use plateau_core::model::state::Base;
use plateau_core::observe::{EXTRAS, Map};

use super::{Header, InputFile, ReadError, RunFile};
use crate::text::{short, shown_title};

impl Header {
    /// The header of a file that is there.
    ///
    /// # Errors
    /// [`ReadError::Damaged`] when something is missing or is no longer what was written.
    pub(super) fn of(run: &RunFile) -> Result<Self, ReadError> {
        let damaged = |reason: String| ReadError::of_library(run.path(), reason);
        let text = |name: &str| run.attribute(name).ok_or_else(|| damaged(format!("it has no {name}")));
        let has = |name: &str| run.series().iter().any(|series| series.name == name);
        let base = run.bases()?.ok_or_else(|| damaged("it has no base of the pin".to_owned()))?;
        let seeds: serde_json::Map<String, serde_json::Value> = json(run.path(), "seeds", &text("seeds")?)?;
        let inputs: Vec<InputFile> = json(run.path(), "inputs", &text("inputs")?)?;
        let seeds = seeds.into_iter().map(|(key, seed)| {
            let number = seed.as_u64();
            number
                .map(|number| (key.clone(), number))
                .ok_or_else(|| damaged(format!("the seed of {} is {}", short(&key), short(&seed.to_string()))))
        });
        Ok(Self {
            title: run.title().to_owned(),
            mesh: run.mesh().clone(),
            pin_base: base,
            maps: Map::ALL.into_iter().filter(|map| run.has_map(*map)).collect(),
            extras: EXTRAS.iter().copied().filter(|extra| has(extra.quantities[0].name)).collect(),
            expected_samples: run.time().len() as u64,
            scene: text("scene")?,
            program: text("program")?,
            source_revision: text("source_revision")?,
            host: text("host")?,
            workers: run.number("workers").ok_or_else(|| damaged("it has no workers".to_owned()))? as usize,
            instruction_set: text("instruction_set")?,
            seeds: seeds.collect::<Result<_, _>>()?,
            inputs,
            surfaces: text("surfaces")?.lines().map(str::to_owned).collect(),
        })
    }
}

impl RunFile {
    /// Base of every pin cell, column by column, resin beyond the pin's outline; nothing if it was not recorded.
    ///
    /// # Errors
    /// As for [`pin_base`](Self::pin_base).
    pub(super) fn bases(&self) -> Result<Option<Vec<Base>>, ReadError> {
        let of = |base: u8| if base == Status::Primary as u8 { Base::Primary } else { Base::Resin };
        Ok(self.pin_base()?.map(|found| found.into_iter().map(of).collect()))
    }
}

fn json<T: serde::de::DeserializeOwned>(path: &Path, name: &str, text: &str) -> Result<T, ReadError> {
    serde_json::from_str(text)
        .map_err(|error| ReadError::of_library(path, format!("its {name}: {}", shown_title(&error.to_string()))))
}
