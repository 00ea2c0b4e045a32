//! The results of a study as a table of text: a line for each run, units in the head: those in which the study states its factors,
//! and SI units of responses.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use super::collected::{Collected, CollectedRun, State, error_name};
use super::level::Level;
use super::plan::Plan;
use super::record::unit_of;

/// What the first columns of every table are called.
const FIRST: [&str; 4] = ["run", "point", "replicate", "state"];

/// A column: its head and a cell for each run.
struct Column {
    head: String,
    cells: Vec<String>,
}

/// Head and lines: number, point, replicate and state of each run, its factors and responses, and why it failed.
///
/// Quantities are numbers in the unit that stands behind the name, as in `speed [rpm]`: in that of the study, if it states all
/// levels of a factor in one, or in SI units; words, and numbers without a unit, stand
/// as the study has them. A response that a run does not give is an empty cell; one that no run gives by itself has no column. A response that has a standard error is
/// followed by it.
pub fn table(plan: &Plan, collected: &Collected) -> Vec<Vec<String>> {
    let study = plan.study();
    let mut names = Names::default();
    let mut column = |name: &str, what: &str, unit: &str, cell: &dyn Fn(&CollectedRun) -> String| Column {
        head: names.head(name, what, unit),
        cells: collected.runs.iter().map(cell).collect(),
    };
    let mut columns = vec![
        column(FIRST[0], "", "", &|run| run.run.number.to_string()),
        column(FIRST[1], "", "", &|run| (run.run.point + 1).to_string()),
        column(FIRST[2], "", "", &|run| (run.run.replicate + 1).to_string()),
        column(FIRST[3], "", "", &|run| run.state.name().to_owned()),
    ];
    // The last column; its name is nobody else's.
    let error = column("error", "", "", &|run| match &run.state {
        State::Failed(error) => error.clone(),
        State::Finished | State::Missing => String::new(),
    });
    for (at, factor) in study.factors.iter().enumerate() {
        let levels: Option<Vec<&Level>> = collected.runs.iter().map(|run| run.run.levels.get(at)).collect();
        let levels = levels.filter(|levels| levels.iter().all(|level| level.number.is_some()));
        let is_quantity = !["", "1"].contains(&factor.unit()) && levels.is_some();
        let stated = levels.and_then(|levels| stated_unit(&levels)).filter(|_| is_quantity);
        let unit = stated.unwrap_or(if is_quantity { factor.unit() } else { "" });
        columns.push(column(&factor.name, "factor", unit, &|run| {
            let level = run.run.levels.get(at);
            let number = |level: &Level| if stated.is_some() { Some(level.split()?.0) } else { level.number };
            level
                .and_then(number)
                .filter(|_| is_quantity)
                .map_or_else(|| level.map_or_else(String::new, |level| level.label.clone()), exactly)
        }));
    }
    for (at, response) in study.responses.iter().enumerate().filter(|(_, response)| response.is_of_one_run()) {
        let unit = response.unit(unit_of(&response.series));
        columns.push(column(&response.name, "response", if unit == "1" { "" } else { unit }, &|run| {
            run.responses
                .get(at)
                .filter(|response| !response.is_nan())
                .map_or_else(String::new, |value| exactly(*value))
        }));
        if response.has_error() {
            columns.push(column(
                &error_name(&response.name),
                "response",
                if unit == "1" { "" } else { unit },
                &|run| {
                    run.errors.get(at).filter(|error| !error.is_nan()).map_or_else(String::new, |error| exactly(*error))
                },
            ));
        }
    }
    columns.push(error);
    let head = columns.iter().map(|column| column.head.clone()).collect();
    let line = |run: usize| columns.iter().map(|column| column.cells[run].clone()).collect();
    std::iter::once(head).chain((0..collected.runs.len()).map(line)).collect()
}

/// Whether a file is such a table, as far as its first columns tell.
pub fn is_results_table(path: &Path) -> bool {
    let first = format!("{},", FIRST.join(","));
    let mut found = vec![0; first.len()];
    let read = path.is_file().then(|| File::open(path).and_then(|mut file| file.read_exact(&mut found)));
    read.is_some_and(|read| read.is_ok()) && found == first.as_bytes()
}

/// The unit in which all of some levels are stated, if it is one.
fn stated_unit<'a>(levels: &[&'a Level]) -> Option<&'a str> {
    let unit = |level: &&'a Level| level.split().map(|(_, unit)| unit).filter(|unit| !unit.is_empty());
    let first = unit(levels.first()?)?;
    levels.iter().all(|level| unit(level) == Some(first)).then_some(first)
}

/// How many runs of such a table finished; none where it does not say.
pub fn finished(path: &Path) -> Option<usize> {
    let place = FIRST.iter().position(|name| *name == "state")?;
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(path).ok()?;
    let has_finished = |row: &csv::ByteRecord| row.get(place) == Some(State::Finished.name().as_bytes());
    Some(reader.byte_records().map_while(Result::ok).filter(has_finished).count())
}

/// A number with all its digits.
fn exactly(number: f64) -> String {
    format!("{number:?}")
}

/// Heads of columns, each given once.
#[derive(Default)]
struct Names(BTreeSet<String>);

impl Names {
    /// Name and unit; where that is taken, with what it is behind the name.
    fn head(&mut self, name: &str, what: &str, unit: &str) -> String {
        let behind = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        let mut name = name.to_owned();
        while !self.0.insert(format!("{name}{behind}")) {
            name = format!("{name} ({what})");
        }
        format!("{name}{behind}")
    }
}

#[cfg(test)]
mod tests {
    use super::{Level, Names, stated_unit};

    #[test]
    fn levels_in_one_unit_have_that_of_the_study() {
        let unit = |texts: [&str; 2]| {
            let levels = texts.map(|text| Level::parse("operation.rotational_speed", text));
            stated_unit(&levels.each_ref()).map(str::to_owned)
        };
        assert_eq!(unit(["425 rpm", "8.5e2 rpm"]).as_deref(), Some("rpm"));
        assert_eq!(
            [unit(["425 rpm", "89 rad/s"]), unit(["425", "850"]), unit(["none", "425 rpm"])],
            [None, None, None]
        );
    }

    #[test]
    fn heads_have_units_and_differ() {
        let mut names = Names::default();
        let heads = [
            names.head("state", "", ""),
            names.head("load", "factor", "N"),
            names.head("state", "factor", ""),
            names.head("load", "response", "N"),
            names.head("load", "response", "m2"),
        ];
        assert_eq!(heads, ["state", "load [N]", "state (factor)", "load (response) [N]", "load [m2]"]);
    }
}
