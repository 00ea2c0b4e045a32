//! The two ways in which the steps of the model are taken.

use std::fmt;

/// What takes the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Engine {
    /// Eight cells at a time, on any number of workers: one pass over the pin a step.
    #[default]
    Fast,
    /// The plain model, cell by cell ([`crate::model`]), on one worker: the same results but for rounding, slowly.
    Plain,
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fast => "fast",
            Self::Plain => "plain",
        })
    }
}
