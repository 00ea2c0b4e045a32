//! Responses that come from elsewhere: which run each line of a table is of, and where its values are kept.
//!
//! `columns` tells which column of a table is which, `places` which run a line is of.
//!
//! They are kept in one table, `imported.csv` in the folder of the results, a line for each run that has any: factors in SI
//! units, the replicate, and the responses. It is replaced as a whole by who has claimed it, one process at a time, and the new one is
//! on the disk before it has the name of the old one. Lines belong to points, not to numbers of runs: levels that are added later move no value.
//! Lines of points and columns of responses that the study does not have now stay in it, and are there again when the study has them again.

mod columns;
mod places;

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use super::Study;
use super::factor::Factor;
use super::level::Level;
use super::plan::Plan;
use super::value_table::ValueTable;
use crate::claim::{Claim, ClaimError};
use crate::regular;
use crate::temporary::Temporary;
use crate::text::{cell, short};
use columns::Columns;
use places::Places;

/// What the column of replicates is called.
const REPLICATE: &str = "replicate";
/// How long is waited for other processes that take in values, and how long between two looks.
const PATIENCE: Duration = Duration::from_secs(30);
const PAUSE: Duration = Duration::from_millis(20);

/// The values of imported responses, by run (in the order of the design) and response of the study; NaN where there is none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Imported {
    values: Vec<Vec<f64>>,
    idle: Idle,
}

/// What was measured and belongs to nothing that the study has now.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct Idle {
    /// Heads of columns that are of no factor and of no imported response.
    heads: Vec<String>,
    /// The cells in these columns, by run.
    cells: BTreeMap<usize, Vec<String>>,
    /// Cells of the lines that are of no run, in the order of the table that is kept.
    lines: Vec<Vec<String>>,
}

/// What a table brought.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Taken {
    /// Lines of the table.
    pub lines: usize,
    /// Names of the responses in it.
    pub responses: Vec<String>,
    /// Values that were not there before.
    pub new: usize,
    /// Values that were there and have changed.
    pub changed: usize,
    /// Runs of the study that have all imported responses now.
    pub complete: usize,
    /// What is kept of points and responses that the study does not have now, in words.
    pub idle: Vec<String>,
}

impl Imported {
    /// The values of a study, as far as there are any.
    ///
    /// # Errors
    /// What is wrong with the table in the folder of the results.
    pub fn read(plan: &Plan) -> Result<Self, String> {
        let responses = plan.study().responses.len();
        let mut imported = Self { values: vec![vec![f64::NAN; responses]; plan.runs()], idle: Idle::default() };
        let path = file(plan.study());
        // A link that leads nowhere is no table that is not there yet.
        if fs::symlink_metadata(&path).is_err_and(|error| error.kind() == ErrorKind::NotFound) {
            return Ok(imported);
        }
        let table = ValueTable::read(&path)?;
        let columns = Columns::of(&table, plan.study(), true)?;
        let (mut places, wanted) = (Places::new(plan), wanted(plan.study()));
        imported.idle.heads = columns.others.iter().map(|column| table.heads()[*column].clone()).collect();
        for row in table.rows() {
            let key = columns.key(&table, row, plan.study(), &places)?;
            match key.and_then(|key| places.take(&key)) {
                Some(run) => {
                    columns.put(&table, row, &mut imported.values[run])?;
                    imported.idle.cells.insert(run, columns.other_cells(&table, row).collect());
                }
                None => imported.idle.lines.push(columns.kept_cells(&table, row, plan.study(), &wanted)?),
            }
        }
        Ok(imported)
    }

    /// What was measured at points and of responses that the study does not have now, in words: each line by its point.
    pub fn idle(&self, study: &Study) -> Vec<String> {
        let Idle { heads, cells, lines } = &self.idle;
        let factors: Vec<String> = study.factors.iter().map(|factor| with_unit(&factor.name, factor.unit())).collect();
        let line = |cells: &Vec<String>| {
            let point = factors.iter().zip(cells).map(|(head, cell)| format!("{head} = {cell}"));
            format!("line of {}", point.collect::<Vec<_>>().join(", "))
        };
        let is_filled = |at: usize| cells.values().any(|cells| cells.get(at).is_some_and(|cell| !cell.is_empty()));
        let columns = heads.iter().enumerate().filter(|(at, _)| is_filled(*at));
        lines.iter().map(line).chain(columns.map(|(_, head)| format!("column \"{}\"", short(head)))).collect()
    }

    /// The value of a run, by its place in the design, and of a response; NaN where there is none.
    pub fn value(&self, run: usize, response: usize) -> f64 {
        self.values.get(run).and_then(|values| values.get(response)).copied().unwrap_or(f64::NAN)
    }

    /// Takes in a table, and keeps the values. Values that are there and differ are replaced if asked to, else refused.
    ///
    /// # Errors
    /// A line that fits no point of the design, a wrong value, a value that is there already, each with its line; or that the
    /// values cannot be kept.
    pub fn take_in(plan: &Plan, path: &Path, replace: bool) -> Result<Taken, String> {
        let study = plan.study();
        let table = ValueTable::read(path)?;
        let columns = Columns::of(&table, study, false)?;
        if regular::is_one_of(&file(study), &study.files) {
            return Err(format!(
                "{}: it is an input of the study, and imported values would be kept in its place; give the study another directory",
                file(study).display()
            ));
        }
        if !study.directory.exists() {
            // A table with a mistake in it leaves no folder.
            Self::with(plan, &table, &columns, replace)?;
            let made = fs::create_dir_all(&study.directory);
            made.map_err(|error| format!("cannot make the folder {}: {error}", study.directory.display()))?;
        }
        // What another process takes in meanwhile is read before anything is added to it.
        let _claim = claim(&file(study))?;
        let (imported, new, changed) = Self::with(plan, &table, &columns, replace)?;
        imported.write(plan).map_err(|error| format!("cannot write {}: {error}", file(study).display()))?;
        let wanted = wanted(study);
        let is_complete = |values: &&Vec<f64>| wanted.iter().all(|at| !values[*at].is_nan());
        let complete = imported.values.iter().filter(is_complete).count();
        let responses =
            columns.responses.iter().map(|(_, response, _)| study.responses[*response].name.clone()).collect();
        let idle = imported.idle(study);
        Ok(Taken { lines: table.rows().len(), responses, new, changed, complete, idle })
    }

