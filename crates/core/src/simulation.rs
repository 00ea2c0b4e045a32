//! A pin on a disc, from its first step to its last (model section 4).

pub mod checkpoint;
mod control;
mod plain;
mod workers;

use std::sync::Arc;

use crate::engine::comm::Communicator;
pub use crate::engine::comm::Exchange;
pub use crate::engine::execution::{Decomposition, Engine, Execution};
use crate::model::accounts::{AccountsReport, Resting};
use crate::model::clock::{Clock, Operation};
use crate::model::cycle::Kind;
pub use crate::model::error::SimulationError;
use crate::model::heat::account::HeatModel;
use crate::model::heat::passing;
pub use crate::model::memory::Course;
use crate::model::memory::Heights;
use crate::model::mesh::Mesh;
use crate::model::parameters::Parameters;
use crate::model::state::{Base, Disc, InitialSurfaces, Pin};
use crate::observe::extra::{self, Extra};
use crate::observe::schedule::Moment;
use crate::observe::{ABSENT, Map, MapValues, QUANTITIES, Quantity, Sample, Snapshot, quantities};
use crate::simulation::checkpoint::{Checkpoint, Kept, LastContact};
use crate::simulation::workers::Workers;

/// A pin on a disc, and everything that happened to them so far.
///
/// Whatever may fail does so with [`SimulationError::Worker`] when a worker failed.
#[derive(Debug)]
pub struct Simulation {
    parameters: Arc<Parameters>,
    pin_base: Vec<Base>,
    execution: Execution,
    workers: Workers,
    clock: Clock,
    /// Level z_ref, m: the highest initial height of the disc.
    reference_height: f64,
    /// Speed of the last step, rad/s, where another one is told since.
    last_speed: Option<f64>,
    /// Load and speed of the scene.
    of_scene: Operation,
    contact: Option<LastContact>,
    resting: Option<LastMoment>,
}

/// The accounts at the moment that was asked for last: those after it may follow from them.
#[derive(Debug)]
struct LastMoment {
    /// Steps done, the step that the moment belongs to, and whether it is in a pause.
    of: (u64, u64, bool),
    /// Time of the moment, s.
    until: f64,
    accounts: Resting,
}

impl Simulation {
    /// Creates a simulation at t = 0, without build-up and debris, on one worker.
    ///
    /// # Errors
    /// [`SimulationError`] when the surfaces do not fit the mesh or hold a height that is not finite.
    pub fn new(parameters: Parameters, surfaces: InitialSurfaces) -> Result<Self, SimulationError> {
        Self::with_execution(parameters, surfaces, Execution::default())
    }

    /// Creates a simulation at t = 0 that is carried out in a certain way.
    ///
    /// # Errors
    /// As [`Simulation::new`], and [`SimulationError::Threads`] when there are no more threads to be had.
    pub fn with_execution(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        execution: Execution,
    ) -> Result<Self, SimulationError> {
        Self::with_disc_turned(parameters, surfaces, execution, 0)
    }

    /// Creates a simulation with the disc turned by `columns` columns: step n faces the columns that step n + `columns` would face.
    pub fn with_disc_turned(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        mut execution: Execution,
        columns: u64,
    ) -> Result<Self, SimulationError> {
        let mesh = &parameters.mesh;
        check(mesh, &surfaces)?;
        execution.engine = execution.engine.of(&parameters);
        // A sector has at least two columns.
        let most = if execution.engine == Engine::Plain { 1 } else { (mesh.disc_columns() / 2).max(1) };
        execution.workers = execution.workers.clamp(1, most);
        let (parameters, pin_base) = (Arc::new(parameters), surfaces.pin_base.clone());
        let reference_height = surfaces.reference_height();
        let workers = Workers::start(&parameters, surfaces, execution, columns)?;
        Ok(Self::of(parameters, pin_base, execution, workers, reference_height))
    }

