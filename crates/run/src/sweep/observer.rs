//! Who follows the runs of a study.

use std::fmt::Display;
use std::path::Path;

/// Follows the runs of a study and may stop them; called from several threads at a time. `()` observes nothing.
pub trait SweepObserver: Sync {
    /// Told what deserves attention though the runs go on.
    fn warning(&self, _message: &dyn Display) {}

    /// Told what is worth knowing.
    fn note(&self, _message: &dyn Display) {}

    /// Told that so many steps of all runs together were taken since the last time.
    fn steps(&self, _count: u64) {}

    /// Told that a run ended.
    fn run_ended(&self, _failed: bool) {}

    /// Told that no more runs are made.
    fn ends(&self) {}

    /// The number of the signal that asks the runs to stop, if one does. Looked at about ten times a second in each run; a run leaves
    /// its state, from which the next sweep continues it.
    fn asked_to_stop(&self) -> Option<u8> {
        None
    }

    /// Advice, in messages, on how runs of a study are made again.
    fn retry_advice(&self, _study: &Path) -> String {
        "`retry` makes them again".to_owned()
    }
}

impl SweepObserver for () {}
