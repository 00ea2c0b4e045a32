//! How a run ended, and what there was of it when it was stopped before.

use std::time::Duration;

/// What a run file holds of a run that goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Earlier {
    /// Samples.
    pub samples: usize,
    /// Moments of which there are maps.
    pub snapshots: usize,
    /// Wall time of the run so far.
    pub wall_time: Duration,
}

/// How a run ended: the `state` of its run file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// All steps are done.
    Finished,
    /// The user stopped the run; what was done is written.
    Interrupted,
    /// The run failed; the message goes to the attribute `error`.
    Failed(String),
}

impl End {
    /// Value of the attribute `state`.
    pub(super) fn state(&self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Interrupted => "interrupted",
            Self::Failed(_) => "failed",
        }
    }
}