    /// Creates a simulation as [`Simulation::new`] on the ranks of a job, of which this process is one, carried out in a certain way:
    /// `workers` are the ranks.
    ///
    /// All ranks must make the same calls in the same order, and get the same answers. Where there are more ranks than
    /// sectors, the last ones have no cells and only keep pace.
    ///
    /// # Errors
    /// [`SimulationError`] as [`Simulation::new`]; [`SimulationError::PlainOnRanks`] where debris is pooled.
    pub fn on_ranks(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        execution: Execution,
        communicator: Box<dyn Communicator>,
    ) -> Result<Self, SimulationError> {
        check(&parameters.mesh, &surfaces)?;
        if Engine::Fast.of(&parameters) == Engine::Plain {
            return Err(SimulationError::PlainOnRanks { ranks: communicator.size() });
        }
        let parameters = Arc::new(parameters);
        let execution = Execution { engine: Engine::Fast, workers: communicator.size(), ..execution };
        let workers = Workers::one(&parameters, &surfaces, execution, 0, communicator);
        let reference_height = surfaces.reference_height();
        Ok(Self::of(parameters, surfaces.pin_base, execution, workers, reference_height))
    }

    fn of(
        parameters: Arc<Parameters>,
        pin_base: Vec<Base>,
        execution: Execution,
        workers: Workers,
        reference_height: f64,
    ) -> Self {
        let Parameters { normal_force: load, angular_velocity, .. } = *parameters;
        Self {
            clock: parameters.clock(),
            of_scene: Operation { load, angular_velocity, control: None },
            parameters,
            pin_base,
            execution,
            workers,
            reference_height,
            last_speed: None,
            contact: None,
            resting: None,
        }
    }

    /// Takes one step: see the table in [`crate`].
    ///
    /// # Errors
    /// [`SimulationError::Contact`] when no displacement carries the load.
    pub fn advance(&mut self) -> Result<(), SimulationError> {
        self.advance_to(self.steps_done() + 1)
    }

    /// Takes steps until `step` of them are done.
    pub fn advance_to(&mut self, step: u64) -> Result<(), SimulationError> {
        self.take_steps(step, true)
    }

    /// Takes steps until `step` of them are done, where no sample and no map of pressure is to follow: the last pressures are not kept.
    pub fn pass_to(&mut self, step: u64) -> Result<(), SimulationError> {
        self.take_steps(step, false)
    }

    fn take_steps(&mut self, step: u64, watched: bool) -> Result<(), SimulationError> {
        if step > self.steps_done() {
            self.last_speed = None;
        }
        self.workers.advance_to(step, watched)
    }

    /// Has the coming steps stand for another number of revolutions than those so far (model 4.6).
    pub fn accelerate(&mut self, acceleration: f64) -> Result<(), SimulationError> {
        self.workers.accelerate(acceleration)?;
        self.resting = None;
        self.parameters = Arc::new(self.parameters.accelerated(acceleration, self.steps_done()));
        self.clock = self.clock.changed(self.steps_done(), self.parameters.step_time());
        Ok(())
    }

