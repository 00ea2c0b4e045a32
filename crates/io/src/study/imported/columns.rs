//! The columns of a table of responses from elsewhere: which are of factors, which of responses, and what a line of it says.

use std::collections::{HashMap, HashSet};

use super::places::{Key, Places};
use super::{REPLICATE, with_unit};
use crate::brief;
use crate::study::Study;
use crate::study::factor::Factor;
use crate::study::value_table::{Row, ValueTable};
use crate::text::short;
use crate::units::parse_as;

/// Column of the number of a run, which is passed over.
const RUN: &str = "run";

/// Which columns of a table are which.
pub(super) struct Columns {
    factors: Vec<usize>,
    replicate: Option<usize>,
    /// Columns of responses, with their place in the study and their SI unit.
    pub responses: Vec<(usize, usize, &'static str)>,
    /// All others, of what the study had before; none in a table that is taken in.
    pub others: Vec<usize>,
    /// Whether it is the table that the study keeps.
    kept: bool,
}

impl Columns {
    /// Those of a table; one that is `kept` by the study may have columns of factors and responses that it had before.
    pub fn of(table: &ValueTable, study: &Study, kept: bool) -> Result<Self, String> {
        let at = |what: String| format!("{}: {what}", table.path().display());
        let heads = || table.heads_in_words();
        let factors = table.factor_columns(&study.factors)?;
        let missing = study.factors.iter().zip(&factors).find(|(_, column)| column.is_none());
        if let Some((factor, _)) = missing {
            return Err(at(format!("no column of the factor \"{}\"; it has {}", factor.name, heads())));
        }
        let factors: Vec<usize> = factors.into_iter().flatten().collect();
        let mut columns = Self { factors, replicate: None, responses: Vec::new(), others: Vec::new(), kept };
        let of_responses: HashMap<&str, usize> =
            study.responses.iter().enumerate().rev().map(|(at, response)| (response.name.as_str(), at)).collect();
        let of_factors: HashSet<usize> = columns.factors.iter().copied().collect();
        for column in (0..table.heads().len()).filter(|column| !of_factors.contains(column)) {
            let (name, unit) = table.named(column);
            if name == REPLICATE && unit.is_empty() {
                columns.replicate = Some(column);
                continue;
            }
            let head = &table.heads()[column];
            let known = [name, head.as_str()].into_iter().filter_map(|name| of_responses.get(name)).min().copied();
            let Some(response) = known.filter(|at| study.responses[*at].is_imported()) else {
                // The number of a run, as `plateau sweep plan --csv` writes it.
                if name == RUN {
                    continue;
                }
                if kept {
                    columns.others.push(column);
                    continue;
                }
                let names: Vec<&str> =
                    study.responses.iter().filter(|own| own.is_imported()).map(|own| own.name.as_str()).collect();
                let known = if names.is_empty() { "none".to_owned() } else { brief::list(names, ", ") };
                return Err(at(format!(
                    "column \"{}\" is neither a factor nor a response with imported = true; of these the study has {known}",
                    short(head)
                )));
            };
            let wanted: &'static str = study.responses[response].unit("");
            let unit = if study.responses[response].name == *head { "" } else { unit };
            let measures_the_same = unit == wanted || parse_as(&format!("1 {unit}"), wanted).is_ok();
            if unit.is_empty() && wanted != "1" || !unit.is_empty() && !measures_the_same {
                let and = if wanted == "1" {
                    "for the study gives it no unit"
                } else {
                    "or another unit that measures the same"
                };
                let wanted = with_unit(&study.responses[response].name, wanted);
                return Err(at(format!("column \"{head}\": expected \"{wanted}\", {and}")));
            }
            columns.responses.push((column, response, wanted));
        }
        if columns.responses.is_empty() && !kept {
            return Err(at(format!("no column of a response with imported = true; it has {}", heads())));
        }
        Ok(columns)
    }

    /// Which point a line is of; none where the design has no such level.
    pub fn key(&self, table: &ValueTable, row: &Row, study: &Study, places: &Places) -> Result<Option<Key>, String> {
        let mut found = Vec::new();
        for (at, (factor, column)) in study.factors.iter().zip(&self.factors).enumerate() {
            let level = table.level(row, *column, factor)?;
            let Some(place) = places.find(at, &level) else { return Ok(None) };
            found.push(place);
        }
        if !places.has(&found) {
            return Ok(None);
        }
        let replicate = self.replicate.map(|column| table.number(row, column)).transpose()?.flatten();
        let count = study.replicates.as_ref().map_or(1, |replicates| replicates.seeds.len());
        // The study had more seeds when this was measured.
        if self.kept && replicate.is_some_and(|number| number > count as f64) {
            return Ok(None);
        }
        let replicate = replicate.map(|number| {
            let is_one = number.fract() == 0.0 && (1.0..=count as f64).contains(&number);
            is_one
                .then_some(number as usize - 1)
                .ok_or_else(|| format!("{}: replicate {number}, expected a number from 1 to {count}", table.place(row)))
        });
        Ok(Some((found, replicate.transpose()?)))
    }

    /// A line that is of no point, as it is kept: each factor as the line has it, with its unit where the head of the column has
    /// another one now, the replicate, responses in SI units, and all other cells.
    pub fn kept_cells(
        &self,
        table: &ValueTable,
        row: &Row,
        study: &Study,
        wanted: &[usize],
    ) -> Result<Vec<String>, String> {
        let factor = |(factor, column): (&Factor, &usize)| {
            let (cell, (_, unit)) = (table.cell(row, *column), table.named(*column));
            let is_plain = unit.is_empty() || cell.is_empty() || cell.contains(' ') || unit == factor.unit();
            if is_plain { cell.to_owned() } else { format!("{cell} {unit}") }
        };
        let mut cells: Vec<String> = study.factors.iter().zip(&self.factors).map(factor).collect();
        cells.push(self.replicate.map_or_else(String::new, |column| table.cell(row, column).to_owned()));
        for response in wanted {
            let column = self.responses.iter().find(|(_, own, _)| own == response);
            let number = column.map(|(column, _, unit)| table.quantity(row, *column, unit)).transpose()?.flatten();
            cells.push(number.map_or_else(String::new, |number| format!("{number:?}")));
        }
        cells.extend(self.other_cells(table, row));
        Ok(cells)
    }

    /// The cells of a line in the columns of what the study had before.
    pub fn other_cells<'a>(&'a self, table: &'a ValueTable, row: &'a Row) -> impl Iterator<Item = String> + 'a {
        self.others.iter().map(|column| table.cell(row, *column).to_owned())
    }

    /// Why a line is of no point.
    pub fn misfit(&self, table: &ValueTable, row: &Row, study: &Study, places: &Places) -> String {
        for (at, (factor, column)) in study.factors.iter().zip(&self.factors).enumerate() {
            let Ok(level) = table.level(row, *column, factor) else { continue };
            if places.find(at, &level).is_none() {
                let levels = places.levels(at);
                return format!(
                    "{} = {} is in no point of the design, which has {}",
                    factor.name,
                    short(&level.label),
                    brief::list(levels.iter().map(|level| &level.label), ", ")
                );
            }
        }
        "no point of the design has these levels together; `plateau sweep plan --csv` writes all points".to_owned()
    }

    /// Puts the responses of a line where those of its run are; empty cells change nothing.
    pub fn put(&self, table: &ValueTable, row: &Row, values: &mut [f64]) -> Result<(), String> {
        for (column, response, unit) in &self.responses {
            if let Some(number) = table.quantity(row, *column, unit)? {
                values[*response] = number;
            }
        }
        Ok(())
    }
}
