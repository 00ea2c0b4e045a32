//! Values that are rows: those of a cycle, and those of a factor over temperature.

use plateau_core::model::heat::factor::{Factor, FactorError};

use super::cycle_table::{CycleTable, Loads, Speeds};
use super::document::{Entry, Value};
use super::error::Origin;
use super::quantity::{at, number, quantity};
use super::schema::Range;
use crate::units::Dimension;
use crate::units::Dimension::{Force, Pressure, RotationalSpeed, Speed, Time};

/// Rows of time, load and speed as a scene gives them.
pub(super) fn cycle(list: &[Entry]) -> Result<CycleTable, (Origin, String)> {
    let (mut forces, mut pressures, mut rotations, mut slides) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut times, mut places) = (Vec::new(), Vec::new());
    for entry in list {
        let fail = |message: String| (entry.origin.clone(), message);
        let Value::Array(row) = &entry.value else {
            return Err(fail(format!("{}, expected a row such as [\"0 s\", \"47 N\", \"850 rpm\"]", entry.value)));
        };
        let [time, load, speed] = row.as_slice() else {
            return Err(fail(format!("a row of {} values, expected three: time, load, speed", row.len())));
        };
        let value = |entry: &Entry, dimension| quantity(&entry.value, dimension, Range::NOT_NEGATIVE);
        times.push(value(time, Time).map_err(at(time))?);
        match (value(load, Force), value(load, Pressure)) {
            (_, Ok(pressure)) => pressures.push(pressure),
            (force, Err(_)) => forces.push(force.map_err(at(load))?),
        }
        match (value(speed, RotationalSpeed), value(speed, Speed)) {
            (_, Ok(slide)) => slides.push(slide),
            (rotation, Err(_)) => rotations.push(rotation.map_err(at(speed))?),
        }
        let mixed = |one: usize, other: usize| one > 0 && other > 0;
        if mixed(forces.len(), pressures.len()) {
            return Err(at(load)("a load of another kind than in the rows above: give forces or pressures".to_owned()));
        }
        if mixed(rotations.len(), slides.len()) {
            let message = "a speed of another kind than in the rows above: give rotational speeds or sliding speeds";
            return Err(at(speed)(message.to_owned()));
        }
        places.push(entry.origin.clone());
    }
    let loads = if forces.is_empty() { Loads::NominalPressure(pressures) } else { Loads::Force(forces) };
    let speeds = if rotations.is_empty() { Speeds::Sliding(slides) } else { Speeds::Rotational(rotations) };
    Ok(CycleTable { times, loads: Some(loads), speeds: Some(speeds), road_speeds: None, places })
}

/// Rows of temperature and factor.
pub(super) fn factor(list: &[Entry]) -> Result<Factor, (Origin, String)> {
    let mut points = Vec::with_capacity(list.len());
    for entry in list {
        let expected = "expected a temperature and a factor such as [\"230 degC\", 1.0]";
        let Value::Array(row) = &entry.value else {
            return Err(at(entry)(format!("{}, {expected}", entry.value)));
        };
        let [temperature, factor] = row.as_slice() else {
            return Err(at(entry)(format!("a row of {} values, {expected}", row.len())));
        };
        let kelvin = quantity(&temperature.value, Dimension::Temperature, Range::POSITIVE).map_err(at(temperature))?;
        points.push((kelvin, number(&factor.value, Range::NOT_NEGATIVE).map_err(at(factor))?));
    }
    Factor::new(points).map_err(|error| {
        let (FactorError::Order { point, .. } | FactorError::Value { point, .. }) = error;
        (list[point].origin.clone(), error.to_string())
    })
}