    /// Goes on from a checkpoint of a simulation with the same parameters, time acceleration apart, and the same initial
    /// surfaces: the coming steps are bit for bit those that it would have taken.
    ///
    /// # Errors
    /// [`SimulationError::Checkpoint`], [`SimulationError::OtherState`] and [`SimulationError::OtherEngine`] when it is of another mesh,
    /// scene or engine.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), SimulationError> {
        checkpoint.check(&self.parameters.mesh)?;
        let (found, expected) = (checkpoint.engine().name(), self.execution.engine.name());
        if found != expected {
            return Err(SimulationError::OtherEngine { found, expected });
        }
        let (memory, engine) = self.workers.memory()?;
        if let Some(what) = checkpoint.misfit(&memory, engine.as_ref()) {
            return Err(SimulationError::OtherState { what });
        }
        let (operation, last_speed) = checkpoint.kept.control().unwrap_or((self.of_scene, None));
        if operation != self.operation() {
            self.workers.operate(&operation)?;
        }
        self.workers.restore(checkpoint)?;
        self.resting = None;
        self.clock = checkpoint.clock();
        self.contact = checkpoint.kept.contact().cloned();
        self.last_speed = last_speed;
        let time_acceleration = checkpoint.memory.time_acceleration;
        self.parameters = Arc::new(Parameters { time_acceleration, ..self.parameters.under(&operation) });
        Ok(())
    }

    /// Returns the parameters, as they hold for the coming steps.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Base of every pin cell, column by column.
    pub fn pin_base(&self) -> &[Base] {
        &self.pin_base
    }

    /// Returns the settings by which the simulation is carried out.
    pub fn execution(&self) -> Execution {
        self.execution
    }

    /// Describes in words which part of the mesh each worker has.
    pub fn decomposition(&self) -> String {
        workers::partition(&self.parameters, self.execution).told()
    }

    /// Returns the summary of the steps so far.
    pub fn course(&self) -> Course {
        self.workers.course()
    }

    /// Returns the time and bytes of each worker thread's exchange with the others so far.
    pub fn exchanges(&self) -> Vec<Exchange> {
        self.workers.exchanges()
    }

    /// Number of steps done.
    pub fn steps_done(&self) -> u64 {
        self.course().steps
    }

    /// Mean speed of the last step, rad/s, or of the coming ones if there was none.
    pub fn last_speed(&self) -> f64 {
        self.last_speed.unwrap_or_else(|| self.parameters.mean_speed_of(self.steps_done()))
    }

    /// Steps that are done when t is at least `time` (s) for the first time, with what the coming steps are told now; of a cycle, the
    /// last that ends no later.
    pub fn steps_until(&self, time: f64) -> u64 {
        match &self.parameters.cycle {
            Some(cycle) => cycle.steps_done(time, self.parameters.step_angle()),
            None => self.clock.steps_until(time),
        }
    }

    /// Time t, s.
    pub fn time(&self) -> f64 {
        self.course().time
    }
}

/// Refuses surfaces that do not fit the mesh or have a height that is not finite.
fn check(mesh: &Mesh, surfaces: &InitialSurfaces) -> Result<(), SimulationError> {
    if !surfaces.fits(mesh) {
        return Err(SimulationError::Size { disc: mesh.disc_cells(), pin: mesh.pin_cells() });
    }
    let is_absent = |surface: &str, cell: usize| surface == "pin" && !mesh.is_present(cell);
    for (surface, heights) in [("disc", &surfaces.disc_height), ("pin", &surfaces.pin_height)] {
        let refused = heights.iter().enumerate().filter(|(_, height)| !height.is_finite());
        let count = refused.filter(|(cell, _)| !is_absent(surface, *cell)).count();
        if count > 0 {
            return Err(SimulationError::Height { surface, count });
        }
    }
    Ok(())
}

impl Simulation {
    /// The reported quantities after the last step.
    ///
    /// # Errors
    /// [`SimulationError::NotWatched`] after [`Simulation::pass_to`], [`SimulationError::NotFinite`] when an amount is no number.
    pub fn sample(&mut self) -> Result<Sample, SimulationError> {
        if let Some(contact) = self.last_contact() {
            return Ok(contact.sample.clone());
        }
        let sample = self.workers.sample()?;
        // A ratio may have nothing to be a ratio of.
        let amounts = || QUANTITIES.iter().filter(|quantity| quantity.unit != "1");
        let name = |place| format!("the {}", amounts().nth(place).map_or("", |quantity| quantity.long_name));
        self.refuse_not_finite(amounts().map(|quantity| quantity.value(&sample)), name)?;
        let AccountsReport { friction, heat, emission } = sample.accounts;
        let parts = [
            ("the work of friction", friction.map(|friction| friction.work)),
            ("the heat lost", heat.map(|heat| heat.lost)),
            ("the temperature of the disc", heat.map(|heat| heat.disc)),
            ("the number of airborne particles", emission.map(|emission| emission.number)),
        ];
        for (name, value) in parts {
            self.refuse_not_finite(value.into_iter(), |_| name.to_owned())?;
        }
        Ok(sample)
    }

