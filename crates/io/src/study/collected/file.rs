//! All results of a study in one file: the design, the responses, and the series of all runs side by side.
//!
//! ```text
//! run                          number of the run, from 1
//! point, replicate, state      (run)
//! one for each factor          (run), in SI units, or a word
//! one for each response        (run), NaN where a run gives none; of a mean contact area with its standard error
//! one for each series          (run, time); or (run, sample), where the times of the samples differ from run to run
//! ```

use std::collections::BTreeSet;
use std::path::Path;

use hdf5::types::VarLenUnicode;
use plateau_core::observe::{EXTRAS, quantities};

use super::super::plan::{Plan, Run};
use super::super::record::unit_of;
use super::results::{CollectError, Collected, CollectedRun, State, series};
use crate::dataset_file::{Attribute, Content, Coordinate, Name, Rows, Values, Variable, write_rows};

/// Where runs have samples at different times.
const TIME_OF_SAMPLE: &str = "sample_time";

impl Collected {
    /// Writes all of it as one HDF5 file; `attributes` tell where it comes from.
    ///
    /// # Errors
    /// [`CollectError`], after which nothing has changed at `path`.
    pub fn write(
        &self,
        path: &Path,
        replace: bool,
        plan: &Plan,
        attributes: Vec<(&'static str, Attribute)>,
    ) -> Result<(), CollectError> {
        let content = self.content(plan, attributes);
        write_rows(path, replace, &content, |rows| self.give(rows, &content))
    }

    fn give(&self, rows: &Rows<'_>, content: &Content) -> Result<(), CollectError> {
        let wanted: Vec<&str> = content
            .variables
            .iter()
            .filter(|variable| variable.values == Values::Rows)
            .map(|variable| variable.name.as_ref())
            .collect();
        for (row, run) in self.runs.iter().enumerate() {
            let Some(series) = run.entry.as_ref().map(series).transpose()?.flatten() else { continue };
            for name in &wanted {
                let values = if *name == TIME_OF_SAMPLE { Some(series.time()) } else { series.values(name) };
                values.map_or(Ok(()), |values| rows.put(name, row, values))?;
            }
        }
        Ok(())
    }

    fn content(&self, plan: &Plan, attributes: Vec<(&'static str, Attribute)>) -> Content {
        let study = plan.study();
        let numbers =
            |value: fn(&Run) -> usize| Values::Integer(self.runs.iter().map(|run| value(&run.run) as i64).collect());
        let text = |value: fn(&CollectedRun) -> String| Values::Text(self.runs.iter().map(value).collect());
        let (common, along) = self.samples();
        let mut content = Content {
            attributes,
            dimensions: vec![coordinate("run", "1", "number of the run", (1..=self.runs.len()).map(|run| run as f64))],
            variables: vec![
                variable("point", "1", "point of the design", numbers(|run| run.point + 1)),
                variable("replicate", "1", "replicate of the point", numbers(|run| run.replicate + 1)),
                variable(
                    "state",
                    "",
                    "how the run ended: finished, failed or missing",
                    text(|run| run.state.name().into()),
                ),
                variable(
                    "error",
                    "",
                    "why the run failed",
                    text(|run| if let State::Failed(error) = &run.state { error.clone() } else { String::new() }),
                ),
                variable(
                    "wall_time",
                    "s",
                    "wall time of the run",
                    Values::Float(self.runs.iter().map(|run| run.wall_time).collect()),
                ),
            ],
        };
        let mut names = Names::new(&content, &along);
        for (at, factor) in study.factors.iter().enumerate() {
            let levels = || self.runs.iter().map(|run| &run.run.levels[at]);
            let values = match levels().map(|level| level.number).collect() {
                Some(numbers) => Values::Float(numbers),
                None => Values::Text(levels().map(|level| level.label.clone()).collect()),
            };
            let unit = if matches!(values, Values::Float(_)) { factor.unit() } else { "" };
            let meaning = format!("{}: {}", factor.name, factor.keys_in_words());
            content.variables.push(variable(names.free(&factor.name, "factor"), unit, meaning, values));
        }
        for (at, response) in study.responses.iter().enumerate() {
            let values = self.runs.iter().map(|run| run.responses[at]).collect();
            let unit = response.unit(unit_of(&response.series));
            let origin = if response.is_imported() { "imported".to_owned() } else { format!("of {}", response.series) };
            let meaning = format!("{} ({origin})", response.name);
            content.variables.push(variable(
                names.free(&response.name, "response"),
                unit,
                meaning,
                Values::Float(values),
            ));
            if response.has_error() {
                let values = Values::Float(self.runs.iter().map(|run| run.errors[at]).collect());
                let name = names.free(&error_name(&response.name), "response");
                content.variables.push(variable(name, unit, format!("standard error of {}", response.name), values));
            }
        }
        match common {
            Some(time) => content.dimensions.push(coordinate("time", "s", "time of the samples", time.iter().copied())),
            None => {
                let longest = self.runs.iter().map(|run| run.time.len()).max().unwrap_or(0);
                let places = (1..=longest).map(|sample| sample as f64);
                content.dimensions.push(coordinate("sample", "1", "number of the sample", places));
                content.variables.push(rows(TIME_OF_SAMPLE, "s", "time of the sample", "sample"));
            }
        }
        let along_samples = if common.is_some() { "time" } else { "sample" };
        for quantity in quantities(EXTRAS).filter(|quantity| along.contains(quantity.name)) {
            content.variables.push(rows(quantity.name, quantity.unit, quantity.long_name, along_samples));
        }
        content
    }

    /// The times of the samples, if they are those of all runs, and the names of all series.
    fn samples(&self) -> (Option<&[f64]>, BTreeSet<&str>) {
        let mut finished = self.runs.iter().filter(|run| run.state == State::Finished && run.entry.is_some());
        let series = finished.clone().flat_map(|run| run.series.iter().map(String::as_str)).collect();
        let first = finished.next().map_or(&[][..], |run| &run.time);
        (finished.all(|run| run.time == first).then_some(first), series)
    }
}

/// Whether a file is one that was collected from a study.
pub fn is_collected(path: &Path) -> bool {
    let has = |file: &hdf5::File, name: &str| file.attr(name).is_ok();
    path.is_file() && hdf5::File::open(path).is_ok_and(|file| has(&file, "design") && has(&file, "collected"))
}

/// How many runs of a collected file finished; none where it does not say.
pub fn finished(path: &Path) -> Option<usize> {
    let file = hdf5::File::open(path).ok()?;
    let states = file.dataset("state").ok()?.read_raw::<VarLenUnicode>().ok()?;
    Some(states.iter().filter(|state| state.as_str() == State::Finished.name()).count())
}

fn coordinate(
    name: &'static str,
    unit: &'static str,
    long_name: &'static str,
    values: impl Iterator<Item = f64>,
) -> Coordinate {
    Coordinate { name, unit: unit.into(), long_name: long_name.into(), values: values.collect() }
}

fn variable(name: impl Into<Name>, unit: &str, long_name: impl Into<Name>, values: Values) -> Variable {
    let unit = unit.to_owned().into();
    Variable { name: name.into(), dimensions: vec!["run"], unit, long_name: long_name.into(), values }
}

fn rows(name: &'static str, unit: &'static str, long_name: &'static str, along: &'static str) -> Variable {
    Variable { dimensions: vec!["run", along], ..variable(name, unit, long_name, Values::Rows) }
}

/// Names of variables, each given once.
struct Names(BTreeSet<String>);

impl Names {
    fn new(content: &Content, series: &BTreeSet<&str>) -> Self {
        let own = ["run", "time", "sample", TIME_OF_SAMPLE].into_iter().chain(series.iter().copied());
        let known = content.variables.iter().map(|variable| variable.name.to_string());
        Self(own.map(str::to_owned).chain(known).collect())
    }

    /// A name as programs want it; with what it is added where it is taken.
    fn free(&mut self, name: &str, what: &str) -> String {
        let mut free = plain(name);
        while !self.0.insert(free.clone()) {
            free = format!("{free}_{what}");
        }
        free
    }
}

/// What the standard error of a response is called.
pub fn error_name(response: &str) -> String {
    format!("{response} standard error")
}

/// Letters, digits and underscores: `contact area at the end` becomes `contact_area_at_the_end`.
fn plain(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
    let plain = plain.trim_matches('_').to_lowercase();
    if plain.starts_with(|c: char| c.is_ascii_digit()) || plain.is_empty() { format!("_{plain}") } else { plain }
}
