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
#[path = "../../tests/unit/scene/cycle_table.rs"]
mod tests;