    /// Keeps what the last step showed, which in a pause is reported again and again, and also by who goes on from a checkpoint
    /// of the pause. It fails as [`Simulation::sample`] does.
    pub fn keep_contact(&mut self) -> Result<(), SimulationError> {
        if self.last_contact().is_none() {
            let [pressure] = self.fields([Map::Pressure])?;
            self.contact = Some(LastContact { sample: self.sample()?, pressure });
        }
        Ok(())
    }

    /// Returns the contact that is kept, if it is of the last step.
    fn last_contact(&self) -> Option<&LastContact> {
        self.contact.as_ref().filter(|contact| contact.sample.step == self.steps_done())
    }

    /// Returns the reported quantities at a moment that the last step belongs to, with series on request. Each of those takes about as
    /// long as the maps that it is measured of.
    ///
    /// In a pause (model 9) without load nothing touches and there is no displacement; a pin that stands touches as in the
    /// step. It fails as [`Simulation::sample`] does, of all quantities.
    pub fn sample_at(&mut self, moment: &Moment, extras: &[&Extra]) -> Result<Sample, SimulationError> {
        let mut sample = self.sample()?;
        if let (Some(cycle), Some(pause)) = (self.parameters.cycle.clone(), moment.pause) {
            let loaded = cycle.loaded_until(moment.time) - cycle.loaded_until(sample.time);
            sample.contact_area_integral += sample.contact_area * loaded;
            sample.sliding_distance = cycle.angle_at(moment.time) * self.parameters.mesh.mean_radius();
            sample.time = moment.time;
            sample.accounts = self.accounts_at(moment)?;
            if pause == Kind::Lifted {
                (sample.displacement, sample.contact_area, sample.contact_ratio) = (f64::NAN, 0.0, 0.0);
                (sample.mean_pressure, sample.max_pressure) = (0.0, 0.0);
            }
        }
        for extra in extras {
            let Some(request) = &extra.request else { continue };
            let maps = self.snapshot_at(moment, request.maps)?.maps;
            let fields: Vec<Vec<f64>> = maps.into_iter().map(|(_, values)| values.into_numbers()).collect();
            extra.record(&mut sample, (request.measure)(&self.parameters, &fields));
        }
        self.refuse_overflow(&sample, extras)?;
        Ok(sample)
    }

    /// Refuses a sample in which something is infinite, or an amount is no number that the model always has. A ratio may have
    /// nothing to be a ratio of; where nothing touches there is no displacement, no temperature of the contact.
    fn refuse_overflow(&self, sample: &Sample, extras: &[&Extra]) -> Result<(), SimulationError> {
        let of_accounts = [&extra::FRICTION, &extra::HEAT, &extra::EMISSION];
        let quantities = quantities(extras).chain(of_accounts.into_iter().flat_map(|extra| extra.quantities));
        let wrong = |quantity: &&Quantity| {
            let value = quantity.value(sample);
            let is_amount = ["m", "kg"].contains(&quantity.unit) || quantity.name == "particle_number";
            value.is_infinite()
                || (value.is_nan() && is_amount && quantity.name != "displacement" && quantity.is_of(sample))
        };
        let error = |quantity: &Quantity| SimulationError::NotFinite {
            step: self.steps_done(),
            what: format!("the {}", quantity.long_name),
            found: quantity.value(sample),
        };
        quantities.into_iter().find(wrong).map_or(Ok(()), |quantity| Err(error(quantity)))
    }

