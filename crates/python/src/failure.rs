//! Failures as exceptions of the package, with the texts of the program.

pub use plateau_run::Failure;
use pyo3::prelude::*;

/// Raises failures in Python.
pub trait Raise {
    /// The exception; `about` are the files that the message may begin with.
    fn raise(self, py: Python<'_>, about: &[&str]) -> PyErr;
}

impl Raise for Failure {
    fn raise(self, py: Python<'_>, about: &[&str]) -> PyErr {
        let error_of = py.import("plateau.errors").and_then(|errors| errors.getattr("error_of"));
        let message = self.message.unwrap_or_default();
        let made = error_of.and_then(|error_of| error_of.call1((message, (), self.status, about)));
        made.map_or_else(|error| error, PyErr::from_value)
    }
}
