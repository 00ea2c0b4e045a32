//! What a worker keeps for later, and how it goes on from there.

use super::Worker;
use crate::engine::checkpoint::{Checkpoint, EngineMemory, Memory};
use crate::engine::comm::Communicator;
use crate::engine::error::SimulationError;
use crate::engine::execution::Engine;
use crate::model::parameters::Parameters;

impl<C: Communicator> Worker<C> {
    /// What all workers know alike.
    pub fn memory(&self) -> Memory {
        Memory {
            course: self.course,
            clock: self.clock,
            time_acceleration: self.parameters.time_acceleration,
            account: self.debris.account(),
            history: self.history.clone(),
            accounts: self.accounts.as_ref().map(|accounts| accounts.state().clone()),
            engine: Some(EngineMemory {
                contact: self.contact.clone(),
                forecast: self.forecast.clone(),
                bracket: self.bracket,
                overlap_quantum: self.overlap_quantum,
            }),
        }
    }

    /// Takes over the state of a simulation of the same parameters and surfaces.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), SimulationError> {
        let Memory { course, clock, time_acceleration, account, history, accounts, engine } = checkpoint.memory.clone();
        let Some(EngineMemory { contact, forecast, bracket, overlap_quantum }) = engine else {
            return Err(SimulationError::OtherEngine { found: Engine::Plain, expected: Engine::Fast });
        };
        if let (Some(own), Some(state)) = (&mut self.accounts, accounts) {
            own.restore(state);
        }
        self.accept_coefficients(&Parameters { time_acceleration, ..Parameters::clone(&self.parameters) });
        let rows = self.parameters.mesh.rows();
        let own = self.rows.clone();
        for column in 0..self.parameters.mesh.pin_columns() {
            let cells = rows * column + own.start..rows * column + own.end;
            self.pin.set_column(column, &checkpoint.pin_height[cells.clone()], &checkpoint.pin_substrate[cells]);
        }
        for sector in self.sectors.iter_mut().flatten() {
            for column in 0..sector.columns {
                let start = rows * (sector.first + column);
                let cells = start + own.start..start + own.end;
                sector.set_column(column, &checkpoint.disc_height[cells.clone()], &checkpoint.disc_substrate[cells]);
            }
        }
        (self.course, self.clock) = (course, clock);
        self.filling.measure_all(&self.parameters.mesh, &own, self.sectors.iter().flatten(), course.steps);
        self.debris.set_account(account);
        (self.contact, self.history, self.forecast) = (contact, history, forecast);
        (self.bracket, self.overlap_quantum) = (bracket, overlap_quantum);
        self.pressure.clear();
        // What the last sweep read of the coming step is read again.
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))?;
        self.course = course;
        Ok(())
    }
}
