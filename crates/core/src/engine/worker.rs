//! One worker: its sectors of the disc, the pin's columns over them, and the step that all workers take together.
//!
//! Every worker knows the displacement and all sums, and computes them alike; what differs is which cells it passes over.

mod balance;
mod columns;
mod report;

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::engine::coefficients::Coefficients;
use crate::engine::comm::Communicator;
use crate::engine::contact::Contact;
use crate::engine::debris::Debris;
use crate::engine::exact::Quantum;
use crate::engine::execution::Execution;
use crate::engine::filling::{Filling, relief};
use crate::engine::forecast::Forecast;
use crate::engine::kernel::{
    Bracket, Edge, EdgeOf, InstructionSet, Moved, NearPair, Pass, Read, Reading, Rules, edge_of, pass, read,
};
use crate::engine::parts::Needs;
use crate::engine::sector::Partition;
use crate::engine::strips::{DiscSector, PinStrips, strips};
use crate::engine::sums::{RowWeights, Sums};
use crate::model::accounts::{Accounts, StepFacts};
use crate::model::clock::{Clock, Operation, StepOperation};
use crate::model::error::SimulationError;
use crate::model::memory::{Course, Heights, History, Memory};
use crate::model::parameters::Parameters;
use crate::model::state::InitialSurfaces;
pub(crate) use columns::{halo_words, waiting_columns};

/// State that the engine keeps from step to step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct EngineMemory {
    pub contact: Contact,
    pub forecast: Forecast,
    pub bracket: Option<Bracket>,
    pub overlap_quantum: Quantum,
}

#[derive(Debug)]
pub(crate) struct Worker {
    communicator: Box<dyn Communicator>,
    parameters: Arc<Parameters>,
    partition: Arc<Partition>,
    instructions: InstructionSet,
    shortcut: bool,
    needs: Needs,
    pass: Pass,
    read: Read,
    edge_of: EdgeOf,
    rules: Rules,
    coefficients: Coefficients,
    /// Quantum of the overlaps of the coming steps, m, by the largest of the last step; of the first, by the largest that the load
    /// allows.
    overlap_quantum: Quantum,
    pin: PinStrips,
    /// The worker's own sectors, by their number.
    sectors: Vec<Option<DiscSector>>,
    contact: Contact,
    forecast: Forecast,
    debris: Debris,
    history: History,
    filling: Filling,
    /// Displacements between which the next load balance is expected; none before the first step.
    bracket: Option<Bracket>,
    /// Reading of the pairs of the coming step against the bracket.
    reading: Reading,
    /// Heights that the last pass moved.
    moved: Moved,
    weights: RowWeights,
    /// Sums of what all workers read and moved.
    sums: Sums,
    /// Heights and losses of the first pin columns over each sector; empty where nothing forms.
    edges: Vec<Edge>,
    message: Vec<u64>,
    halo: Vec<u64>,
    /// The own pairs that touched in the last step that was watched: of a step pressures are seldom asked for.
    touching: Vec<NearPair>,
    /// True if the last step was watched.
    is_watched: bool,
    course: Course,
    /// Friction, heat and emission, where the scene asks for any.
    accounts: Option<Box<Accounts>>,
    /// Factor f_κ with which the coefficients were made, 1.
    wear_rate_factor: f64,
    clock: Clock,
    /// Load and time of the step that is being taken, or was taken last.
    operation: StepOperation,
    /// Columns by which the disc was turned before the first step.
    turned: u64,
    /// The group of workers that shares the worker's sectors.
    group: usize,
    /// The worker's band of them.
    band: usize,
    /// The rows of that band.
    rows: Range<usize>,
}

