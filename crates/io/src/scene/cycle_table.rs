//! Tables of load and speed over time (docs/drive.md): text with one row a moment, as instruments and spreadsheets write it.
//!
//! A header has the name of its quantity, or one that the scene says, and its unit in brackets. Times may be those of a clock,
//! h:mm:ss, and count from the first.

use std::mem::discriminant;
use std::path::Path;
use std::sync::Arc;

use super::error::{Origin, Problem};
use super::schema::BRAKING_TORQUE;
use crate::delimited::{self, Fault, Line, Named};
use crate::limits;
use crate::text::short;
use crate::units::{self, Dimension};

/// Load, as it is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// F, N.
    Force,
    /// F over the area of the pin's mesh, Pa.
    NominalPressure,
    /// T that friction has to give, N m.
    BrakingTorque,
    /// The same of the whole brake, N m.
    BrakeTorque,
    /// In the brake line, Pa.
    BrakePressure,
}

/// Speed of the disc, as it is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DiscSpeed {
    /// ω, rad/s.
    Rotational,
    /// At the mean radius, m/s.
    Sliding,
}

/// Quantity of a column; a table has one of each kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Time,
    Load(Load),
    DiscSpeed(DiscSpeed),
    RoadSpeed,
}

/// Name in the header, quantity and dimension of every column there is.
const COLUMNS: [(&str, Quantity, Dimension); 9] = [
    ("time", Quantity::Time, Dimension::Time),
    ("normal_force", Quantity::Load(Load::Force), Dimension::Force),
    ("nominal_pressure", Quantity::Load(Load::NominalPressure), Dimension::Pressure),
    (BRAKING_TORQUE, Quantity::Load(Load::BrakingTorque), Dimension::Torque),
    ("brake_torque", Quantity::Load(Load::BrakeTorque), Dimension::Torque),
    ("brake_pressure", Quantity::Load(Load::BrakePressure), Dimension::Pressure),
    ("rotational_speed", Quantity::DiscSpeed(DiscSpeed::Rotational), Dimension::RotationalSpeed),
    ("sliding_speed", Quantity::DiscSpeed(DiscSpeed::Sliding), Dimension::Speed),
    ("road_speed", Quantity::RoadSpeed, Dimension::Speed),
];

/// A table, in SI units; what it has no column of is constant.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleTable {
    /// t of every row, s, from that of the first.
    pub times: Vec<f64>,
    /// Time of the first row as the table has it, s.
    pub start: f64,
    /// Load of every row.
    pub loads: Option<(Load, Vec<f64>)>,
    /// Speed of the disc in every row.
    pub speeds: Option<(DiscSpeed, Vec<f64>)>,
    /// Speed of the vehicle, m/s.
    pub road_speeds: Option<Vec<f64>>,
    /// Origin of every row.
    pub places: Vec<Origin>,
}

/// A column of a table that is being read.
struct Column {
    place: usize,
    header: String,
    unit: String,
    quantity: Quantity,
    dimension: Dimension,
    values: Vec<f64>,
}

/// Problem, with the header of the column if it is of one.
type Wrong = (Option<String>, Fault);

/// Reads a table of at most so many rows, whose columns have these headers, each beside the name of its quantity; without any they have
/// those names.
pub fn read(path: &Path, headers: &[(&str, &str)], most: usize) -> Result<CycleTable, Problem> {
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
    let mut columns = header(&table.head, headers).map_err(wrong)?;
    let mut places = Vec::new();
    for row in table.rows() {
        let row = row.map_err(|fault| wrong((None, fault)))?;
        if places.len() == most {
            return Err(wrong((None, row.fault(0, limits::more("more", most, "rows")))));
        }
        take(&row, table.head.cells.len(), &mut columns).map_err(wrong)?;
        places.push(origin(row.number, 1));
    }
    Ok(self::table(columns, places))
}

/// Name and unit of a header; without brackets there is no unit.
fn name_and_unit(header: &str) -> (&str, &str) {
    let header = header.trim();
    let brackets = [('[', ']'), ('(', ')')].into_iter().find(|(_, close)| header.ends_with(*close));
    match brackets.and_then(|(open, close)| header.strip_suffix(close)?.rsplit_once(open)) {
        Some((name, unit)) => (name.trim(), unit.trim()),
        None => (header, ""),
    }
}

/// Unit of times that are those of a clock.
const CLOCK: &str = "h:mm:ss";

