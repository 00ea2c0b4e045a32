//! A design of one's own: a table of points in a CSV file.

use std::path::Path;

use super::factor::{Factor, Level};
use super::value_table::{Row, ValueTable};

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
        column.ok_or_else(|| format!("{shown}: no column \"{}\"; it has {}", factor.name, table.heads().join(", ")))
    };
    let columns: Vec<usize> = factors.iter().zip(&columns).map(column).collect::<Result<_, _>>()?;
    let is_other = |at: usize| others.contains(&table.heads()[at].as_str()) || others.contains(&table.named(at).0);
    if let Some(unknown) = (0..table.heads().len()).find(|at| !columns.contains(at) && !is_other(*at)) {
        return Err(format!("{shown}: column \"{}\" is no factor of the study", table.heads()[unknown]));
    }
    let point = |row: &Row| {
        let levels = factors.iter().zip(&columns).map(|(factor, column)| table.level(row, *column, factor));
        levels.collect::<Result<Vec<Level>, String>>()
    };
    table.rows().iter().map(point).collect()
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
        read(&path, &factors, &["y"]).map_err(|error| error.replace(&directory.path().display().to_string(), "."))
    }

    #[test]
    fn columns_are_told_by_factor_or_key() {
        let points = read_text("mesh.rows, load, y [m2]\n20, 5 N, 1\n# no\n40, 7.5 N,\n").unwrap();
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
        assert_eq!(read_text("load,rows\n").unwrap_err(), "./points.csv: no points, expected a line for each");
    }
}