impl Worker {
    /// One worker of those that `communicator` connects, at t = 0, over a disc turned by `turned` columns.
    pub fn new(
        parameters: Arc<Parameters>,
        surfaces: &InitialSurfaces,
        partition: Arc<Partition>,
        execution: Execution,
        turned: u64,
        communicator: Box<dyn Communicator>,
    ) -> Self {
        let mesh = &parameters.mesh;
        let needs = Needs::of(&parameters);
        let coefficients = Coefficients::new(&parameters);
        let (group, band) = (partition.group_of(communicator.rank()), partition.band_of(communicator.rank()));
        let rows = partition.rows_of(band);
        let own = |sector| {
            let columns = partition.columns(sector);
            let heights = &surfaces.disc_height[columns.start * mesh.rows()..columns.end * mesh.rows()];
            let is_own = partition.group(sector) == group;
            is_own.then(|| DiscSector::new(mesh, rows.clone(), columns.start, heights, needs.forms))
        };
        let sectors: Vec<_> = (0..partition.sectors()).map(own).collect();
        let strips = strips(rows.len());
        let filling = Filling::new(mesh, rows.clone(), surfaces, sectors.iter().flatten());
        let weights = RowWeights::new(&parameters, &coefficients, rows.clone(), relief(mesh, surfaces));
        let quantum =
            Quantum::of(parameters.largest_load() / coefficients.least_plateau_stiffness(), mesh.pin_columns());
        let largest_stiffness_number = parameters.first_stiffness_number();
        let by_status = parameters.friction.is_some_and(|friction| friction.depends_on_status());
        let mut worker = Self {
            instructions: execution.instructions,
            shortcut: execution.shortcut,
            needs,
            pass: pass(needs),
            read: read(needs),
            edge_of: edge_of(needs),
            rules: Rules::new(&parameters, &coefficients, filling.reference_height(), execution.shortcut),
            contact: Contact::new(&weights, by_status),
            overlap_quantum: quantum,
            pin: PinStrips::new(mesh, rows.clone(), &surfaces.pin_height, &surfaces.pin_base, needs),
            forecast: Forecast::new(mesh.disc_columns()),
            debris: Debris::new(&parameters, &coefficients, &weights),
            history: History::new(mesh.disc_columns()),
            filling,
            edges: vec![Edge::default(); if needs.forms { partition.sectors() } else { 0 }],
            bracket: None,
            reading: Reading::new(rows.start, strips, needs.distinct),
            moved: Moved::new(strips, needs.forms, needs.distinct),
            sums: Sums::default(),
            weights,
            message: Vec::new(),
            halo: Vec::new(),
            touching: Vec::new(),
            is_watched: false,
            course: Course { largest_stiffness_number, ..Course::default() },
            accounts: Accounts::of(&parameters).map(Box::new),
            wear_rate_factor: 1.0,
            clock: parameters.clock(),
            operation: parameters.operation_of(1, &parameters.clock()),
            turned,
            group,
            band,
            rows,
            coefficients,
            sectors,
            partition,
            communicator,
            parameters,
        };
        if worker.accounts.as_ref().is_some_and(|accounts| accounts.wear_rate_factor() != 1.0) {
            worker.accept_coefficients(&worker.parameters.clone());
        }
        worker
    }

    /// Takes steps until `step` of them are done; the last may be watched, for a sample or maps of pressure to follow.
    pub fn advance_to(&mut self, step: u64, watched: bool) -> Result<(), SimulationError> {
        while self.course.steps < step {
            self.is_watched = false;
            self.advance(watched && self.course.steps + 1 == step)?;
        }
        Ok(())
    }

    /// Refuses to report pressures of a step that was not watched.
    fn check_watched(&self) -> Result<(), SimulationError> {
        let steps = self.course.steps;
        if steps > 0 && !self.is_watched { Err(SimulationError::NotWatched { step: steps }) } else { Ok(()) }
    }

    /// Takes one step:
    ///
    /// | model | what happens | where |
    /// |---|---|---|
    /// | 4.1 | the displacement that carries the load | [`Contact::balance`] |
    /// | 4.2, 4L | wear and formation in every cell | [`crate::engine::wear`], [`crate::engine::kernel`] |
    /// | 4.1 | the pairs of the next step against where its displacement is expected | [`crate::engine::kernel`] |
    /// | 4L | debris balance | [`Debris::settle`] |
    /// | 10, 11, 12 | friction, heat and emission | [`Accounts`] |
    /// | 4.6 | the disc turns by one column | |
    fn advance(&mut self, watched: bool) -> Result<(), SimulationError> {
        self.begin_accounts()?;
        let step = self.course.steps + 1;
        let friction = self.accounts.as_deref().and_then(Accounts::friction_coefficient);
        self.operation = self.parameters.operation_by(step, &self.clock, friction)?;
        let largest_overlap = self.balance()?;
        if watched {
            self.record_touching();
        }
        let touching = || self.contact.touching_pairs(&self.sums, &self.reading.near);
        self.debris.prepare(&self.contact, largest_overlap, touching);
        self.forecast.record(self.contact.displacement());
        let bracket = self.pass_over_columns()?;
        self.gather_pass(&bracket)?;
        self.bracket = Some(bracket);
        let moved = self.debris.settle(&self.weights, &self.contact, &self.sums);
        self.course.contact_area = self.contact.area();
        self.history.record(self.course.contact_area, &self.operation);
        self.course.steps = step;
        self.course.load = self.operation.load;
        self.course.time = self.operation.end;
        if let Some(accounts) = &mut self.accounts {
            accounts.record(&StepFacts {
                number: self.course.steps,
                angle: self.parameters.step_angle(),
                operation: &self.operation,
                contact: &self.contact.sums(self.operation.load),
                moved: &moved,
            });
        }
        Ok(())
    }

    /// The disc column under pin column 0 in the coming step.
    fn first(&self) -> usize {
        self.parameters.mesh.disc_column(0, self.turned + self.course.steps)
    }

    /// The disc column under pin column 0 in the last step; before the first, in that.
    fn last_first(&self) -> usize {
        self.parameters.mesh.disc_column(0, self.turned + self.course.steps.saturating_sub(1))
    }

    /// Returns the summary of the steps so far.
    pub fn course(&self) -> Course {
        Course { contact_area_integral: self.history.integral(), ..self.course }
    }

