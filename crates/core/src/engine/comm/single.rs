//! A worker on its own.

use super::{CommError, Communicator};

/// Nobody else to talk to.
#[derive(Debug, Clone, Copy)]
pub struct Single;

impl Communicator for Single {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn send_halo(&mut self, _boundary: usize, to: usize, _words: &[u64]) -> Result<(), CommError> {
        unreachable!("worker {to} of one")
    }

    fn receive_halo(&mut self, _boundary: usize, from: usize, _words: &mut [u64]) -> Result<(), CommError> {
        unreachable!("worker {from} of one")
    }

    fn all_gather(&mut self, words: &[u64], each: &mut dyn FnMut(usize, &[u64])) -> Result<(), CommError> {
        each(0, words);
        Ok(())
    }
}
