//! A design of one's own: a table of points in a CSV file.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::factor::{Factor, Values};
use super::level::Level;
use super::value_table::{Row, ValueTable};
use crate::text::short;

/// Points of a study, each with one level for every factor.
pub type Points = Vec<Vec<Level>>;

/// Reads a CSV file whose first line names the factors, or the keys that they set; every other line is a point. Columns of what
/// is measured at the points, `others`, may stand beside them.
///
/// # Errors
/// What is wrong with the file, and in which line.
pub fn read(path: &Path, factors: &[Factor], others: &[&str]) -> Result<Points, String> {
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

/// What equal levels have alike: their number up to what rounding makes of it, or their word.
fn meaning(level: &Level) -> String {
    level.number.map_or_else(|| level.label.clone(), |number| format!("{number:.12e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

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
        read(&path, &factors, &["y"]).map_err(|error| error.replace(&directory.path().display().to_string(), "."))
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
            read(&path, &factors, &[])
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
    fn what_is_wrong_is_said() {
        assert_eq!(read_text("load\n5 N\n").unwrap_err(), "./points.csv: no column \"rows\"; it has load");
        assert_eq!(
            read_text("load,rows,x\n5 N,1,2\n").unwrap_err(),
            "./points.csv: column \"x\" is not a factor of the study"
        );
        assert_eq!(read_text("load,rows\n5 N,\n").unwrap_err(), "./points.csv:2: \"rows\" is empty");
        assert_eq!(read_text("load,rows\n").unwrap_err(), "./points.csv: no points, expected a line for each");
    }
}