    /// Has the accounts take the pauses before the coming step, and takes over the wear rates that hold in it.
    fn begin_accounts(&mut self) -> Result<(), SimulationError> {
        let Some(accounts) = &mut self.accounts else { return Ok(()) };
        accounts.begin(self.course.steps + 1, self.parameters.step_angle());
        if accounts.wear_rate_factor() == self.wear_rate_factor {
            return Ok(());
        }
        self.accept_coefficients(&self.parameters.clone());
        // The sums of the coming step were taken with the weights of before. No bracket has missed, so this is not
        // counted; and who goes on from a checkpoint has read them again anyway.
        let extra_readings = self.course.extra_readings;
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))?;
        self.course.extra_readings = extra_readings;
        Ok(())
    }

    /// Has the coming steps stand for `acceleration` revolutions each, in place of what it was so far (model 4.6).
    pub fn accelerate(&mut self, acceleration: f64) -> Result<(), SimulationError> {
        let parameters = self.parameters.accelerated(acceleration, self.course.steps);
        self.clock = self.clock.changed(self.course.steps, parameters.step_time());
        self.accept_coefficients(&parameters);
        // The sums of the coming step were taken with the weights of before.
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))
    }

    /// Has the coming steps taken under another load and at another speed.
    pub fn operate(&mut self, operation: &Operation) -> Result<(), SimulationError> {
        let parameters = self.parameters.under(operation);
        self.clock = self.clock.changed(self.course.steps, parameters.step_time());
        if parameters.largest_load() <= self.weights.largest_load {
            self.parameters = Arc::new(parameters);
            return Ok(());
        }
        self.accept_coefficients(&parameters);
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))
    }

    /// Makes everything that depends on the acceleration, and on wear rates that change with temperature, anew.
    fn accept_coefficients(&mut self, parameters: &Parameters) {
        self.parameters = Arc::new(parameters.clone());
        self.wear_rate_factor = self.accounts.as_deref().map_or(1.0, Accounts::wear_rate_factor);
        let now = match self.wear_rate_factor {
            1.0 => self.parameters.clone(),
            factor => Arc::new(parameters.with_wear_rate_factor(factor)),
        };
        self.course.largest_stiffness_number = self.course.largest_stiffness_number.max(now.stiffness_number());
        self.coefficients = Coefficients::new(&now);
        self.rules = Rules::new(&now, &self.coefficients, self.filling.reference_height(), self.shortcut);
        self.weights = RowWeights::new(&now, &self.coefficients, self.rows.clone(), self.weights.relief);
        self.debris.set_coefficients(&self.coefficients);
    }

    /// Returns the state that all workers know alike.
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
        self.is_watched = false;
        self.touching.clear();
        // What the last pass read of the coming step is read again.
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))?;
        self.course = course;
        Ok(())
    }

    /// Gathers the sums over all workers after a pass that read the next step against a bracket.
    fn gather_pass(&mut self, bracket: &Bracket) -> Result<(), SimulationError> {
        self.sums.take_reading(&self.weights, &self.reading, bracket);
        if let Some(taken) = &self.bracket {
            self.sums.take_moved(&self.weights, &self.moved, taken, self.contact.displacement());
        }
        self.exchange(true)
    }

    /// Gathers the sums over all workers after the coming step was read once more.
    fn gather_reading(&mut self, bracket: &Bracket) -> Result<(), SimulationError> {
        self.sums.take_reading(&self.weights, &self.reading, bracket);
        self.exchange(false)
    }

    /// Adds the sums of the other workers to one's own.
    fn exchange(&mut self, moved: bool) -> Result<(), SimulationError> {
        if self.communicator.size() == 1 {
            return Ok(());
        }
        let own = self.communicator.rank();
        let Self { communicator, message, reading, sums, weights, .. } = self;
        message.clear();
        write_near(message, reading);
        sums.write_reading(weights, message);
        if moved {
            sums.write_moved(message);
        }
        communicator.all_gather(message, &mut |from, words| {
            if from != own {
                let mut words = words.iter().copied();
                add_near(&mut words, reading);
                sums.add_reading(weights, &mut words);
                if moved {
                    sums.add_moved(&mut words);
                }
            }
        })?;
        Ok(())
    }
}

fn write_near(message: &mut Vec<u64>, reading: &Reading) {
    message.push(reading.largest().to_bits());
    message.push(reading.near.len() as u64);
    for near in &reading.near {
        message.extend([
            near.gap.to_bits(),
            u64::from(near.column) << 40 | u64::from(near.row) << 8 | u64::from(near.pair),
        ]);
    }
}

fn add_near(words: &mut impl Iterator<Item = u64>, reading: &mut Reading) {
    let mut next = || words.next().unwrap_or(0);
    reading.largest.0[0] = reading.largest.0[0].max(f64::from_bits(next()));
    for _ in 0..next() {
        let (gap, cell) = (next(), next());
        let (column, row) = ((cell >> 40) as u32, (cell >> 8) as u32);
        reading.near.push(NearPair { gap: f64::from_bits(gap), row, column, pair: cell as u8 });
    }
}
