//! Units as people write them.

use plateau_io::units::{self, Powers};
use pyo3::prelude::*;

use crate::failure::{Failure, Raise};

/// Powers of m, kg, s, rad and K of a unit, and a, b and c: it is 10^a · b / c of the SI unit of these powers.
#[pyfunction]
pub fn scale_of(py: Python<'_>, unit: &str) -> PyResult<(Powers, i32, f64, f64)> {
    units::scale_of(unit).map_err(|error| Failure::input(error).raise(py, &[]))
}
