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

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ValueTable {
    path: PathBuf,
    heads: Vec<String>,
    rows: Vec<Row>,
}

/// A line of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Row {
    /// Its number in the file, from 1.
    pub(super) line: u64,
    cells: Vec<String>,
}

impl ValueTable {
    /// Reads a CSV file. Lines that begin with # are passed over.
    ///
    /// # Errors
    /// What is wrong with the file, and in which line.
    pub(super) fn read(path: &Path) -> Result<Self, String> {
        Self::read_rows(path, limits::ROWS)
    }

    /// As [`ValueTable::read`], at most so many lines, and at most [`limits::CELLS`] values.
    fn read_rows(path: &Path, most: usize) -> Result<Self, String> {
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
            rows.push(Row { line: line as u64, cells });
        }
        if rows.is_empty() {
            return Err(no_points());
        }
        Ok(Self { path: path.to_owned(), heads, rows })
    }

    /// Heads of the columns.
    pub(super) fn heads(&self) -> &[String] {
        &self.heads
    }

    /// Heads of the columns, in words; of many the first.
    fn heads_in_words(&self) -> String {
        let more = self.heads.len().saturating_sub(SHOWN);
        let shown: Vec<_> = self.heads.iter().take(SHOWN).map(|head| short(head)).collect();
        let more = if more > 0 { format!(", … ({more} more)") } else { String::new() };
        format!("{}{more}", shown.join(", "))
    }

    /// The lines.
    pub(super) fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Name and unit of a column: `load [N]` is `load` in `N`.
    pub(super) fn named(&self, column: usize) -> (&str, &str) {
        let head = self.heads[column].as_str();
        let with_unit = head.strip_suffix(']').and_then(|head| head.rsplit_once(" ["));
        with_unit.map_or((head, ""), |(name, unit)| (name.trim(), unit.trim()))
    }

    /// The column of each factor, which names the factor or one of its keys; none where there is none.
    ///
    /// # Errors
    /// A factor that two columns are of.
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

    /// Level of a factor in a line.
    ///
    /// # Errors
    /// An empty cell.
    pub(super) fn level(&self, row: &Row, column: usize, factor: &Factor) -> Result<Level, String> {
        let cell = self.cell(row, column);
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

    /// File and line of a row.
    pub(super) fn place(&self, row: &Row) -> String {
        format!("{}:{}", self.path.display(), row.line)
    }

    /// The text of a cell.
    pub(super) fn cell<'a>(&self, row: &'a Row, column: usize) -> &'a str {
        row.cells.get(column).map_or("", String::as_str)
    }
}

/// Points of a study, each with one level for every factor.
pub type Points = Vec<Vec<Level>>;

