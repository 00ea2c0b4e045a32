//! One worker: its sectors of the disc, the pin's columns over them, and the step that all workers take together.
//!
//! Every worker knows the displacement and all sums, and computes them alike; what differs is which cells it passes over.

mod balance;
mod changes;
mod checkpoint;
mod columns;
mod gather;
mod report;

use std::ops::Range;
use std::sync::Arc;

use crate::engine::coefficients::Coefficients;
use crate::engine::comm::Communicator;
use crate::engine::contact::Contact;
use crate::engine::debris::Debris;
use crate::engine::exact::ExactSum;
use crate::engine::execution::Execution;
use crate::engine::filling::{Filling, relief};
use crate::engine::forecast::Forecast;
use crate::engine::kernel::{
    Bracket, Edge, InstructionSet, Moved, Pass, ReachOf, Read, Reading, Rules, WearColumn, pass, reach_of, read,
    wear_column,
};
use crate::engine::parts::Needs;
use crate::engine::pin_strips::PinStrips;
use crate::engine::quantum::Quantum;
use crate::engine::sector::Partition;
use crate::engine::strips::{DiscSector, strips};
use crate::engine::sums::{RowWeights, Sums};
use crate::model::accounts::{Accounts, StepFacts};
use crate::model::clock::Clock;
use crate::model::clock::StepOperation;
use crate::model::error::SimulationError;
use crate::model::history::{Course, History};
use crate::model::parameters::Parameters;
use crate::model::state::InitialSurfaces;

pub(crate) use columns::{halo_words, waiting_columns};

/// A worker.
#[derive(Debug)]
pub(crate) struct Worker<C> {
    communicator: C,
    parameters: Arc<Parameters>,
    partition: Arc<Partition>,
    instructions: InstructionSet,
    shortcut: bool,
    needs: Needs,
    pass: Pass,
    read: Read,
    wear_column: WearColumn,
    reach_of: ReachOf,
    rules: Rules,
    coefficients: Coefficients,
    /// Of which the overlaps of the coming steps are counted as multiples, by the largest of the last step; of the first,
    /// by the largest that the load allows.
    overlap_quantum: Quantum,
    pin: PinStrips,
    /// The worker's own sectors, by their number.
    sectors: Vec<Option<DiscSector>>,
    contact: Contact,
    forecast: Forecast,
    debris: Debris,
    history: History,
    filling: Filling,
    /// Where the displacement of the coming step is expected; none before the first step.
    bracket: Option<Bracket>,
    /// The pairs of the coming step against it.
    reading: Reading,
    /// What the last pass moved.
    moved: Moved,
    weights: RowWeights,
    /// What all workers read and moved.
    sums: Sums,
    /// What the first pin column over each sector loses; empty where nothing forms.
    edges: Vec<Edge>,
    message: Vec<u64>,
    halo: Vec<u64>,
    /// Σ k A u of the own cells in the last step, if it was watched.
    load: ExactSum,
    /// p of the own pin cells in the last step, column by column, Pa; empty if it was not watched.
    pressure: Vec<f64>,
    course: Course,
    /// Friction, heat and emission, where the scene asks for any.
    accounts: Option<Box<Accounts>>,
    /// f_κ with which the coefficients were made.
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

impl<C: Communicator> Worker<C> {
    /// One worker of those that `communicator` connects, at t = 0, over a disc turned by `turned` columns.
    pub fn new(
        parameters: Arc<Parameters>,
        surfaces: &InitialSurfaces,
        partition: Arc<Partition>,
        execution: Execution,
        turned: u64,
        communicator: C,
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
            wear_column: wear_column(needs),
            reach_of: reach_of(needs),
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
            load: ExactSum::default(),
            pressure: Vec::new(),
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
            self.pressure.clear();
            self.advance(watched && self.course.steps + 1 == step)?;
        }
        Ok(())
    }

    /// Refuses to report pressures of a step that was not watched.
    fn check_watched(&self) -> Result<(), SimulationError> {
        let steps = self.course.steps;
        if steps > 0 && self.pressure.is_empty() { Err(SimulationError::NotWatched { step: steps }) } else { Ok(()) }
    }

    /// One step:
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
            self.record_pressures();
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

    /// What the steps so far were like.
    pub fn course(&self) -> Course {
        Course { contact_area_integral: self.history.integral(), ..self.course }
    }
}
