//! Tables of load and speed over time (docs/cycles.md): text with one row a moment, as instruments and spreadsheets write it.

use std::io::ErrorKind;
use std::path::Path;
use std::sync::Arc;

use super::error::{Origin, Problem};
use crate::text::short;
use crate::units::{self, Dimension};
use crate::{limits, regular};

/// What a column may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Time,
    NormalForce,
    NominalPressure,
    RotationalSpeed,
    SlidingSpeed,
    RoadSpeed,
}

/// Name in the header, quantity and dimension of every column there is.
const COLUMNS: [(&str, Quantity, Dimension); 6] = [
    ("time", Quantity::Time, Dimension::Time),
    ("normal_force", Quantity::NormalForce, Dimension::Force),
    ("nominal_pressure", Quantity::NominalPressure, Dimension::Pressure),
    ("rotational_speed", Quantity::RotationalSpeed, Dimension::RotationalSpeed),
    ("sliding_speed", Quantity::SlidingSpeed, Dimension::Speed),
    ("road_speed", Quantity::RoadSpeed, Dimension::Speed),
];

/// Load of every row, as it was given.
#[derive(Debug, Clone, PartialEq)]
pub enum Loads {
    /// F, N.
    Force(Vec<f64>),
    /// F over the area of the pin's mesh, Pa.
    NominalPressure(Vec<f64>),
}

/// Speed of every row, as it was given.
#[derive(Debug, Clone, PartialEq)]
pub enum Speeds {
    /// ω, rad/s.
    Rotational(Vec<f64>),
    /// At the mean radius, m/s.
    Sliding(Vec<f64>),
}

/// A table, in SI units; what it has no column of is constant.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleTable {
    /// t of every row, s.
    pub times: Vec<f64>,
    /// Load.
    pub loads: Option<Loads>,
    /// Speed of the disc.
    pub speeds: Option<Speeds>,
    /// Speed of the vehicle, m/s.
    pub road_speeds: Option<Vec<f64>>,
    /// Where every row stands.
    pub places: Vec<Origin>,
}

/// A column of a table that is being read.
struct Column {
    header: String,
    unit: String,
    quantity: Quantity,
    dimension: Dimension,
    values: Vec<f64>,
}

/// The file and how its lines are divided.
struct Reader {
    file: Arc<Path>,
    separator: char,
}

/// Reads a table. Lines that are empty or begin with `#` are left out; where a semicolon separates, numbers may have a decimal
/// comma.
///
/// # Errors
/// What is wrong, with line and column.
pub fn read(path: &Path) -> Result<CycleTable, Problem> {
    read_rows(path, limits::ROWS)
}

fn read_rows(path: &Path, most: usize) -> Result<CycleTable, Problem> {
    let file: Arc<Path> = path.into();
    let text = regular::read_to_string(path, limits::TABLE).map_err(|error| {
        let advice = if error.kind() == ErrorKind::InvalidData { "; save it as UTF-8" } else { "" };
        Problem::without_key(&Origin::File(file.clone()), format!("cannot read it: {error}{advice}"))
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line)).filter(|(_, line)| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    });
    let Some((number, header)) = lines.next() else {
        let message = "it is empty, expected a header such as: time [s],normal_force [N],rotational_speed [rpm]";
        return Err(Problem::without_key(&Origin::File(file), message));
    };
    if header.contains('\t') {
        let problem = "the columns are separated by tabs, expected commas, or semicolons with a decimal comma";
        return Err(Problem {
            origin: Origin::Place { file, line: number, column: 1 },
            key: None,
            message: problem.to_owned(),
        });
    }
    let reader = Reader { file, separator: if header.contains(';') { ';' } else { ',' } };
    let mut columns = reader.header(number, header)?;
    let mut rows = Vec::new();
    for (number, line) in lines {
        if rows.len() == most {
            return Err(reader.problem(number, 1, None, limits::more("more", most, "rows")));
        }
        reader.row(number, line, &mut columns)?;
        rows.push(reader.origin(number, 1));
    }
    Ok(table(columns, rows))
}

impl Reader {
    fn origin(&self, line: usize, column: usize) -> Origin {
        Origin::Place { file: self.file.clone(), line, column }
    }

