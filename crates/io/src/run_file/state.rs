//! How the run of a run file ended, or that it goes on.

/// What a run file says of how its run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// The run goes on, or it was killed.
    Running,
    /// All steps are done.
    Finished,
    /// The user stopped the run.
    Interrupted,
    /// The run failed; the attribute `error` says why.
    Failed,
}

impl State {
    /// Its name in run files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Finished => "finished",
            Self::Interrupted => "interrupted",
            Self::Failed => "failed",
        }
    }

    /// All of them.
    pub(super) const ALL: [Self; 4] = [Self::Running, Self::Finished, Self::Interrupted, Self::Failed];

    /// The one of that name.
    pub(super) fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|state| state.name() == name)
    }
}