    /// What is there with the values of a table; how many of these are new, and how many have changed.
    fn with(plan: &Plan, table: &ValueTable, columns: &Columns, replace: bool) -> Result<(Self, usize, usize), String> {
        let study = plan.study();
        let mut imported = Self::read(plan)?;
        let mut places = Places::new(plan);
        let (mut new, mut changed) = (0, 0);
        for row in table.rows() {
            let place = table.place(row);
            let key = columns.key(table, row, study, &places)?;
            let key = key.ok_or_else(|| format!("{place}: {}", columns.misfit(table, row, study, &places)))?;
            let run = places.take(&key).ok_or_else(|| {
                format!(
                    "{place}: the design has this point {}, and lines before have it as often; several specimens of a point: \
                     design = \"csv\" with this table as its file",
                    times(places.count(&key))
                )
            })?;
            let mut values = imported.values[run].clone();
            columns.put(table, row, &mut values)?;
            for (before, now) in imported.values[run].iter().zip(&values) {
                // NaN is not there, so it differs from whatever comes.
                if before.is_nan() && !now.is_nan() {
                    new += 1;
                } else if !before.is_nan() && before != now {
                    changed += 1;
                    if !replace {
                        return Err(format!(
                            "{place}: {before} was imported before and {now} differs; --force replaces it"
                        ));
                    }
                }
            }
            imported.values[run] = values;
        }
        Ok((imported, new, changed))
    }

    /// Keeps all values in a file of its own: a link of that name is replaced, and what it leads to is not touched.
    fn write(&self, plan: &Plan) -> io::Result<()> {
        let study = plan.study();
        let target = file(study);
        Temporary::remove_abandoned(&target);
        let (temporary, mut file) = Temporary::create(&target)?;
        let mut writer = csv::Writer::from_writer(Vec::new());
        let wanted = wanted(study);
        let mut head: Vec<String> = study.factors.iter().map(|factor| with_unit(&factor.name, factor.unit())).collect();
        head.push(REPLICATE.to_owned());
        head.extend(wanted.iter().map(|at| with_unit(&study.responses[*at].name, study.responses[*at].unit(""))));
        head.extend(self.idle.heads.iter().cloned());
        let width = head.len();
        writer.write_record(head.iter().map(|text| cell(text).into_owned()))?;
        for (place, values) in self.values.iter().enumerate() {
            let others = self.idle.cells.get(&place).map_or(&[][..], Vec::as_slice);
            if wanted.iter().all(|at| values[*at].is_nan()) && others.iter().all(String::is_empty) {
                continue;
            }
            let run = plan.run(place + 1);
            let level = |(factor, level): (&Factor, &Level)| {
                let number = level.number.filter(|_| !["", "1"].contains(&factor.unit()));
                number.map_or_else(|| level.label.clone(), |number| format!("{number:?}"))
            };
            let mut cells: Vec<String> = study.factors.iter().zip(&run.levels).map(level).collect();
            cells.push((run.replicate + 1).to_string());
            cells.extend(
                wanted.iter().map(|at| if values[*at].is_nan() { String::new() } else { format!("{:?}", values[*at]) }),
            );
            cells.extend(others.iter().cloned());
            cells.resize(width, String::new());
            writer.write_record(cells.iter().map(|text| cell(text).into_owned()))?;
        }
        for cells in &self.idle.lines {
            writer.write_record(cells.iter().map(|text| cell(text).into_owned()))?;
        }
        file.write_all(&writer.into_inner().map_err(|error| io::Error::other(error.to_string()))?)?;
        file.sync_all()?;
        temporary.publish_durably()
    }
}

/// The right to write the table, for which is waited while others have it: they take a moment.
fn claim(path: &Path) -> Result<Claim, String> {
    let start = Instant::now();
    loop {
        match Claim::of(path) {
            Err(ClaimError::Here { .. } | ClaimError::Elsewhere { .. }) if start.elapsed() < PATIENCE => {
                thread::sleep(PAUSE);
            }
            claim => return claim.map_err(|error| error.to_string()),
        }
    }
}

/// The imported ones among the responses of a study.
fn wanted(study: &Study) -> Vec<usize> {
    (0..study.responses.len()).filter(|at| study.responses[*at].is_imported()).collect()
}

/// Where a study keeps them.
pub fn file(study: &Study) -> PathBuf {
    study.directory.join("imported.csv")
}

/// The head of a column: the name, and the unit in brackets if there is one.
pub fn with_unit(name: &str, unit: &str) -> String {
    if ["", "1"].contains(&unit) { name.to_owned() } else { format!("{name} [{unit}]") }
}

fn times(count: usize) -> String {
    if count == 1 { "once".to_owned() } else { format!("{count} times") }
}
