//! Table of values in CSV: columns of factors and responses, named in the first line, with units as in results.csv; and a design of one's
//! own, the points of such a table.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::factor::{Factor, Level, Values};
use crate::delimited::{self, Fault, Line, Named};
use crate::limits;
use crate::text::{odd_character, short, text_of_cell, too_long};

/// Columns that a message names.
const SHOWN: usize = 12;

#[derive(Debug, Clone, PartialEq)]
struct ValueTable {
    path: PathBuf,
    heads: Vec<String>,
    rows: Vec<Row>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Row {
    /// Number of the line in the file, from 1.
    line: usize,
    cells: Vec<String>,
}

impl ValueTable {
    /// Reads a CSV file of at most so many lines, and at most [`limits::CELLS`] values. Lines that begin with # are passed over.
    fn read(path: &Path, most: usize) -> Result<Self, String> {
        let shown = path.display();
        let text = delimited::read(path, limits::TABLE).map_err(|error| format!("cannot read {shown}: {error}"))?;
        let wrong = |fault: Fault| format!("{shown}:{}: {}", fault.line, fault.message);
        let no_points = || format!("{shown}: no points, expected a line for each");
        let table = Named::of(&text).map_err(wrong)?.ok_or_else(no_points)?;
        let texts = |line: &Line<'_>| line.cells.iter().map(|cell| text_of_cell(&cell.text).to_owned()).collect();
        let heads: Vec<String> = texts(&table.head);
        let mut known = HashSet::with_capacity(heads.len());
        if let Some(twice) = heads.iter().find(|head| !known.insert(head.as_str())) {
            return Err(format!("{shown}: column \"{}\" is there twice", short(twice)));
        }
        let most = most.min(limits::CELLS / heads.len().max(1));
        let mut rows = Vec::new();
        for row in table.rows() {
            let row = row.map_err(wrong)?;
            let line = row.number;
            if rows.len() == most {
                return Err(format!("{shown}:{line}: {}", limits::more("more", most, "points")));
            }
            if row.cells.len() != heads.len() {
                let (found, expected) = (row.cells.len(), heads.len());
                return Err(format!("{shown}:{line}: {found} cells, expected {expected} as in the first line"));
            }
            let cells: Vec<String> = texts(&row);
            let odd = heads.iter().zip(&cells).find_map(|(head, cell)| Some((head, odd_character(cell)?)));
            if let Some((head, found)) = odd {
                return Err(format!("{shown}:{line}: \"{head}\" has {found}; take it out"));
            }
            rows.push(Row { line, cells });
        }
        if rows.is_empty() {
            return Err(no_points());
        }
        Ok(Self { path: path.to_owned(), heads, rows })
    }

    /// Heads of the columns, in words; of many the first.
    fn heads_in_words(&self) -> String {
        let more = self.heads.len().saturating_sub(SHOWN);
        let shown: Vec<_> = self.heads.iter().take(SHOWN).map(|head| short(head)).collect();
        let more = if more > 0 { format!(", … ({more} more)") } else { String::new() };
        format!("{}{more}", shown.join(", "))
    }

    /// Name and unit of a column: `load [N]` is `load` in `N`.
    fn named(&self, column: usize) -> (&str, &str) {
        let head = self.heads[column].as_str();
        let with_unit = head.strip_suffix(']').and_then(|head| head.rsplit_once(" ["));
        with_unit.map_or((head, ""), |(name, unit)| (name.trim(), unit.trim()))
    }

    /// The column of each factor, which names the factor or one of its keys; none where there is none.
    fn factor_columns(&self, factors: &[Factor]) -> Result<Vec<Option<usize>>, String> {
        let mut columns: HashMap<&str, Vec<usize>> = HashMap::with_capacity(self.heads.len());
        for (column, head) in self.heads.iter().enumerate() {
            for name in [head.as_str(), self.named(column).0] {
                let known = columns.entry(name).or_default();
                // Nobody asks for a third.
                if known.len() < 2 && !known.contains(&column) {
                    known.push(column);
                }
            }
        }
        let column = |factor: &Factor| {
            let names = factor.names();
            let own: BTreeSet<usize> = names.filter_map(|name| columns.get(name)).flatten().copied().collect();
            let mut own = own.into_iter();
            match (own.next(), own.next()) {
                (Some(one), Some(other)) => Err(format!(
                    "{}: columns \"{}\" and \"{}\" are of one factor",
                    self.path.display(),
                    self.heads[one],
                    self.heads[other]
                )),
                (column, _) => Ok(column),
            }
        };
        factors.iter().map(column).collect()
    }