    fn problem(&self, line: usize, column: usize, key: Option<&str>, message: String) -> Problem {
        Problem { origin: self.origin(line, column), key: key.map(str::to_owned), message }
    }

    /// The fields of a line, each with the column of the text at which it begins, from 1.
    fn fields<'a>(&self, line: &'a str) -> Vec<(usize, &'a str)> {
        let mut column = 1;
        let field = |field: &'a str| {
            let blank = field.chars().take_while(|character| character.is_whitespace()).count();
            let begin = column + blank;
            column += field.chars().count() + 1;
            (begin, field.trim().trim_matches('"').trim())
        };
        line.split(self.separator).map(field).collect()
    }

    fn header(&self, number: usize, line: &str) -> Result<Vec<Column>, Problem> {
        let mut columns: Vec<Column> = Vec::new();
        for (place, header) in self.fields(line) {
            let wrong = |message: String| Err(self.problem(number, place, Some(header), message));
            let (name, unit) = match header.split_once('[') {
                Some((name, unit)) => (name.trim(), unit.trim_end().trim_end_matches(']').trim()),
                None => (header, ""),
            };
            let name = name.to_lowercase().replace(' ', "_");
            let Some((_, quantity, dimension)) = COLUMNS.iter().find(|(known, ..)| *known == name) else {
                let known: Vec<_> = COLUMNS.iter().map(|(name, ..)| *name).collect();
                return wrong(format!("no such column, expected some of {}", known.join(", ")));
            };
            if let Err(error) = units::parse(&format!("1 {unit}"), *dimension) {
                return wrong(format!("{error}; give the unit in brackets, such as {name} [{}]", dimension.si_unit()));
            }
            if let Some(other) = columns.iter().find(|other| excludes(other.quantity, *quantity)) {
                return wrong(format!("stands beside {}, expected one of the two", other.header));
            }
            let (header, unit) = (header.to_owned(), unit.to_owned());
            columns.push(Column { header, unit, quantity: *quantity, dimension: *dimension, values: Vec::new() });
        }
        if columns.iter().all(|column| column.quantity != Quantity::Time) {
            return Err(self.problem(number, 1, None, "no column of times, expected time [s]".into()));
        }
        Ok(columns)
    }

    fn row(&self, number: usize, line: &str, columns: &mut [Column]) -> Result<(), Problem> {
        let fields = self.fields(line);
        if fields.len() > columns.len() {
            let message = format!("{} fields, expected {}, one for each column", fields.len(), columns.len());
            return Err(self.problem(number, fields[columns.len()].0, None, message));
        }
        let end = line.chars().count() + 1;
        for (index, column) in columns.iter_mut().enumerate() {
            let (place, field) = fields.get(index).copied().unwrap_or((end, ""));
            let wrong = |message: String| Err(self.problem(number, place, Some(&column.header), message));
            if field.is_empty() {
                return wrong("no value, expected a number in every row".into());
            }
            let field = if self.separator == ';' { field.replace(',', ".") } else { field.to_owned() };
            let Ok(plain) = field.parse::<f64>() else {
                return wrong(format!("found \"{}\", expected a number", short(&field).escape_debug()));
            };
            if !plain.is_finite() || plain < 0.0 {
                return wrong(format!("found {}, expected a number of 0 or more", short(&field)));
            }
            match units::parse(&format!("{field} {}", column.unit), column.dimension) {
                Ok(value) => column.values.push(value),
                Err(error) => return wrong(error.to_string()),
            }
        }
        Ok(())
    }
}

/// Whether two columns say the same thing.
fn excludes(one: Quantity, other: Quantity) -> bool {
    use Quantity::{NominalPressure, NormalForce, RotationalSpeed, SlidingSpeed};
    let is_either = |pair: [Quantity; 2]| pair.contains(&one) && pair.contains(&other);
    one == other || is_either([NormalForce, NominalPressure]) || is_either([RotationalSpeed, SlidingSpeed])
}

