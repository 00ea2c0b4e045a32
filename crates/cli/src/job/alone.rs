//! A process on its own.

use plateau_core::engine::comm::CommError;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::{Execution, Simulation, SimulationError};

use super::share::Hand;
use super::{Agreement, Went};
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

    pub fn ranks(&self) -> usize {
        1
    }

    pub fn simulation(
        &self,
        parameters: Parameters,
        surfaces: InitialSurfaces,
        execution: Execution,
    ) -> Result<Simulation, SimulationError> {
        Simulation::with_execution(parameters, surfaces, execution)
    }

    pub fn agree(&mut self, own: Agreement) -> Result<Agreement, CommError> {
        Ok(own)
    }

    pub fn compare(&mut self, _text: &str) -> Result<(), Failure> {
        Ok(())
    }

    pub fn share(
        &mut self,
        pieces: &[usize],
        jobs: usize,
        most_failures: Option<usize>,
        work: &(dyn Fn(usize) -> Went + Sync),
    ) -> Result<(), Failure> {
        Hand::new(pieces, most_failures).share(jobs, work).map_err(Failure::run)
    }

    pub fn sum(&mut self, one: usize, other: usize) -> Result<(usize, usize), Failure> {
        Ok((one, other))
    }

    pub fn end(self, result: Result<(), Failure>) -> Result<(), Failure> {
        result
    }
}
