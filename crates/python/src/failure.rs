//! Failures as exceptions of the package, with the texts of the program.

pub use plateau_run::Failure;
use pyo3::prelude::*;

/// Makes the exception of a failure; `about` are the files that the message may begin with.
pub fn raise(py: Python<'_>, about: &[&str], failure: Failure) -> PyErr {
    let error_of = py.import("plateau.errors").and_then(|errors| errors.getattr("error_of"));
    let message = failure.message.unwrap_or_default();
    let made = error_of.and_then(|error_of| error_of.call1((message, (), failure.status, about)));
    made.map_or_else(|error| error, PyErr::from_value)
}
