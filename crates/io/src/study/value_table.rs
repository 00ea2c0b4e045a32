//! A table of values in CSV: columns of factors and responses, named in the first line, with units as in results.csv.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::factor::Factor;
use super::level::Level;
use crate::delimited::{self, Fault, Line, Named};
use crate::limits;
use crate::text::{odd_character, short, text_of_cell, too_long};
use crate::units::parse_as;

/// Columns that a message names.
const SHOWN: usize = 12;

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueTable {
    path: PathBuf,
    heads: Vec<String>,
    rows: Vec<Row>,
}

/// A line of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Its number in the file, from 1.
    pub line: u64,
    cells: Vec<String>,
}

impl ValueTable {
    /// Reads a CSV file. Lines that begin with # are passed over.
    ///
    /// # Errors
    /// What is wrong with the file, and in which line.
    pub fn read(path: &Path) -> Result<Self, String> {
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

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What stands above the columns.
    pub fn heads(&self) -> &[String] {
        &self.heads
    }

    /// What stands above the columns, in words; of many the first.
    pub fn heads_in_words(&self) -> String {
        let more = self.heads.len().saturating_sub(SHOWN);
        let shown: Vec<_> = self.heads.iter().take(SHOWN).map(|head| short(head)).collect();
        let more = if more > 0 { format!(", … ({more} more)") } else { String::new() };
        format!("{}{more}", shown.join(", "))
    }

    /// The lines.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Name and unit of a column: `load [N]` is `load` in `N`.
    pub fn named(&self, column: usize) -> (&str, &str) {
        let head = self.heads[column].as_str();
        let with_unit = head.strip_suffix(']').and_then(|head| head.rsplit_once(" ["));
        with_unit.map_or((head, ""), |(name, unit)| (name.trim(), unit.trim()))
    }

    /// The column of each factor, which names the factor or one of its keys; none where there is none.
    ///
    /// # Errors
    /// A factor that two columns are of.
    pub fn factor_columns(&self, factors: &[Factor]) -> Result<Vec<Option<usize>>, String> {
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

    /// What a factor is set to in a line.
    ///
    /// # Errors
    /// An empty cell.
    pub fn level(&self, row: &Row, column: usize, factor: &Factor) -> Result<Level, String> {
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

    /// A number in a line; none of an empty cell.
    ///
    /// # Errors
    /// A cell that is no finite number.
    pub fn number(&self, row: &Row, column: usize) -> Result<Option<f64>, String> {
        let cell = self.cell(row, column);
        if cell.is_empty() {
            return Ok(None);
        }
        let number = cell.parse().ok().filter(|number: &f64| number.is_finite());
        number.map(Some).ok_or_else(|| {
            let (head, cell) = (short(&self.heads[column]), short(cell));
            format!("{}: \"{head}\" is \"{cell}\", expected a number such as 0.35", self.place(row))
        })
    }

    /// A quantity in a line, in this SI unit; none of an empty cell. The unit of the column may be another one that measures the same.
    ///
    /// # Errors
    /// A cell that is no finite number.
    pub fn quantity(&self, row: &Row, column: usize, si: &str) -> Result<Option<f64>, String> {
        let (_, unit) = self.named(column);
        let Some(number) = self.number(row, column)? else { return Ok(None) };
        if unit.is_empty() || unit == si {
            return Ok(Some(number));
        }
        let cell = self.cell(row, column);
        let refused = |error: String| format!("{}: \"{}\" is \"{cell}\": {error}", self.place(row), self.heads[column]);
        parse_as(&format!("{cell} {unit}"), si).map(Some).map_err(refused)
    }

    /// File and line of a row.
    pub fn place(&self, row: &Row) -> String {
        format!("{}:{}", self.path.display(), row.line)
    }

    /// The text of a cell.
    pub fn cell<'a>(&self, row: &'a Row, column: usize) -> &'a str {
        row.cells.get(column).map_or("", String::as_str)
    }
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
        assert_eq!((table.number(first, 1), table.number(second, 1)), (Ok(Some(1e-6)), Ok(None)));
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
        let text = table("a\n1\nx\ninf\n").unwrap();
        assert!(
            text.number(&text.rows()[1], 0)
                .unwrap_err()
                .ends_with("t.csv:3: \"a\" is \"x\", expected a number such as 0.35")
        );
        assert!(text.number(&text.rows()[2], 0).is_err());
    }
}
