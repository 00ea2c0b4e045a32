//! A process on its own.

use plateau_core::comm::CommError;

use crate::failure::Failure;

/// This process, which runs its scene on its own. See the module `ranks` for what the functions are for.
#[derive(Debug)]
pub struct Job;

impl Job {
    pub fn start() -> Result<Self, Failure> {
        Ok(Self)
    }

    pub fn leads(&self) -> bool {
        true
    }

    pub fn agree(&mut self, signal: Option<u8>) -> Result<Option<u8>, CommError> {
        Ok(signal)
    }

    pub fn compare(&mut self, _text: &str) -> Result<(), Failure> {
        Ok(())
    }

    pub fn end(self, result: Result<(), Failure>) -> Result<(), Failure> {
        result
    }
}
