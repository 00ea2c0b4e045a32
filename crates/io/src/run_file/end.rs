//! How a run ended.

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