    /// Friction, heat and emission at a moment that the last step belongs to; none of them where the scene asks for none.
    pub fn accounts_at(&mut self, moment: &Moment) -> Result<AccountsReport, SimulationError> {
        let parameters = &self.parameters;
        if parameters.friction.is_none() && parameters.emission.is_none() {
            return Ok(AccountsReport::default());
        }
        let of = (self.steps_done(), moment.step, moment.pause.is_some());
        let accounts = match self.resting.take() {
            Some(resting) if resting.of == of && resting.until <= moment.time => Some(resting.accounts),
            _ => {
                let after = |accounts| Resting::new(accounts, moment.step, parameters.step_angle(), moment.pause);
                self.workers.accounts(parameters)?.map(after)
            }
        };
        let Some(mut accounts) = accounts else { return Ok(AccountsReport::default()) };
        let report = accounts.report(moment.time, moment.pause);
        self.resting = Some(LastMoment { of, until: moment.time, accounts });
        Ok(report)
    }

    /// The maps asked for, as they are now. Cells beyond the pin's outline are NaN, and have the status [`ABSENT`].
    ///
    /// # Errors
    /// [`SimulationError::NotWatched`] for pressures after [`Simulation::pass_to`], [`SimulationError::NotFinite`] when a value is no number.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        let Course { steps, time, .. } = self.course();
        self.snapshot_at(&Moment { step: steps, time, ..Moment::default() }, maps)
    }

    /// Returns the maps asked for at a moment that the last step belongs to: in a pause without load all pressures are 0. It fails as
    /// [`Simulation::snapshot`] does.
    pub fn snapshot_at(&mut self, moment: &Moment, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        let mut values = Vec::with_capacity(maps.len());
        for map in maps {
            let mut found = match map {
                Map::Pressure => MapValues::Float(self.pressures_at(moment)?),
                Map::Temperature => MapValues::Float(self.temperatures_at(moment)?),
                map => self.field(*map)?,
            };
            self.fill_absent(*map, &mut found, f64::NAN, ABSENT);
            values.push((*map, found));
        }
        Ok(Snapshot { time: moment.time, maps: values })
    }

    /// Gives the cells of a map that are beyond the pin's outline this number, or this status.
    fn fill_absent(&self, map: Map, values: &mut MapValues, number: f64, status: u8) {
        if map.on_disc() {
            return;
        }
        for cell in self.parameters.mesh.absent_cells() {
            match values {
                MapValues::Float(values) => values[cell] = number,
                MapValues::Status(statuses) => statuses[cell] = status,
            }
        }
    }

    /// Pressure p of every pin cell at a moment, Pa; 0 beyond the pin's outline.
    fn pressures_at(&mut self, moment: &Moment) -> Result<Vec<f64>, SimulationError> {
        if moment.pause == Some(Kind::Lifted) {
            return Ok(vec![0.0; self.parameters.mesh.pin_cells()]);
        }
        match self.last_contact() {
            Some(contact) => Ok(contact.pressure.clone()),
            None => Ok(self.field(Map::Pressure)?.into_numbers()),
        }
    }

    /// Temperature T of every pin cell at a moment, K; no numbers where the pin is lifted, or no heat is reckoned.
    fn temperatures_at(&mut self, moment: &Moment) -> Result<Vec<f64>, SimulationError> {
        let pressure = self.pressures_at(moment)?;
        let AccountsReport { friction, heat, .. } = self.accounts_at(moment)?;
        let (Some(model), Some(friction), Some(heat)) = (HeatModel::of(&self.parameters), friction, heat) else {
            return Ok(vec![f64::NAN; pressure.len()]);
        };
        let speed = self.last_speed.unwrap_or_else(|| self.parameters.mean_speed_of(moment.step));
        let moves = moment.pause.is_none() && moment.step > 0;
        let flux =
            if moves { heat.share * friction.coefficient * speed * self.parameters.mesh.mean_radius() } else { 0.0 };
        Ok(passing::temperatures(model.passing(), &self.parameters.mesh, &pressure, flux, heat.face, speed))
    }

    /// One map that the workers have; 0 beyond the pin's outline.
    fn field(&mut self, map: Map) -> Result<MapValues, SimulationError> {
        let found = self.workers.snapshot(&[map])?.maps.into_iter().next();
        let mut values = found.map_or(MapValues::Float(Vec::new()), |(_, values)| values);
        // What the workers keep there is their own affair.
        self.fill_absent(map, &mut values, 0.0, 0);
        if let MapValues::Float(values) = &values {
            let name = |place| format!("cell {place} of {}", map.name());
            self.refuse_not_finite(values.iter().copied(), name)?;
        }
        Ok(values)
    }

    /// The disc as it is now.
    pub fn disc(&mut self) -> Result<Disc, SimulationError> {
        let [height, substrate] = self.fields([Map::DiscHeight, Map::DiscSubstrate])?;
        Ok(Disc { height, substrate })
    }

    /// Surface height z_d of every disc cell as it is now, m, column by column.
    pub fn disc_height(&mut self) -> Result<Vec<f64>, SimulationError> {
        let [height] = self.fields([Map::DiscHeight])?;
        Ok(height)
    }

    /// The pin as it is now; heights beyond its outline are 0.
    pub fn pin(&mut self) -> Result<Pin, SimulationError> {
        let [height, substrate] = self.fields([Map::PinHeight, Map::PinSubstrate])?;
        Ok(Pin { height, substrate, base: self.pin_base.clone() })
    }

    fn fields<const COUNT: usize>(&mut self, maps: [Map; COUNT]) -> Result<[Vec<f64>; COUNT], SimulationError> {
        let mut fields = [const { Vec::new() }; COUNT];
        for (field, map) in fields.iter_mut().zip(maps) {
            *field = self.field(map)?.into_numbers();
        }
        Ok(fields)
    }

    /// The complete state, to go on from later.
    ///
    /// # Errors
    /// [`SimulationError::NotFinite`] when a height is no number.
    pub fn checkpoint(&mut self) -> Result<Checkpoint, SimulationError> {
        let [disc_height, disc_substrate] = self.fields([Map::DiscHeight, Map::DiscSubstrate])?;
        let [pin_height, pin_substrate] = self.fields([Map::PinHeight, Map::PinSubstrate])?;
        let (memory, engine) = self.workers.memory()?;
        let rows = self.parameters.mesh.rows();
        let fields = [
            ("height of the disc", &disc_height),
            ("substrate of the disc", &disc_substrate),
            ("height of the pin", &pin_height),
            ("substrate of the pin", &pin_substrate),
        ];
        for (name, values) in fields {
            let name = |cell| format!("the {name} at (column {}, row {})", cell / rows, cell % rows);
            self.refuse_not_finite(values.iter().copied(), name)?;
        }
        let kept = Kept::new(self.operation(), self.last_speed, self.last_contact().cloned());
        let heights = Heights { disc_height, disc_substrate, pin_height, pin_substrate };
        Ok(Checkpoint { heights, kept, memory, engine })
    }

    /// Refuses heights of which one is no number, with [`SimulationError::NotFinite`]: it is followed by others, and shows in no series for a
    /// while.
    pub fn check_heights(&mut self) -> Result<(), SimulationError> {
        self.checkpoint().map(drop)
    }

    /// Refuses what is no number, which `name` names by its place.
    fn refuse_not_finite(
        &self,
        mut values: impl Iterator<Item = f64>,
        name: impl Fn(usize) -> String,
    ) -> Result<(), SimulationError> {
        let mut place = 0;
        let found = values.find(|value| {
            place += 1;
            !value.is_finite()
        });
        let error = |found| SimulationError::NotFinite { step: self.steps_done(), what: name(place - 1), found };
        found.map_or(Ok(()), |found| Err(error(found)))
    }
}
