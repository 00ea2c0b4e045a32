//! The plain model as a simulation: steps, samples and maps in place of the engine's.

use std::sync::Arc;

use crate::model::accounts::{Accounts, AccountsReport, StepFacts};
use crate::model::clock::{Clock, Operation};
use crate::model::error::SimulationError;
use crate::model::material::Status;
use crate::model::memory::{Course, Heights, History, Memory};
use crate::model::parameters::Parameters;
use crate::model::state::InitialSurfaces;
use crate::model::sums::RunningSum;
use crate::model::totals::{Account, Totals};
use crate::model::{State, Step, step};
use crate::observe::{Map, MapValues, Sample, Snapshot};

/// A simulation that takes [`step::advance`] for every step.
#[derive(Debug)]
pub(crate) struct Plain {
    parameters: Arc<Parameters>,
    state: State,
    /// The last step, if it was watched.
    last: Option<Step>,
    totals: Totals,
    history: History,
    course: Course,
    clock: Clock,
    /// Open volume V(0), m³.
    initial_volume: f64,
    /// Initial heights of disc and pin, m.
    initial_heights: [Vec<f64>; 2],
    accounts: Option<Accounts>,
    /// The parameters with the wear rates that hold now.
    worn_with: Arc<Parameters>,
}

impl Plain {
    /// Creates a simulation at t = 0, over a disc turned by `turned` columns.
    pub fn new(parameters: Arc<Parameters>, surfaces: InitialSurfaces, turned: u64) -> Self {
        let mut state = State::new(&parameters, surfaces);
        state.turned = turned;
        let mut plain = Self {
            last: None,
            totals: Totals::default(),
            history: History::new(parameters.mesh.disc_columns()),
            course: Course::default(),
            clock: parameters.clock(),
            initial_volume: 0.0,
            initial_heights: [state.disc.height.clone(), state.pin.height.clone()],
            accounts: Accounts::of(&parameters),
            worn_with: parameters.clone(),
            state,
            parameters,
        };
        plain.initial_volume = plain.open_volume();
        plain.wear_as_accounted();
        plain
    }

    /// Takes steps until `step` of them are done; the last may be watched, for a sample or maps of pressure to follow.
    pub fn advance_to(&mut self, step: u64, watched: bool) -> Result<(), SimulationError> {
        while self.course.steps < step {
            self.last = None;
            if let Some(accounts) = &mut self.accounts {
                accounts.begin(self.course.steps + 1, self.parameters.step_angle());
                self.wear_as_accounted();
            }
            let friction = self.accounts.as_ref().and_then(Accounts::friction_coefficient);
            let operation = self.parameters.operation_by(self.course.steps + 1, &self.clock, friction)?;
            let taken = step::advance_under(operation.load, &self.worn_with, &mut self.state)
                .map_err(|source| SimulationError::Contact { step: self.course.steps + 1, source })?;
            let area = self.parameters.mesh.area().iter().cycle();
            let cells = taken.contact.iter().zip(area);
            self.course.contact_area = cells.filter(|(touches, _)| **touches).map(|(_, area)| area).sum();
            self.course.largest_load_residual = self.course.largest_load_residual.max(self.load_residual(&taken));
            self.course.steps += 1;
            self.course.load = operation.load;
            self.history.record(self.course.contact_area, &operation);
            self.course.time = operation.end;
            self.totals.add(&taken.moved);
            if let Some(accounts) = &mut self.accounts {
                accounts.record(&StepFacts {
                    number: self.course.steps,
                    angle: self.parameters.step_angle(),
                    operation: &operation,
                    contact: &taken.sums(&self.parameters),
                    moved: &taken.moved,
                });
            }
            self.last = (watched && self.course.steps == step).then_some(taken);
        }
        Ok(())
    }

    /// Has the coming steps stand for `acceleration` revolutions each (model 4.6).
    pub fn accelerate(&mut self, acceleration: f64) -> Result<(), SimulationError> {
        self.go_on_with(self.parameters.accelerated(acceleration, self.course.steps))
    }