/// The columns that the header names, or what is wrong with one of the names.
fn header(line: &Line<'_>, headers: &[(&str, &str)]) -> Result<Vec<Column>, Wrong> {
    let mut columns: Vec<Column> = Vec::new();
    let mut found = vec![false; headers.len()];
    for (place, cell) in line.cells.iter().enumerate() {
        let header = &*cell.text;
        let wrong = |message: String| Err((Some(header.to_owned()), line.fault(place, message)));
        let (mut name, mut unit) = name_and_unit(header);
        if !headers.is_empty() {
            // The whole header first: there may be several of a name.
            let whole = |other: &str| other.trim() == header.trim();
            let is_whole = |other: &str| line.cells.iter().any(|cell| cell.text.trim() == other.trim());
            let is_of = |other: &str| whole(other) || !is_whole(other) && name_and_unit(other).0 == name;
            let Some(which) = headers.iter().position(|(_, other)| is_of(other)) else { continue };
            found[which] = true;
            let told = name_and_unit(headers[which].1).1;
            if !unit.is_empty() && !told.is_empty() && unit != told {
                return wrong(format!("in {unit}, and the scene says {told}: expected one unit"));
            }
            name = headers[which].0;
            unit = if unit.is_empty() { told } else { unit };
        }
        let name = name.to_lowercase().replace(' ', "_");
        let Some((_, quantity, dimension)) = COLUMNS.iter().find(|(known, ..)| *known == name) else {
            let known: Vec<_> = COLUMNS.iter().map(|(name, ..)| *name).collect();
            return wrong(format!(
                "no such column, expected some of {}, or operation.cycle.columns, such as columns = {{ time = \"Zeit\" }}",
                known.join(", ")
            ));
        };
        let is_clock = *quantity == Quantity::Time && ["", CLOCK, "hh:mm:ss"].contains(&unit);
        let unit = if is_clock { CLOCK } else { unit };
        if let (false, Err(error)) = (is_clock, units::parse(&format!("1 {unit}"), *dimension)) {
            return wrong(format!("{error}; give the unit in brackets, such as {name} [{}]", dimension.si_unit()));
        }
        if let Some(other) = columns.iter().find(|other| discriminant(&other.quantity) == discriminant(quantity)) {
            return wrong(format!("stands beside {}, expected one of the two", other.header));
        }
        let (header, unit) = (header.to_owned(), unit.to_owned());
        columns.push(Column { place, header, unit, quantity: *quantity, dimension: *dimension, values: Vec::new() });
    }
    if let Some(missing) = found.iter().position(|found| !found) {
        let known: Vec<_> = line.cells.iter().map(|cell| format!("\"{}\"", short(&cell.text))).collect();
        let (name, header) = headers[missing];
        let message = format!("no column \"{header}\", which is to be {name}; there are {}", known.join(", "));
        return Err((None, line.fault(0, message)));
    }
    if columns.iter().all(|column| column.quantity != Quantity::Time) {
        return Err((None, line.fault(0, "no column of times, expected time [s]".into())));
    }
    Ok(columns)
}

/// A time of a clock, h:mm:ss, in s.
fn clock(field: &str) -> Option<f64> {
    let [hours, minutes, seconds] = field.split(':').collect::<Vec<_>>().try_into().ok()?;
    let whole = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit()).then(|| part.parse::<u32>().ok()).flatten();
    let is_number = seconds.starts_with(|first: char| first.is_ascii_digit());
    let seconds = seconds.replace(',', ".").parse::<f64>().ok().filter(|value| is_number && *value < 60.0)?;
    let minutes = whole(minutes).filter(|minutes| *minutes < 60)?;
    Some(f64::from(whole(hours)?) * 3600.0 + f64::from(minutes) * 60.0 + seconds)
}

/// Takes in a row of at most so many fields, or tells what is wrong with it, in which column.
fn take(row: &Line<'_>, fields: usize, columns: &mut [Column]) -> Result<(), Wrong> {
    if row.cells.len() > fields {
        let message = format!("{} fields, expected {fields}, one for each column", row.cells.len());
        return Err((None, row.fault(fields, message)));
    }
    for column in columns {
        let place = column.place;
        let field = row.cells.get(place).map_or("", |cell| &*cell.text);
        let wrong = |message: String| Err((Some(column.header.clone()), row.fault(place, message)));
        if field.is_empty() {
            return wrong("no value, expected a number in every row".into());
        }
        if column.unit == CLOCK {
            let Some(time) = clock(field) else {
                let found = short(field).escape_debug().to_string();
                return wrong(format!(
                    "found \"{found}\" without a unit, expected a header such as time [s], or times as {CLOCK}"
                ));
            };
            column.values.push(time);
            continue;
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

fn table(columns: Vec<Column>, places: Vec<Origin>) -> CycleTable {
    let mut table = CycleTable { times: Vec::new(), start: 0.0, loads: None, speeds: None, road_speeds: None, places };
    for Column { quantity, values, .. } in columns {
        match quantity {
            Quantity::Time => {
                table.start = values.first().copied().unwrap_or_default();
                table.times = values.into_iter().map(|time| time - table.start).collect();
            }
            Quantity::Load(load) => table.loads = Some((load, values)),
            Quantity::DiscSpeed(speed) => table.speeds = Some((speed, values)),
            Quantity::RoadSpeed => table.road_speeds = Some(values),
        }
    }
    table
}

#[cfg(test)]
#[path = "../../tests/unit/scene/cycle_table.rs"]
mod tests;
