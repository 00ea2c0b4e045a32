//! A whole series that was measured, from a table: a column of times, one of values, and if there is one their uncertainties.

use std::path::{Path, PathBuf};

use plateau_study::fit::{MeasuredSeries, SeriesError};

use super::value_table::{Row, ValueTable};
use crate::units;

/// What the column of times is called.
const TIME: &str = "time";
/// What the column of uncertainties is called, alone or behind the name of the values.
const UNCERTAINTY: &str = "uncertainty";

/// A measured series and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct SeriesFile {
    /// The table.
    pub path: PathBuf,
    /// The series, in SI units.
    pub series: MeasuredSeries,
    /// The unit in which the table has the time.
    pub time_unit: String,
    /// Number of the last line.
    pub last_line: u64,
}

/// What is looked for in the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted<'a> {
    /// Names that the column of values may have.
    pub names: [&'a str; 2],
    /// SI unit of the values.
    pub unit: &'a str,
    /// Standard uncertainty of all values, SI, where the table has no column of them.
    pub uncertainty: Option<f64>,
    /// For how long errors are alike, s; 0 if they are independent.
    pub correlation_time: f64,
}

/// Reads a series from a table in CSV. Other columns are passed over.
///
/// # Errors
/// What is wrong, with file, line and column.
pub fn read(path: &Path, wanted: Wanted<'_>) -> Result<SeriesFile, String> {
    let table = ValueTable::read(path)?;
    let shown = path.display();
    let [time, value] = [column(&table, &[TIME])?, column(&table, &wanted.names)?];
    let time = time.ok_or_else(|| missing(&table, "time [s]"))?;
    let value = value.ok_or_else(|| missing(&table, wanted.names[0]))?;
    let named = wanted.names.map(|name| format!("{name} {UNCERTAINTY}"));
    let of_values = match column(&table, &[&named[0], &named[1]])? {
        None => column(&table, &[UNCERTAINTY])?,
        found => found,
    };
    let deviation = match (of_values, wanted.uncertainty) {
        (Some(column), None) => Ok(column),
        (None, Some(uncertainty)) => Err(uncertainty),
        (Some(column), Some(_)) => {
            let head = &table.heads()[column];
            return Err(format!("{shown}:1: column \"{head}\" and the key uncertainty of the response, keep one"));
        }
        (None, None) => {
            return Err(format!(
                "{shown}:1: no column \"{UNCERTAINTY}\"; give one, or uncertainty = ... in the response for all points"
            ));
        }
    };
    if table.named(time).1.is_empty() {
        return Err(format!("{shown}:1: column \"{TIME}\" has no unit, expected one such as \"{TIME} [s]\""));
    }
    let (mut times, mut values, mut uncertainties) = (Vec::new(), Vec::new(), Vec::new());
    for row in table.rows() {
        times.push(number(&table, row, time, "s", units::parse_as)?);
        values.push(number(&table, row, value, wanted.unit, units::parse_as)?);
        uncertainties.push(match deviation {
            Ok(column) => number(&table, row, column, wanted.unit, units::parse_difference_as)?,
            Err(uncertainty) => uncertainty,
        });
    }
    let place = |point: usize| table.rows().get(point).map_or_else(String::new, |row| table.place(row));
    let head = |column: usize| table.heads()[column].as_str();
    let series = MeasuredSeries::new(times, values, uncertainties, wanted.correlation_time);
    let series = series.map_err(|error| match error {
        SeriesError::TooFew(points) => {
            format!("{shown}: {points} point, expected at least 2; one alone is measured = ...")
        }
        SeriesError::Order(point) => {
            let head = head(time);
            format!("{}: \"{head}\" is not after the line before; sort the lines by time, each time once", place(point))
        }
        SeriesError::Uncertainty(point, found) => {
            let head = deviation.map_or(UNCERTAINTY, head);
            format!("{}: \"{head}\" is {found}, expected more than 0", place(point))
        }
        SeriesError::NotFinite(point) => format!("{}: a value is too large", place(point)),
        SeriesError::CorrelationTime(_) => error.to_string(),
    })?;
    if let Some(before) = table.rows().iter().zip(series.times()).find(|(_, time)| **time < 0.0).map(|(row, _)| row) {
        return Err(format!("{}: \"{}\" is before the run", table.place(before), head(time)));
    }
    let (time_unit, last_line) = (table.named(time).1.to_owned(), table.rows().last().map_or(0, |row| row.line));
    Ok(SeriesFile { path: path.to_owned(), series, time_unit, last_line })
}

/// The column of one of these names; none where there is none.
fn column(table: &ValueTable, names: &[&str]) -> Result<Option<usize>, String> {
    let mut own = (0..table.heads().len()).filter(|at| names.contains(&table.named(*at).0));
    match (own.next(), own.next()) {
        (Some(one), Some(other)) => Err(format!(
            "{}:1: columns \"{}\" and \"{}\" are the same thing, keep one",
            table.path().display(),
            table.heads()[one],
            table.heads()[other]
        )),
        (found, _) => Ok(found),
    }
}

fn missing(table: &ValueTable, name: &str) -> String {
    format!("{}:1: no column \"{name}\"; it has {}", table.path().display(), table.heads_in_words())
}

