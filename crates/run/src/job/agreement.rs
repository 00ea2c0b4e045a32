//! What the processes of a job settle between steps.

/// What the processes of a job settle between steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Agreement {
    /// The signal that asks the run to stop, if there was one.
    pub signal: Option<u8>,
    /// Whether the state is to be kept.
    pub save: bool,
    /// Steps before the next agreement.
    pub steps: u64,
}