    /// Has the coming steps taken under another load and at another speed.
    pub fn operate(&mut self, operation: &Operation) -> Result<(), SimulationError> {
        self.go_on_with(self.parameters.under(operation))
    }

    fn go_on_with(&mut self, parameters: Parameters) -> Result<(), SimulationError> {
        self.clock = self.clock.changed(self.course.steps, parameters.step_time());
        self.parameters = Arc::new(parameters);
        self.wear_as_accounted();
        Ok(())
    }

    /// Takes over the wear rates that hold in the coming step.
    fn wear_as_accounted(&mut self) {
        let factor = self.accounts.as_ref().map_or(1.0, Accounts::wear_rate_factor);
        self.worn_with = match factor {
            1.0 => self.parameters.clone(),
            factor => Arc::new(self.parameters.with_wear_rate_factor(factor)),
        };
        let stiffness_number = self.worn_with.stiffness_number();
        self.course.largest_stiffness_number = self.course.largest_stiffness_number.max(stiffness_number);
    }

    /// Returns the summary of the steps so far.
    pub fn course(&self) -> Course {
        Course { contact_area_integral: self.history.integral(), ..self.course }
    }

    /// Returns the state that is kept beside the surfaces.
    pub fn memory(&self) -> Memory {
        let pool = |volume: &f64| {
            let mut pool = RunningSum::default();
            pool.add(*volume);
            pool
        };
        Memory {
            course: self.course,
            clock: self.clock,
            time_acceleration: self.parameters.time_acceleration,
            account: Account { pools: self.state.pools.iter().map(pool).collect(), totals: self.totals },
            history: self.history.clone(),
            accounts: self.accounts.as_ref().map(|accounts| accounts.state().clone()),
        }
    }

    /// Takes over the state of a plain simulation of the same parameters and surfaces.
    pub fn restore(&mut self, heights: &Heights, memory: &Memory) {
        let Memory { course, clock, time_acceleration, account, history, accounts } = memory.clone();
        self.parameters = Arc::new(Parameters { time_acceleration, ..Parameters::clone(&self.parameters) });
        let State { disc, pin, pools, steps, .. } = &mut self.state;
        (disc.height, disc.substrate) = (heights.disc_height.clone(), heights.disc_substrate.clone());
        (pin.height, pin.substrate) = (heights.pin_height.clone(), heights.pin_substrate.clone());
        *pools = account.pools.iter().map(RunningSum::value).collect();
        *steps = course.steps;
        (self.course, self.clock, self.history, self.totals) = (course, clock, history, account.totals);
        self.last = None;
        if let (Some(own), Some(state)) = (&mut self.accounts, accounts) {
            own.restore(state);
        }
        self.wear_as_accounted();
    }

    /// The last step, for those who report its pressures; none before the first.
    fn watched(&self) -> Result<Option<&Step>, SimulationError> {
        match &self.last {
            None if self.course.steps > 0 => Err(SimulationError::NotWatched { step: self.course.steps }),
            last => Ok(last.as_ref()),
        }
    }

    /// The maps asked for, as they are now.
    pub fn snapshot(&self, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        let State { disc, pin, .. } = &self.state;
        let mut values = Vec::with_capacity(maps.len());
        for map in maps {
            let field = match map {
                Map::DiscHeight => MapValues::Float(disc.height.clone()),
                Map::DiscSubstrate => MapValues::Float(disc.substrate.clone()),
                Map::DiscStatus => MapValues::Status(disc.reported_statuses().map(|status| status as u8).collect()),
                Map::PinHeight => MapValues::Float(pin.height.clone()),
                Map::PinSubstrate => MapValues::Float(pin.substrate.clone()),
                Map::PinStatus => MapValues::Status(pin.reported_statuses().map(|status| status as u8).collect()),
                Map::Pressure => MapValues::Float(match self.watched()? {
                    Some(step) => step.pressure.clone(),
                    None => vec![0.0; pin.height.len()],
                }),
                // The simulation makes it of the pressures.
                Map::Temperature => continue,
            };
            values.push((*map, field));
        }
        Ok(Snapshot { time: self.course.time, maps: values })
    }