/// A number of a line in an SI unit; that of a head without a unit is SI.
fn number(
    table: &ValueTable,
    row: &Row,
    column: usize,
    si: &str,
    parse: fn(&str, &str) -> Result<f64, String>,
) -> Result<f64, String> {
    let head = &table.heads()[column];
    let value = table.number(row, column)?.ok_or_else(|| {
        format!("{}: \"{head}\" is empty, expected a number; leave out lines that were not measured", table.place(row))
    })?;
    match table.named(column).1 {
        "" | "1" => Ok(value),
        unit => parse(&format!("{value:e} {unit}"), si)
            .map_err(|reason| format!("{}: \"{head}\": {reason}", table.place(row))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str, uncertainty: Option<f64>) -> Result<SeriesFile, String> {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("t.csv");
        std::fs::write(&path, text).unwrap();
        let wanted = Wanted { names: ["area", "contact_area"], unit: "m2", uncertainty, correlation_time: 0.0 };
        read(&path, wanted).map_err(|error| error.replace(&directory.path().display().to_string(), "."))
    }

    #[test]
    fn values_and_uncertainties_come_in_the_units_of_their_heads() {
        let text = "# rig 2\ntime [min],contact_area [mm2],uncertainty [um2],humidity\n0,1.5,2e4,40\n2,2.5,3e4,\n";
        let found = read_text(text, None).unwrap();
        assert_eq!((found.series.times(), found.time_unit.as_str(), found.last_line), (&[0.0, 120.0][..], "min", 4));
        let near = |found: &[f64], expected: [f64; 2]| {
            assert!(found.iter().zip(expected).all(|(one, other)| (one / other - 1.0).abs() < 1e-12), "{found:?}");
        };
        near(found.series.values(), [1.5e-6, 2.5e-6]);
        near(found.series.uncertainties(), [2e-8, 3e-8]);
        let one_for_all = read_text("time [s],area\n1,2e-6\n2,3e-6\n", Some(1e-7)).unwrap();
        assert_eq!(one_for_all.series.uncertainties(), [1e-7, 1e-7]);
    }

    #[test]
    fn an_uncertainty_of_five_degrees_is_no_temperature() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("t.csv");
        std::fs::write(&path, "time [s],heat [degC],uncertainty [degC]\n0,100,5\n1,110,5\n").unwrap();
        let wanted = Wanted { names: ["heat", "x"], unit: "K", uncertainty: None, correlation_time: 0.0 };
        let found = read(&path, wanted).unwrap();
        assert_eq!((found.series.values()[0], found.series.uncertainties()[0]), (373.15, 5.0));
    }

    #[test]
    fn what_is_wrong_is_told_with_line_and_column() {
        let head = "time [s],area [mm2],uncertainty [mm2]\n";
        for (lines, expected) in [
            ("0,1,0.1\n", "./t.csv: 1 point, expected at least 2; one alone is measured = ..."),
            ("", "./t.csv: no points, expected a line for each"),
            ("0,1,0.1\n1,NaN,0.1\n", "./t.csv:3: \"area [mm2]\" is \"NaN\", expected a number such as 0.35"),
            ("0,1,0.1\n1,x,0.1\n", "./t.csv:3: \"area [mm2]\" is \"x\", expected a number such as 0.35"),
            (
                "0,1,0.1\n1,,0.1\n",
                "./t.csv:3: \"area [mm2]\" is empty, expected a number; leave out lines that were not measured",
            ),
            ("0,1,0.1\n1,2,0\n", "./t.csv:3: \"uncertainty [mm2]\" is 0, expected more than 0"),
            (
                "1,1,0.1\n1,2,0.1\n",
                "./t.csv:3: \"time [s]\" is not after the line before; sort the lines by time, each time once",
            ),
            ("-1,1,0.1\n1,2,0.1\n", "./t.csv:2: \"time [s]\" is before the run"),
            (
                "0,1e308,0.1\n1,1e308,1e314\n",
                "./t.csv:3: \"uncertainty [mm2]\" is \"1e314\", expected a number such as 0.35",
            ),
        ] {
            assert_eq!(read_text(&format!("{head}{lines}"), None).unwrap_err(), expected);
        }
        for (head, expected) in [
            ("time,area,uncertainty", "./t.csv:1: column \"time\" has no unit, expected one such as \"time [s]\""),
            ("time [s],force,uncertainty", "./t.csv:1: no column \"area\"; it has time [s], force, uncertainty"),
            ("t,area,uncertainty", "./t.csv:1: no column \"time [s]\"; it has t, area, uncertainty"),
            (
                "time [s],area,contact_area",
                "./t.csv:1: columns \"area\" and \"contact_area\" are the same thing, keep one",
            ),
            ("time [N],area,uncertainty", "./t.csv:2: \"time [N]\": it is a force"),
            (
                "time [s],area,x",
                "./t.csv:1: no column \"uncertainty\"; give one, or uncertainty = ... in the response for all points",
            ),
        ] {
            assert_eq!(read_text(&format!("{head}\n0,1,1\n1,1,1\n"), None).unwrap_err(), expected);
        }
        let twice = read_text(&format!("{head}0,1,1\n1,1,1\n"), Some(1.0)).unwrap_err();
        assert!(twice.contains("and the key uncertainty of the response, keep one"), "{twice}");
    }
}
