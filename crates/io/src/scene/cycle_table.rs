//! Tables of load and speed over time (docs/drive.md): text with one row a moment, as instruments and spreadsheets write it.

use std::path::Path;
use std::sync::Arc;

use super::error::{Origin, Problem};
use super::schema::BRAKING_TORQUE;
use crate::delimited::{self, Fault, Line, Named};
use crate::limits;
use crate::text::short;
use crate::units::{self, Dimension};

/// Quantity of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Time,
    NormalForce,
    NominalPressure,
    BrakingTorque,
    RotationalSpeed,
    SlidingSpeed,
    RoadSpeed,
}

/// Name in the header, quantity and dimension of every column there is.
const COLUMNS: [(&str, Quantity, Dimension); 7] = [
    ("time", Quantity::Time, Dimension::Time),
    ("normal_force", Quantity::NormalForce, Dimension::Force),
    ("nominal_pressure", Quantity::NominalPressure, Dimension::Pressure),
    (BRAKING_TORQUE, Quantity::BrakingTorque, Dimension::Torque),
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
    /// T that friction has to give, N m.
    BrakingTorque(Vec<f64>),
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
    /// Origin of every row.
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

/// Problem, with the header of the column if it is of one.
type Wrong = (Option<String>, Fault);

/// Reads a table.
///
/// # Errors
/// What is wrong, with line and column.
pub fn read(path: &Path) -> Result<CycleTable, Problem> {
    read_rows(path, limits::ROWS)
}

fn read_rows(path: &Path, most: usize) -> Result<CycleTable, Problem> {
    let file: Arc<Path> = path.into();
    let of_file = |message: String| Problem::without_key(&Origin::File(file.clone()), message);
    let origin = |line: usize, column: usize| Origin::Place { file: file.clone(), line, column };
    let wrong = |(head, fault): Wrong| Problem {
        key: head,
        ..Problem::without_key(&origin(fault.line, fault.column), fault.message)
    };
    let text = delimited::read(path, limits::TABLE).map_err(|error| of_file(format!("cannot read it: {error}")))?;
    let table = Named::of(&text).map_err(|fault| wrong((None, fault)))?.ok_or_else(|| {
        of_file("it is empty, expected a header such as: time [s],normal_force [N],rotational_speed [rpm]".to_owned())
    })?;
    let mut columns = header(&table.head).map_err(wrong)?;
    let mut places = Vec::new();
    for row in table.rows() {
        let row = row.map_err(|fault| wrong((None, fault)))?;
        if places.len() == most {
            return Err(wrong((None, row.fault(0, limits::more("more", most, "rows")))));
        }
        take(&row, &mut columns).map_err(wrong)?;
        places.push(origin(row.number, 1));
    }
    Ok(self::table(columns, places))
}

/// The columns that the header names, or what is wrong with one of the names.
fn header(line: &Line<'_>) -> Result<Vec<Column>, Wrong> {
    let mut columns: Vec<Column> = Vec::new();
    for (place, cell) in line.cells.iter().enumerate() {
        let header = &*cell.text;
        let wrong = |message: String| Err((Some(header.to_owned()), line.fault(place, message)));
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
        return Err((None, line.fault(0, "no column of times, expected time [s]".into())));
    }
    Ok(columns)
}

/// Takes in a row, or tells what is wrong with it, in which column.
fn take(row: &Line<'_>, columns: &mut [Column]) -> Result<(), Wrong> {
    if row.cells.len() > columns.len() {
        let message = format!("{} fields, expected {}, one for each column", row.cells.len(), columns.len());
        return Err((None, row.fault(columns.len(), message)));
    }
    for (place, column) in columns.iter_mut().enumerate() {
        let field = row.cells.get(place).map_or("", |cell| &*cell.text);
        let wrong = |message: String| Err((Some(column.header.clone()), row.fault(place, message)));
        if field.is_empty() {
            return wrong("no value, expected a number in every row".into());
        }
        let Ok(plain) = field.parse::<f64>() else {
            return wrong(format!("found \"{}\", expected a number", short(field).escape_debug()));
        };
        if !plain.is_finite() || plain < 0.0 {
            return wrong(format!("found {}, expected a number of 0 or more", short(field)));
        }
        match units::parse(&format!("{field} {}", column.unit), column.dimension) {
            Ok(value) => column.values.push(value),
            Err(error) => return wrong(error.to_string()),
        }
    }
    Ok(())
}

/// Tells whether two columns say the same thing.
fn excludes(one: Quantity, other: Quantity) -> bool {
    use Quantity::{BrakingTorque, NominalPressure, NormalForce, RotationalSpeed, SlidingSpeed};
    let both = |kind: &[Quantity]| kind.contains(&one) && kind.contains(&other);
    one == other || both(&[NormalForce, NominalPressure, BrakingTorque]) || both(&[RotationalSpeed, SlidingSpeed])
}

fn table(columns: Vec<Column>, places: Vec<Origin>) -> CycleTable {
    let mut table = CycleTable { times: Vec::new(), loads: None, speeds: None, road_speeds: None, places };
    for Column { quantity, values, .. } in columns {
        match quantity {
            Quantity::Time => table.times = values,
            Quantity::NormalForce => table.loads = Some(Loads::Force(values)),
            Quantity::NominalPressure => table.loads = Some(Loads::NominalPressure(values)),
            Quantity::BrakingTorque => table.loads = Some(Loads::BrakingTorque(values)),
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
        let table = read_text("\u{feff}\"time [s]\";\"normal_force [N]\"\r\n\r\n0;47,5\r\n0,25;1e1\r\n").unwrap();
        assert_eq!((&table.times, lines(&table)), (&vec![0.0, 0.25], vec![3, 4]));
        assert_eq!(table.loads, Some(Loads::Force(vec![47.5, 10.0])));
        assert_eq!(table.speeds, None);
    }

    #[test]
    fn the_table_is_the_same_in_every_encoding() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("stops.csv");
        let text = "sep=\t\r\n# 20 °C\r\ntime [s]\tnormal_force [N]\r\n0\t47,5\r\n0,25\t1e1\r\n";
        let utf16: Vec<u8> = std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
        let windows: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
        for content in [text.as_bytes(), &utf16, &windows, text.replace("\r\n", "\r").as_bytes()] {
            std::fs::write(&path, content).unwrap();
            let table = read(&path).unwrap();
            assert_eq!((&table.times, lines(&table)), (&vec![0.0, 0.25], vec![4, 5]));
            assert_eq!(table.loads, Some(Loads::Force(vec![47.5, 10.0])));
        }
    }

    #[test]
    fn more_rows_than_are_read_are_refused() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("stops.csv");
        std::fs::write(&path, "time [s]\n\n0\n1\n2\n3\n").unwrap();
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
             braking_torque, rotational_speed, sliding_speed, road_speed"
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