    fn level(&self, row: &Row, column: usize, factor: &Factor) -> Result<Level, String> {
        let cell = row.cells[column].as_str();
        if cell.is_empty() {
            return Err(format!("{}: \"{}\" is empty", self.place(row), factor.name));
        }
        if let Some(long) = too_long(cell) {
            return Err(format!("{}: \"{}\": {long}", self.place(row), factor.name));
        }
        let (_, unit) = self.named(column);
        let text = if unit.is_empty() || cell.contains(' ') { cell.to_owned() } else { format!("{cell} {unit}") };
        Ok(factor.parse(&text))
    }

    fn place(&self, row: &Row) -> String {
        format!("{}:{}", self.path.display(), row.line)
    }
}

/// Points of a study, each with one level for every factor.
pub type Points = Vec<Vec<Level>>;

/// Reads a CSV file whose first line names the factors, or the keys that they set; every other line is a point. Columns of what
/// is measured at the points, `others`, may stand beside them.
pub(super) fn read_points(path: &Path, factors: &[Factor], others: &[&str]) -> Result<Points, String> {
    let table = ValueTable::read(path, limits::ROWS)?;
    let shown = path.display();
    let columns = table.factor_columns(factors)?;
    let column = |(factor, column): (&Factor, &Option<usize>)| {
        column.ok_or_else(|| format!("{shown}: no column \"{}\"; it has {}", factor.name, table.heads_in_words()))
    };
    let columns: Vec<usize> = factors.iter().zip(&columns).map(column).collect::<Result<_, _>>()?;
    let (known, others): (HashSet<usize>, HashSet<&str>) =
        (columns.iter().copied().collect(), others.iter().copied().collect());
    let is_other = |at: usize| others.contains(table.heads[at].as_str()) || others.contains(table.named(at).0);
    if let Some(unknown) = (0..table.heads.len()).find(|at| !known.contains(at) && !is_other(*at)) {
        return Err(format!("{shown}: column \"{}\" is not a factor of the study", short(&table.heads[unknown])));
    }
    let mut known: Vec<Spellings> = factors.iter().map(Spellings::of).collect();
    let point = |row: &Row| {
        let level = |((factor, column), known): ((&Factor, &usize), &mut Spellings)| {
            let level = table.level(row, *column, factor)?;
            known.first_spelt(level).map_err(|why| format!("{}: {}: {why}", table.place(row), factor.name))
        };
        factors.iter().zip(&columns).zip(&mut known).map(level).collect::<Result<Vec<Level>, String>>()
    };
    let points = table.rows.iter().map(point).collect::<Result<Points, String>>()?;
    for (at, factor) in factors.iter().enumerate().filter(|(_, factor)| factor.keys.is_empty()) {
        refuse_words(&table, factor, points.iter().map(|point| &point[at]))?;
    }
    Ok(points)
}

/// Refuses what is no number, such as `O.3` or `1e400`, among numbers of a factor without a key, of which no scene tells that it is wrong.
fn refuse_words<'a>(
    table: &ValueTable,
    factor: &Factor,
    levels: impl Iterator<Item = &'a Level> + Clone,
) -> Result<(), String> {
    let is_number = |level: &Level| level.number.is_some_and(f64::is_finite);
    let mut lines = table.rows.iter().zip(levels);
    let number = lines.clone().find(|(_, level)| is_number(level));
    match (number, lines.find(|(_, level)| !is_number(level))) {
        (Some((beside, number)), Some((row, word))) => Err(format!(
            "{}: \"{}\" is \"{}\", which is no number, and {} in line {} is one; expected numbers in all lines, or words in all",
            table.place(row),
            factor.name,
            short(&word.label),
            short(&number.label),
            beside.line
        )),
        _ => Ok(()),
    }
}

/// Levels of a factor as they were spelt first: `5 N`, `5.0 N` and `5000 mN` are one level.
struct Spellings {
    first: HashMap<String, Level>,
    /// The levels that the study lists, in words; none where the table is all there is.
    listed: Option<String>,
}

impl Spellings {
    fn of(factor: &Factor) -> Self {
        let Values::Levels(levels) = &factor.values else { return Self { first: HashMap::new(), listed: None } };
        let first = levels.iter().map(|level| (meaning(level), level.clone())).collect();
        Self { first, listed: (!levels.is_empty()).then(|| factor.to_string()) }
    }

    /// The same level as it was spelt first.
    fn first_spelt(&mut self, level: Level) -> Result<Level, String> {
        match (self.first.get(&meaning(&level)), &self.listed) {
            (Some(first), _) => Ok(first.clone()),
            (None, Some(listed)) => Err(format!("{} is none of the levels {listed}", level.label)),
            (None, None) => Ok(self.first.entry(meaning(&level)).or_insert(level).clone()),
        }
    }
}

/// Key that equal levels share: their number up to what rounding makes of it, or their word.
fn meaning(level: &Level) -> String {
    level.number.map_or_else(|| level.label.clone(), |number| format!("{number:.12e}"))
}

#[cfg(test)]
#[path = "../../tests/unit/study/value_table.rs"]
mod tests;