    /// The reported quantities after the last step (model 5).
    pub fn sample(&self) -> Result<Sample, SimulationError> {
        let (parameters, mesh, totals) = (&*self.parameters, &self.parameters.mesh, &self.totals);
        let step = self.watched()?;
        let areas = || mesh.area().iter().copied().cycle();
        let pin_share = |status: Status| {
            let cells = self.state.pin.reported_statuses().zip(mesh.pin_areas()).filter(|(each, _)| *each == status);
            cells.map(|(_, area)| area).sum::<f64>() / mesh.pin_area()
        };
        let disc_secondary =
            self.state.disc.reported_statuses().zip(areas()).filter(|(each, _)| *each == Status::Secondary);
        let contact_area = self.course.contact_area;
        let pressures = step.map_or(&[][..], |step| &step.pressure);
        let load: f64 = pressures.iter().zip(areas()).map(|(pressure, area)| pressure * area).sum();
        let pool: f64 = self.state.pools.iter().sum();
        Ok(Sample {
            step: self.course.steps,
            time: self.course.time,
            displacement: step.map_or(0.0, |step| step.displacement),
            contact_area,
            contact_area_mean: self.history.revolution_mean(),
            contact_area_integral: self.history.integral(),
            sliding_distance: parameters.angle_turned(self.course.steps, self.course.time) * mesh.mean_radius(),
            contact_ratio: contact_area / mesh.pin_area(),
            mean_pressure: if contact_area > 0.0 { load / contact_area } else { 0.0 },
            max_pressure: pressures.iter().copied().fold(0.0, f64::max),
            worn_pin: totals.worn_pin.value(),
            worn_resin: totals.worn_resin.value(),
            worn_disc: totals.worn_disc.value(),
            pool: pool.max(0.0),
            emitted: totals.emitted.amount(),
            deposited_pin: totals.deposited_pin.value(),
            deposited_disc: totals.deposited_disc.value(),
            returned: totals.returned.value(),
            pin_none: pin_share(Status::Resin),
            pin_primary: pin_share(Status::Primary),
            pin_secondary: pin_share(Status::Secondary),
            disc_secondary: (disc_secondary.map(|(_, area)| area).sum::<f64>() / mesh.disc_area()).min(1.0),
            filled_fraction: match self.initial_volume {
                0.0 => 0.0,
                initial => 1.0 - self.open_volume() / initial,
            },
            load_residual: step.map_or(0.0, |step| self.load_residual(step)),
            balance_residual: totals.balance_residual(pool, self.lost()),
            accounts: self.accounts.as_ref().map_or(AccountsReport::default(), |accounts| {
                accounts.report(self.course.steps, parameters.step_angle(), self.course.time, None)
            }),
            extras: Vec::new(),
        })
    }

    /// Residual |Σ p A − F_N| / F_N of a step, 1.
    fn load_residual(&self, step: &Step) -> f64 {
        let areas = self.parameters.mesh.area().iter().cycle();
        let load: f64 = step.pressure.iter().zip(areas).map(|(pressure, area)| pressure * area).sum();
        (load / step.load - 1.0).abs()
    }

    /// Volume that disc and pin have lost since the start, by their heights, m³.
    fn lost(&self) -> f64 {
        let (State { disc, pin, .. }, mesh) = (&self.state, &self.parameters.mesh);
        let [disc_before, pin_before] = &self.initial_heights;
        let disc = disc_before.iter().zip(&disc.height).zip(mesh.area().iter().copied().cycle());
        let pin = pin.height.iter().zip(pin_before).zip(mesh.pin_areas());
        let mut lost = RunningSum::default();
        disc.for_each(|((before, now), area)| lost.add((before - now) * area));
        pin.for_each(|((now, before), area)| lost.add((now - before) * area));
        lost.value()
    }

    /// Open volume V = Σ A (z_ref − z_d)₊, m³.
    fn open_volume(&self) -> f64 {
        let State { disc, reference_height, .. } = &self.state;
        let cells = disc.height.iter().zip(self.parameters.mesh.area().iter().cycle());
        cells.map(|(height, area)| (reference_height - height).max(0.0) * area).sum()
    }
}
