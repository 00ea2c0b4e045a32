//! The description of a surface, where there is memory for it, and the units in which its parameters are given.

use plateau_core::surface::describe::{Description, Grid, PARAMETERS, Parameter, Unit};
use plateau_io::memory::refuse_beyond;
use serde::ser::{Serialize, Serializer};

use crate::failure::Failure;

/// Describes the heights of a surface of that name; none if no point has one.
///
/// # Errors
/// [`Failure`] where that needs more memory than there is.
pub(super) fn describe(name: &str, grid: &Grid) -> Result<Option<Description>, Failure> {
    let Grid { columns, rows, .. } = *grid;
    refuse_beyond(Description::memory_needed(columns, rows)).map_err(|no_room| {
        Failure::input(format!(
            "{name}: its {columns} x {rows} points can be read, but to describe them needs {no_room}; give a coarser surface, or a part of it"
        ))
    })?;
    Ok(Description::of(grid))
}

/// What a parameter is given in, and by how much its SI value is multiplied.
pub fn scale(parameter: &Parameter) -> (&'static str, f64) {
    match parameter.unit {
        Unit::Height | Unit::Length => ("um", 1e6),
        Unit::Number => ("1", 1.0),
        Unit::Percent => ("%", 100.0),
        Unit::Angle => ("deg", 180.0 / std::f64::consts::PI),
    }
}

/// The parameters of a surface by their symbols, each in its unit.
pub fn parameters(description: &Description) -> impl Iterator<Item = (&'static str, f64)> + '_ {
    PARAMETERS
        .iter()
        .filter_map(|parameter| Some((parameter.symbol, (parameter.value)(description)? * scale(parameter).1)))
}

/// The unit of every number of a document about a surface that has one.
pub struct Units;

impl Serialize for Units {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let lengths = ["pitch", "size"].map(|name| (name, "um"));
        let numbers = ["coverage", "Str_below"].map(|name| (name, "1"));
        let parameters = PARAMETERS.iter().map(|parameter| (parameter.symbol, scale(parameter).0));
        serializer.collect_map(lengths.into_iter().chain(numbers).chain(parameters))
    }
}
