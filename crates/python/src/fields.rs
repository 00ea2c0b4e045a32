//! Fields of a simulation as memory of Python's own, which stays when the simulation is gone; and heights that Python gives.

use plateau_core::model::memory::Heights;
use plateau_core::observe::{ABSENT, Map, MapValues};
use plateau_core::simulation::{Simulation, SimulationError};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;

use crate::failure::Failure;

/// Bytes of a field, column by column: doubles, or of statuses and bases one byte each.
pub fn bytes(simulation: &mut Simulation, name: &str) -> Result<Vec<u8>, Failure> {
    if name == "pin_base" {
        let mut base: Vec<u8> = simulation.pin_base().iter().map(|base| *base as u8).collect();
        simulation.parameters().mesh.absent_cells().for_each(|cell| base[cell] = ABSENT);
        return Ok(base);
    }
    let map = Map::ALL.into_iter().find(|map| map.name() == name);
    let map = map.ok_or_else(|| Failure::input(format!("there is no field {name}")))?;
    let found = simulation.snapshot(&[map])?.maps.into_iter().next();
    Ok(match found.map(|(_, values)| values) {
        Some(MapValues::Float(values)) => values.iter().flat_map(|value| value.to_ne_bytes()).collect(),
        Some(MapValues::Status(statuses)) => statuses,
        None => Vec::new(),
    })
}

/// The heights of a simulation, some of them replaced by those that Python gives: disc and substrate, pin and substrate.
pub fn heights(simulation: &mut Simulation, given: [Option<Vec<f64>>; 4]) -> Result<Heights, SimulationError> {
    let (disc, pin) = (simulation.disc()?, simulation.pin()?);
    let [disc_height, disc_substrate, pin_height, pin_substrate] = given;
    Ok(Heights {
        disc_height: disc_height.unwrap_or(disc.height),
        disc_substrate: disc_substrate.unwrap_or(disc.substrate),
        pin_height: pin_height.unwrap_or(pin.height),
        pin_substrate: pin_substrate.unwrap_or(pin.substrate),
    })
}

/// Numbers of an array of doubles of Python, in the order of C.
pub fn numbers(array: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    PyBuffer::get(array)?.to_vec(array.py())
}
