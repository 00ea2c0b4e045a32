//! All results of a study in one file: the design, the responses, and the series of all runs side by side.
//!
//! ```text
//! run                          number of the run, from 1
//! point, replicate, state      (run)
//! seed                         (run), of the replicate, in a study with several
//! order                        (run), which one it is in the order in which the runs are made
//! same_as                      (run), the first run with the same scene: its own number unless it repeats another one
//! one for each factor          (run), in SI units, or a word; attributes: role = "factor", name, keys, levels (their list in JSON, empty
//!                              for a range), low, high (at the coded values −1 and 1), scale, study_units, study_unit and study_zero
//!                              (one and 0 of these units in SI units), whole
//! one for each response        (run), NaN where a run gives none; of a mean contact area with its standard error; attributes: role =
//!                              "response" or "standard error", name, series, transform, valid_min, valid_max
//! one for each series          (run, time); or (run, sample), where the times of the samples differ from run to run
//! ```
//!
//! Responses, series and all else along `run` have factors, point, replicate and seed as auxiliary coordinates (CF `coordinates`).

use std::collections::BTreeSet;
use std::path::Path;

use hdf5::types::VarLenUnicode;
use plateau_core::observe::{EXTRAS, quantities};

use super::factor::{Factor, Level, Values as FactorValues};
use super::plan::{Plan, Run};
use super::record::unit_of;
use super::response::Response;
use super::results::{CollectError, Collected, CollectedRun, RunStatus, error_name, series};
use crate::dataset_file::{Attribute, Content, Coordinate, Name, Rows, Values, Variable, write_rows};
use crate::units;

/// Dataset of the times of samples where runs have samples at different times.
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
        let is_wanted = |variable: &&Variable| variable.values == Values::Rows;
        let wanted: Vec<&str> = content.variables.iter().filter(is_wanted).map(|variable| &*variable.name).collect();
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
        let texts = |value: fn(&CollectedRun) -> String| Values::Text(self.runs.iter().map(value).collect());
        let (common, along) = self.samples();
        let first = Values::Integer(self.runs.iter().map(|run| run.first as i64 + 1).collect());
        let error =
            |run: &CollectedRun| if let RunStatus::Failed(error) = &run.state { error.clone() } else { String::new() };
        let wall_time = Values::Float(self.runs.iter().map(|run| run.wall_time).collect());
        let order = Values::Integer(order_of(plan));
        let state = texts(|run| run.state.name().into());
        let mut content = Content {
            attributes,
            dimensions: vec![coordinate("run", "1", "number of the run", (1..=self.runs.len()).map(|run| run as f64))],
            variables: vec![
                variable("point", "1", "point of the design", numbers(|run| run.point + 1)),
                variable("replicate", "1", "replicate of the point", numbers(|run| run.replicate + 1)),
                variable("order", "1", "place in the order in which the runs are made", order),
                variable("same_as", "1", "first run with the same scene", first),
                variable("state", "", "how the run ended: finished, failed or missing", state),
                variable("error", "", "why the run failed", texts(error)),
                variable("wall_time", "s", "wall time of the run", wall_time),
            ],
        };
        if let Some(replicates) = &study.replicates {
            let seeds = self.runs.iter().map(|run| replicates.seeds[run.run.replicate]).collect();
            content.variables.push(variable("seed", "1", "seed of the replicate", Values::Integer(seeds)));
        }
        let mut names = Names::new(&content, &along);
        let mut coordinates = vec!["point".to_owned(), "replicate".to_owned()];
        coordinates.extend(study.replicates.is_some().then(|| "seed".to_owned()));
        for (at, factor) in study.factors.iter().enumerate() {
            let levels = || self.runs.iter().map(|run| &run.run.levels[at]);
            let values = match levels().map(|level| level.number).collect() {
                Some(numbers) => Values::Float(numbers),
                None => Values::Text(levels().map(|level| level.label.clone()).collect()),
            };
            let unit = if matches!(values, Values::Float(_)) { factor.unit() } else { "" };
            let meaning = format!("{}: {}", factor.name, factor.keys_in_words());
            let name = names.free(&factor.name, "factor");
            coordinates.push(name.clone());
            let attributes = factor_attributes(factor, levels().collect());
            content.variables.push(Variable { attributes, ..variable(name, unit, meaning, values) });
        }
        for (at, response) in study.responses.iter().enumerate() {
            let values = self.runs.iter().map(|run| run.responses[at]).collect();
            let unit = response.unit(unit_of(&response.series));
            let origin = if response.is_imported() { "imported".to_owned() } else { format!("of {}", response.series) };
            let meaning = format!("{} ({origin})", response.name);
            let name = names.free(&response.name, "response");
            let attributes = response_attributes(response);
            content.variables.push(Variable { attributes, ..variable(name, unit, meaning, Values::Float(values)) });
            if response.has_error() {
                let values = Values::Float(self.runs.iter().map(|run| run.errors[at]).collect());
                let name = names.free(&error_name(&response.name), "response");
                let attributes = vec![("role", text("standard error")), ("name", text(&response.name))];
                let meaning = format!("standard error of {}", response.name);
                content.variables.push(Variable { attributes, ..variable(name, unit, meaning, values) });
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
        let is_coordinate = |variable: &Variable| coordinates.iter().any(|name| *name == variable.name);
        for variable in content.variables.iter_mut().filter(|variable| !is_coordinate(variable)) {
            variable.attributes.push(("coordinates", Attribute::Text(coordinates.join(" "))));
        }
        content
    }

    /// The times of the samples, if they are those of all runs, and the names of all series.
    fn samples(&self) -> (Option<&[f64]>, BTreeSet<&str>) {
        let mut finished = self.runs.iter().filter(|run| run.state == RunStatus::Finished && run.entry.is_some());
        let series = finished.clone().flat_map(|run| run.series.iter().map(String::as_str)).collect();
        let first = finished.next().map_or(&[][..], |run| &run.time);
        (finished.all(|run| run.time == first).then_some(first), series)
    }
}

