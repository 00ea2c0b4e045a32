//! A design of one's own: a table of points in a CSV file.

use std::path::Path;

use super::factor::{Factor, Level};
use crate::text::odd_character;
use crate::{limits, regular};

/// Points of a study, each with one level for every factor.
pub type Points = Vec<Vec<Level>>;

/// Reads a CSV file whose first line names the factors, or the keys that they set; every other line is a point.
///
/// # Errors
/// What is wrong with the file, and in which line.
pub fn read(path: &Path, factors: &[Factor]) -> Result<Points, String> {
    read_points(path, factors, limits::ROWS.min(limits::CELLS / factors.len().max(1)))
}

fn read_points(path: &Path, factors: &[Factor], most: usize) -> Result<Points, String> {
    let shown = path.display();
    let file = regular::open_small(path, limits::TABLE).map_err(|error| format!("cannot read {shown}: {error}"))?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(file);
    let header = reader.headers().map_err(|error| format!("{shown}: {error}"))?.clone();
    let column = |factor: &Factor| {
        let named = |name: &str| name == factor.name || factor.keys.iter().any(|key| key == name);
        header.iter().position(named).ok_or_else(|| {
            format!("{shown}: no column \"{}\"; it has {}", factor.name, header.iter().collect::<Vec<_>>().join(", "))
        })
    };
    let columns: Vec<usize> = factors.iter().map(column).collect::<Result<_, _>>()?;
    if let Some((_, unknown)) = header.iter().enumerate().find(|(at, _)| !columns.contains(at)) {
        return Err(format!("{shown}: column \"{unknown}\" is no factor of the study"));
    }
    let mut points = Points::new();
    for record in reader.records() {
        let record = record.map_err(|error| format!("{shown}: {error}"))?;
        let line = record.position().map_or(0, csv::Position::line);
        if points.len() == most {
            return Err(format!("{shown}:{line}: {}", limits::more("more", most, "points")));
        }
        let level = |(factor, column): (&Factor, &usize)| {
            let text = record.get(*column).filter(|text| !text.is_empty());
            let text = text.ok_or_else(|| format!("{shown}:{line}: \"{}\" is empty", factor.name))?;
            if let Some(found) = odd_character(text) {
                return Err(format!("{shown}:{line}: \"{}\" has {found}; take it out", factor.name));
            }
            Ok(Level::new(&factor.keys[0], &value(text)))
        };
        points.push(factors.iter().zip(&columns).map(level).collect::<Result<_, String>>()?);
    }
    if points.is_empty() { Err(format!("{shown}: no points, expected a line for each")) } else { Ok(points) }
}

/// A value in TOML; what is none is a text.
fn value(text: &str) -> toml::Value {
    let table: Result<toml::Table, _> = format!("value = {text}").parse();
    let value = table.ok().and_then(|mut table| table.remove("value"));
    value.unwrap_or_else(|| toml::Value::String(text.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::factor::Values;

    fn read_text(text: &str) -> Result<Points, String> {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("points.csv");
        std::fs::write(&path, text).unwrap();
        let factor = |name: &str, key: &str| Factor {
            name: name.into(),
            keys: vec![key.into()],
            values: Values::Levels(Vec::new()),
        };
        let factors = [factor("load", "operation.normal_force"), factor("rows", "mesh.rows")];
        read_points(&path, &factors, 3).map_err(|error| error.replace(&directory.path().display().to_string(), "."))
    }

    #[test]
    fn columns_are_told_by_factor_or_key() {
        let points = read_text("mesh.rows, load\n20, 5 N\n# no\n40, 7.5 N\n").unwrap();
        let numbers: Vec<Vec<f64>> = points.iter().map(|p| p.iter().map(|l| l.number.unwrap()).collect()).collect();
        assert_eq!(numbers, [[5.0, 20.0], [7.5, 40.0]]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert_eq!(read_text("load\n5 N\n").unwrap_err(), "./points.csv: no column \"rows\"; it has load");
        assert_eq!(
            read_text("load,rows,x\n5 N,1,2\n").unwrap_err(),
            "./points.csv: column \"x\" is no factor of the study"
        );
        assert_eq!(read_text("load,rows\n5 N,\n").unwrap_err(), "./points.csv:2: \"rows\" is empty");
        let four = read_text("load,rows\n5 N,1\n5 N,2\n5 N,3\n5 N,4\n").unwrap_err();
        assert_eq!(four, "./points.csv:5: more points, expected at most 3");
        let bell = read_text("load,rows\n5 N\u{7},1\n").unwrap_err();
        assert_eq!(bell, "./points.csv:2: \"load\" has the control character U+0007; take it out");
        assert_eq!(read_text("load,rows\n").unwrap_err(), "./points.csv: no points, expected a line for each");
    }
}