/// Reads a CSV file whose first line names the factors, or the keys that they set; every other line is a point. Columns of what
/// is measured at the points, `others`, may stand beside them.
///
/// # Errors
/// What is wrong with the file, and in which line.
pub(super) fn read_points(path: &Path, factors: &[Factor], others: &[&str]) -> Result<Points, String> {
    let table = ValueTable::read(path)?;
    let shown = path.display();
    let columns = table.factor_columns(factors)?;
    let column = |(factor, column): (&Factor, &Option<usize>)| {
        column.ok_or_else(|| format!("{shown}: no column \"{}\"; it has {}", factor.name, table.heads_in_words()))
    };
    let columns: Vec<usize> = factors.iter().zip(&columns).map(column).collect::<Result<_, _>>()?;
    let (known, others): (HashSet<usize>, HashSet<&str>) =
        (columns.iter().copied().collect(), others.iter().copied().collect());
    let is_other = |at: usize| others.contains(table.heads()[at].as_str()) || others.contains(table.named(at).0);
    if let Some(unknown) = (0..table.heads().len()).find(|at| !known.contains(at) && !is_other(*at)) {
        return Err(format!("{shown}: column \"{}\" is not a factor of the study", short(&table.heads()[unknown])));
    }
    let mut known: Vec<Spellings> = factors.iter().map(Spellings::of).collect();
    let point = |row: &Row| {
        let level = |((factor, column), known): ((&Factor, &usize), &mut Spellings)| {
            let level = table.level(row, *column, factor)?;
            known.first_spelt(level).map_err(|why| format!("{}: {}: {why}", table.place(row), factor.name))
        };
        factors.iter().zip(&columns).zip(&mut known).map(level).collect::<Result<Vec<Level>, String>>()
    };
    let points = table.rows().iter().map(point).collect::<Result<Points, String>>()?;
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
    let mut lines = table.rows().iter().zip(levels);
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
    ///
    /// # Errors
    /// A level that the study does not list.
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
mod tests {
    use super::*;
    use crate::study::factor::Values;

    fn table(text: &str) -> Result<ValueTable, String> {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("t.csv");
        std::fs::write(&path, text).unwrap();
        ValueTable::read(&path).map_err(|error| error.replace(&directory.path().display().to_string(), "."))
    }

    #[test]
    fn columns_have_names_and_units() {
        let factor = |name: &str, key: &str| Factor {
            name: name.into(),
            keys: vec![key.into()],
            stated_unit: String::new(),
            values: Values::Levels(Vec::new()),
        };
        let factors = [factor("load", "operation.normal_force"), factor("fibres", "pin.base.synthetic.fibre_fraction")];
        let table =
            table("load [kN],y [m2],pin.base.synthetic.fibre_fraction\n# measured\n0.005,1e-6,0.2\n,,0.3\n").unwrap();
        assert_eq!(table.factor_columns(&factors).unwrap(), [Some(0), Some(2)]);
        assert_eq!((table.named(1), table.named(2).1), (("y", "m2"), ""));
        let [first, second] = table.rows() else { panic!("two lines") };
        assert_eq!((first.line, second.line), (3, 4));
        assert_eq!(table.level(first, 0, &factors[0]).unwrap().number, Some(5.0));
        assert_eq!(table.level(first, 2, &factors[1]).unwrap().number, Some(0.2));
        assert!(table.level(second, 0, &factors[0]).unwrap_err().ends_with("t.csv:4: \"load\" is empty"));
    }

    #[test]
    fn what_is_too_much_or_no_text_is_refused() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("t.csv");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            ValueTable::read_rows(&path, 3).map_err(|error| error.replace(&directory.path().display().to_string(), "."))
        };
        assert_eq!(read("a\n1\n2\n3\n4\n").unwrap_err(), "./t.csv:5: more points, expected at most 3");
        let bell = read("a,b\n5 N\u{7},1\n").unwrap_err();
        assert_eq!(bell, "./t.csv:2: \"a\" has the control character U+0007; take it out");
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert!(table("a,a\n1,2\n").unwrap_err().ends_with("column \"a\" is there twice"));
        assert!(table("a,b\n").unwrap_err().contains("no points"));
        assert_eq!(
            table("\u{feff}a,b\n\n# no\n1\n").unwrap_err(),
            "./t.csv:4: 1 cells, expected 2 as in the first line"
        );
    }

    fn read_text(text: &str) -> Result<Points, String> {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("points.csv");
        std::fs::write(&path, text).unwrap();
        let factor = |name: &str, key: &str| Factor {
            name: name.into(),
            keys: vec![key.into()],
            stated_unit: String::new(),
            values: Values::Levels(Vec::new()),
        };
        let factors = [factor("load", "operation.normal_force"), factor("rows", "mesh.rows")];
        read_points(&path, &factors, &["y"])
            .map_err(|error| error.replace(&directory.path().display().to_string(), "."))
    }

    #[test]
    fn columns_are_told_by_factor_or_key() {
        let points = read_text("mesh.rows, load, y [m2]\n20, 5 N, 1\n# no\n40, 7.5 N,\n").unwrap();
        let numbers: Vec<Vec<f64>> = points.iter().map(|p| p.iter().map(|l| l.number.unwrap()).collect()).collect();
        assert_eq!(numbers, [[5.0, 20.0], [7.5, 40.0]]);
    }

    #[test]
    fn equal_levels_are_one_however_they_are_spelt() {
        let points = read_text("rows,load\n1,5 N\n2,5000 mN\n3,5.0 N\n4,6 N\n").unwrap();
        let labels: Vec<&str> = points.iter().map(|point| point[0].label.as_str()).collect();
        assert_eq!(labels, ["5 N", "5 N", "5 N", "6 N"]);
    }

    #[test]
    fn levels_that_the_study_lists_are_the_only_ones() {
        let level = |text: &str| Level::parse("operation.normal_force", text);
        let values = Values::Levels(vec![level("5 N"), level("6 N")]);
        let keys = vec!["operation.normal_force".into()];
        let factor = Factor { name: "load".into(), keys, stated_unit: String::new(), values };
        let mut spellings = Spellings::of(&factor);
        assert_eq!(spellings.first_spelt(level("6000 mN")).unwrap().label, "6 N");
        assert_eq!(spellings.first_spelt(level("7 N")).unwrap_err(), "7 N is none of the levels 5 N, 6 N");
    }

    #[test]
    fn a_word_among_numbers_is_no_level() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("points.csv");
        let values = Values::Levels(Vec::new());
        let factors = [Factor { name: "humidity".into(), keys: Vec::new(), stated_unit: String::new(), values }];
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read_points(&path, &factors, &[])
        };
        for word in ["O.3", "1e400", "0,3", "high"] {
            let said = read(&format!("humidity\n0.4\n\"{word}\"\n0.5\n")).unwrap_err();
            let expected =
                format!("points.csv:3: \"humidity\" is \"{word}\", which is no number, and 0.4 in line 2 is one;");
            assert!(said.contains(&expected), "{said}");
        }
        assert_eq!(read("humidity\nhigh\nlow\n").unwrap().len(), 2);
    }

    #[test]
    fn what_is_wrong_with_points_is_said() {
        assert_eq!(read_text("load\n5 N\n").unwrap_err(), "./points.csv: no column \"rows\"; it has load");
        assert_eq!(
            read_text("load,rows,x\n5 N,1,2\n").unwrap_err(),
            "./points.csv: column \"x\" is not a factor of the study"
        );
        assert_eq!(read_text("load,rows\n5 N,\n").unwrap_err(), "./points.csv:2: \"rows\" is empty");
        assert_eq!(read_text("load,rows\n").unwrap_err(), "./points.csv: no points, expected a line for each");
    }
}
