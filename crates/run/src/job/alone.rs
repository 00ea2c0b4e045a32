//! This process on its own, where the program is built without MPI.

use plateau_core::engine::comm::{CommError, Single};

/// This process, from the start of a job to its end.
#[derive(Debug)]
pub struct Session(());

impl Session {
    /// Starts the job.
    pub fn start() -> Result<Self, CommError> {
        Ok(Self(()))
    }

    /// A way to talk to nobody else.
    pub fn communicator(&self) -> Single {
        Single
    }

    /// Ends the job in good order.
    pub fn finish(self) {}

    /// Ends the job, whose process reports and ends itself as it likes.
    pub fn fail(self, _status: u8, _report: impl FnOnce()) {}
}