fn table(columns: Vec<Column>, places: Vec<Origin>) -> CycleTable {
    let mut table = CycleTable { times: Vec::new(), loads: None, speeds: None, road_speeds: None, places };
    for Column { quantity, values, .. } in columns {
        match quantity {
            Quantity::Time => table.times = values,
            Quantity::NormalForce => table.loads = Some(Loads::Force(values)),
            Quantity::NominalPressure => table.loads = Some(Loads::NominalPressure(values)),
            Quantity::RotationalSpeed => table.speeds = Some(Speeds::Rotational(values)),
            Quantity::SlidingSpeed => table.speeds = Some(Speeds::Sliding(values)),
            Quantity::RoadSpeed => table.road_speeds = Some(values),
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<CycleTable, String> {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("stops.csv");
        std::fs::write(&path, text).unwrap();
        read(&path).map_err(|error| error.to_string().replace(&format!("{}/", directory.path().display()), ""))
    }

    fn lines(table: &CycleTable) -> Vec<usize> {
        let line = |place: &Origin| if let Origin::Place { line, .. } = place { *line } else { 0 };
        table.places.iter().map(line).collect()
    }

    #[test]
    fn columns_have_units_of_their_own() {
        let table =
            read_text("# a stop\nTime [min], Nominal pressure [MPa], sliding_speed [km/h]\n0,1.5,36\n1,0,0\n").unwrap();
        assert_eq!(table.times, [0.0, 60.0]);
        assert_eq!(table.loads, Some(Loads::NominalPressure(vec![1.5e6, 0.0])));
        assert_eq!(table.speeds, Some(Speeds::Sliding(vec![10.0, 0.0])));
        assert_eq!((table.road_speeds.as_ref(), lines(&table)), (None, vec![3, 4]));
    }

    #[test]
    fn a_spreadsheet_may_write_decimal_commas() {
        let table = read_text("\u{feff}\"time [s]\";\"normal_force [N]\"\r\n0;47,5\r\n\r\n0,25;1e1\r\n").unwrap();
        assert_eq!((&table.times, lines(&table)), (&vec![0.0, 0.25], vec![2, 4]));
        assert_eq!(table.loads, Some(Loads::Force(vec![47.5, 10.0])));
        assert_eq!(table.speeds, None);
    }

    #[test]
    fn more_rows_than_are_read_are_refused() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("stops.csv");
        std::fs::write(&path, "time [s]\n0\n1\n\n2\n3\n").unwrap();
        assert_eq!(read_rows(&path, 4).unwrap().times, [0.0, 1.0, 2.0, 3.0]);
        let error = read_rows(&path, 3).unwrap_err().to_string();
        assert!(error.ends_with("stops.csv:6:1: more rows, expected at most 3"), "{error}");
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        let error = |text: &str| read_text(text).unwrap_err();
        assert!(error("").starts_with("stops.csv: it is empty, expected a header such as: time [s],"));
        assert!(
            error("time,normal_force [N]\n").starts_with("stops.csv:1:1: time: \"1\" has no unit"),
            "{}",
            error("time,normal_force [N]\n")
        );
        assert_eq!(
            error("time [s],force [N]\n0,1\n"),
            "stops.csv:1:10: force [N]: no such column, expected some of time, normal_force, nominal_pressure, \
             rotational_speed, sliding_speed, road_speed"
        );
        assert_eq!(
            error("time [s],normal_force [N],nominal_pressure [Pa]\n"),
            "stops.csv:1:27: nominal_pressure [Pa]: stands beside normal_force [N], expected one of the two"
        );
        assert_eq!(error("normal_force [N]\n1\n"), "stops.csv:1:1: no column of times, expected time [s]");
        let header = "time [s], normal_force [N]\n";
        let row = |row: &str| error(&format!("{header}0,1\n{row}\n"));
        assert_eq!(row("1, -3"), "stops.csv:3:4: normal_force [N]: found -3, expected a number of 0 or more");
        assert_eq!(row("1,nan"), "stops.csv:3:3: normal_force [N]: found nan, expected a number of 0 or more");
        assert_eq!(row("1,4 N"), "stops.csv:3:3: normal_force [N]: found \"4 N\", expected a number");
        assert_eq!(row("1,"), "stops.csv:3:3: normal_force [N]: no value, expected a number in every row");
        assert_eq!(row("1"), "stops.csv:3:2: normal_force [N]: no value, expected a number in every row");
        assert_eq!(row("1,2,3"), "stops.csv:3:5: 3 fields, expected 2, one for each column");
    }
}
