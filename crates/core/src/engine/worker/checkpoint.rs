//! What a worker keeps for later, and how it goes on from there.

use super::Worker;
use crate::engine::comm::Communicator;
use crate::engine::memory::EngineMemory;
use crate::model::error::SimulationError;
use crate::model::memory::{Heights, Memory};
use crate::model::parameters::Parameters;

impl<C: Communicator> Worker<C> {
    /// What all workers know alike.
    pub fn memory(&self) -> (Memory, EngineMemory) {
        let memory = Memory {
            course: self.course,
            clock: self.clock,
            time_acceleration: self.parameters.time_acceleration,
            account: self.debris.account().clone(),
            history: self.history.clone(),
            accounts: self.accounts.as_ref().map(|accounts| accounts.state().clone()),
        };
        let engine = EngineMemory {
            contact: self.contact.clone(),
            forecast: self.forecast.clone(),
            bracket: self.bracket,
            overlap_quantum: self.overlap_quantum,
        };
        (memory, engine)
    }

    /// Takes over the state of a simulation of the same parameters and surfaces.
    pub fn restore(
        &mut self,
        heights: &Heights,
        memory: &Memory,
        engine: &EngineMemory,
    ) -> Result<(), SimulationError> {
        let Memory { course, clock, time_acceleration, account, history, accounts } = memory.clone();
        let EngineMemory { contact, forecast, bracket, overlap_quantum } = engine.clone();
        if let (Some(own), Some(state)) = (&mut self.accounts, accounts) {
            own.restore(state);
        }
        self.accept_coefficients(&Parameters { time_acceleration, ..Parameters::clone(&self.parameters) });
        let rows = self.parameters.mesh.rows();
        let own = self.rows.clone();
        for column in 0..self.parameters.mesh.pin_columns() {
            let cells = rows * column + own.start..rows * column + own.end;
            self.pin.set_column(column, &heights.pin_height[cells.clone()], &heights.pin_substrate[cells]);
        }
        for sector in self.sectors.iter_mut().flatten() {
            for column in 0..sector.columns {
                let start = rows * (sector.first + column);
                let cells = start + own.start..start + own.end;
                sector.set_column(column, &heights.disc_height[cells.clone()], &heights.disc_substrate[cells]);
            }
        }
        (self.course, self.clock) = (course, clock);
        self.filling.measure_all(&self.parameters.mesh, &own, self.sectors.iter().flatten(), course.steps);
        self.debris.set_account(account);
        (self.contact, self.history, self.forecast) = (contact, history, forecast);
        (self.bracket, self.overlap_quantum) = (bracket, overlap_quantum);
        self.pressure.clear();
        // What the last pass read of the coming step is read again.
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))?;
        self.course = course;
        Ok(())
    }
}