/// For each run which one it is, from 1, in the order in which they are made.
fn order_of(plan: &Plan) -> Vec<i64> {
    let mut places = vec![0; plan.runs()];
    plan.order().zip(1..).for_each(|(number, place)| places[number - 1] = place);
    places
}

/// Attributes that an analysis has to know of a factor besides its values.
fn factor_attributes(factor: &Factor, found: Vec<&Level>) -> Vec<(&'static str, Attribute)> {
    let (listed, ends, logarithmic): (Vec<&Level>, _, _) = match &factor.values {
        FactorValues::Range { low, high, logarithmic } => (Vec::new(), Some([low, high]), *logarithmic),
        FactorValues::Levels(levels) => {
            let ends = if let [low, high] = levels.as_slice() { Some([low, high]) } else { None };
            (levels.iter().collect(), ends, false)
        }
    };
    let labels: Vec<_> = listed.iter().map(|level| &level.label).collect();
    let mut attributes = vec![
        ("role", text("factor")),
        ("name", text(&factor.name)),
        ("keys", Attribute::Text(factor.keys.join(", "))),
        ("levels", Attribute::Text(serde_json::json!(labels).to_string())),
        ("scale", text(if logarithmic { "logarithmic" } else { "linear" })),
        ("whole", Attribute::Integer(i64::from(factor.is_whole()))),
    ];
    if let Some([Some(low), Some(high)]) = ends.map(|ends| ends.map(|end| end.number)) {
        attributes.extend([("low", Attribute::Number(low)), ("high", Attribute::Number(high))]);
    }
    // Of a range the upper end first: the lower one may be 0, which is so in any unit.
    let range = ends.filter(|_| listed.is_empty()).into_iter().flatten().rev();
    let stated = range.chain(listed.iter().copied()).chain(found);
    if let Some((unit, one, zero)) = stated.filter_map(|level| stated_unit(factor, level)).next() {
        attributes.extend([
            ("study_units", Attribute::Text(unit)),
            ("study_unit", Attribute::Number(one)),
            ("study_zero", Attribute::Number(zero)),
        ]);
    }
    attributes
}

/// The unit in which a value is stated, and what one and 0 of it are in SI units.
fn stated_unit(factor: &Factor, level: &Level) -> Option<(String, f64, f64)> {
    if factor.keys.is_empty() {
        return Some((factor.stated_unit.clone(), 1.0, 0.0));
    }
    let ((number, unit), zero) = (level.split()?, units::zero_of(level.split()?.1));
    let one = (level.number? - zero) / number;
    (one.is_finite() && one > 0.0).then(|| (unit.to_owned(), one, zero))
}

fn response_attributes(response: &Response) -> Vec<(&'static str, Attribute)> {
    let mut attributes = vec![
        ("role", text("response")),
        ("name", text(&response.name)),
        ("series", text(&response.series)),
        ("transform", text(response.transform)),
    ];
    let bounds = response.bounds();
    let limits = [("valid_min", bounds.least), ("valid_max", bounds.most)];
    attributes.extend(
        limits.into_iter().filter(|(_, limit)| limit.is_finite()).map(|(name, limit)| (name, Attribute::Number(limit))),
    );
    attributes
}

fn text(text: &str) -> Attribute {
    Attribute::Text(text.to_owned())
}

/// Tells whether a file is one that was collected from a study.
pub fn is_collected(path: &Path) -> bool {
    let has = |file: &hdf5::File, name: &str| file.attr(name).is_ok();
    path.is_file() && hdf5::File::open(path).is_ok_and(|file| has(&file, "design") && has(&file, "collected"))
}

/// Number of runs of a collected file that finished; none where it does not say.
pub fn finished(path: &Path) -> Option<usize> {
    let file = hdf5::File::open(path).ok()?;
    let states = file.dataset("state").ok()?.read_raw::<VarLenUnicode>().ok()?;
    Some(states.iter().filter(|state| state.as_str() == RunStatus::Finished.name()).count())
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
    let (name, unit, long_name) = (name.into(), unit.to_owned().into(), long_name.into());
    Variable { name, dimensions: vec!["run"], unit, long_name, attributes: Vec::new(), values }
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

/// Letters, digits and underscores: `contact area at the end` becomes `contact_area_at_the_end`.
fn plain(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
    let plain = plain.trim_matches('_').to_lowercase();
    if plain.starts_with(|c: char| c.is_ascii_digit()) || plain.is_empty() { format!("_{plain}") } else { plain }
}
