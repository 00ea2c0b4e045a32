//! A pin on a disc, from its first step to its last (model section 4).

pub mod checkpoint;
pub(crate) mod course;
pub(crate) mod error;
pub(crate) mod execution;
mod plain;

use std::sync::Arc;

use self::checkpoint::Checkpoint;
pub use self::course::Course;
pub use self::error::SimulationError;
pub use self::execution::{Engine, Execution};
use self::plain::Plain;
use crate::engine::comm::single::Single;
use crate::engine::comm::threads::Threads;
#[cfg(feature = "mpi")]
use crate::engine::comm::{Communicator as _, mpi::Mpi};
use crate::engine::crew::Crew;
#[cfg(feature = "mpi")]
use crate::engine::kernel::InstructionSet;
use crate::engine::parts::Needs;
use crate::engine::sector::Partition;
use crate::engine::worker::{Worker, halo_words};
use crate::model::mesh::Mesh;
use crate::model::parameters::Parameters;
use crate::model::state::{Base, Disc, InitialSurfaces, Pin};
use crate::observe::extra::Extra;
use crate::observe::{Map, MapValues, QUANTITIES, Sample, Snapshot};

/// A pin on a disc, and everything that happened to them so far.
#[derive(Debug)]
pub struct Simulation {
    parameters: Arc<Parameters>,
    pin_base: Vec<Base>,
    execution: Execution,
    team: Team,
}

/// Who does the work.
#[derive(Debug)]
enum Team {
    /// This thread.
    Alone(Box<Worker<Single>>),
    /// This thread, with the plain model.
    Plain(Box<Plain>),
    /// Threads of their own.
    Crew(Crew),
    /// This thread and, each for itself, the other ranks of an MPI job.
    #[cfg(feature = "mpi")]
    Rank(Box<Worker<Mpi>>),
}

/// Gives the same call to whoever does the work.
macro_rules! team {
    ($simulation:expr, $worker:ident => $call:expr) => {
        match &mut $simulation.team {
            Team::Alone($worker) => $call,
            Team::Plain($worker) => $call,
            Team::Crew($worker) => $call,
            #[cfg(feature = "mpi")]
            Team::Rank($worker) => $call,
        }
    };
}

impl Simulation {
    /// The state at t = 0, no build-up and no debris, on one worker.
    ///
    /// # Errors
    /// [`SimulationError`] when the surfaces do not fit the mesh or hold a height that is not finite.
    pub fn new(parameters: Parameters, surfaces: InitialSurfaces) -> Result<Self, SimulationError> {
        Self::with_execution(parameters, surfaces, Execution::default())
    }

    /// The same, carried out in a certain way.
    ///
    /// # Errors
    /// [`SimulationError`] as [`Simulation::new`], and when there are no more threads to be had.
    pub fn with_execution(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        execution: Execution,
    ) -> Result<Self, SimulationError> {
        Self::with_disc_turned(parameters, surfaces, execution, 0)
    }

    /// The same with the disc turned by `columns` columns: step n faces the columns that step n + `columns` would face.
    ///
    /// # Errors
    /// [`SimulationError`] as [`Simulation::with_execution`].
    pub fn with_disc_turned(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        mut execution: Execution,
        columns: u64,
    ) -> Result<Self, SimulationError> {
        let mesh = &parameters.mesh;
        check(mesh, &surfaces)?;
        // A sector has at least two columns.
        execution.workers = execution.workers.clamp(1, (mesh.disc_columns() / 2).max(1));
        let partition = Arc::new(Partition::new(mesh, execution.workers, execution.bands));
        let parameters = Arc::new(parameters);
        if execution.engine == Engine::Plain {
            let pin_base = surfaces.pin_base.clone();
            let team = Team::Plain(Box::new(Plain::new(parameters.clone(), surfaces, columns)));
            return Ok(Self { parameters, pin_base, execution: Execution { workers: 1, ..execution }, team });
        }
        let team =
            if execution.workers == 1 {
                let worker = Worker::new(parameters.clone(), &surfaces, partition, execution, columns, Single);
                Team::Alone(Box::new(worker))
            } else {
                let halo_words = halo_words(parameters.mesh.rows(), Needs::of(&parameters).local);
                let boundaries = if partition.groups() > 1 { partition.sectors() * partition.bands() } else { 0 };
                let ends = Threads::connect(execution.workers, boundaries, halo_words);
                let worker = |end: Threads| {
                    let alarm = end.alarm();
                    let partition = partition.clone();
                    (Worker::new(parameters.clone(), &surfaces, partition, execution, columns, end), alarm)
                };
                let crew = Crew::start(ends.into_iter().map(worker).collect(), execution.pin);
                Team::Crew(crew.map_err(|error| SimulationError::Threads {
                    workers: execution.workers,
                    message: error.to_string(),
                })?)
            };
        Ok(Self { parameters, pin_base: surfaces.pin_base, execution, team })
    }

    /// The same as [`Simulation::new`] on the ranks of an MPI job, of which this process is one (feature `mpi`).
    ///
    /// All ranks must make the same calls in the same order, and get the same answers. Where there are more ranks than
    /// sectors, the last ones have no cells and only keep pace.
    ///
    /// # Errors
    /// [`SimulationError`] as [`Simulation::new`].
    #[cfg(feature = "mpi")]
    pub fn on_ranks(
        parameters: Parameters,
        surfaces: InitialSurfaces,
        instructions: InstructionSet,
        communicator: Mpi,
    ) -> Result<Self, SimulationError> {
        check(&parameters.mesh, &surfaces)?;
        let workers = communicator.size();
        let execution = Execution { workers, instructions, ..Execution::default() };
        let partition = Arc::new(Partition::new(&parameters.mesh, execution.workers, execution.bands));
        let parameters = Arc::new(parameters);
        let worker = Worker::new(parameters.clone(), &surfaces, partition, execution, 0, communicator);
        Ok(Self { parameters, pin_base: surfaces.pin_base, execution, team: Team::Rank(Box::new(worker)) })
    }

    /// One step: see the table in [`crate`].
    ///
    /// # Errors
    /// [`SimulationError::Contact`] when no displacement carries the load, [`SimulationError::Worker`] when a worker
    /// failed.
    pub fn advance(&mut self) -> Result<(), SimulationError> {
        self.advance_to(self.steps_done() + 1)
    }

    /// Takes steps until `step` of them are done.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_to(&mut self, step: u64) -> Result<(), SimulationError> {
        team!(self, team => team.advance_to(step, true))
    }

    /// The same where no sample and no map of pressure is taken after the last of the steps: its pressures are not kept.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn pass_to(&mut self, step: u64) -> Result<(), SimulationError> {
        team!(self, team => team.advance_to(step, false))
    }

    /// Has the coming steps stand for another number of revolutions than those so far (model 4.6).
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn accelerate(&mut self, acceleration: f64) -> Result<(), SimulationError> {
        team!(self, team => team.accelerate(acceleration))?;
        Arc::make_mut(&mut self.parameters).time_acceleration = acceleration;
        Ok(())
    }

    /// The complete state, to go on from later.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotFinite`] when a height is no number.
    pub fn checkpoint(&mut self) -> Result<Checkpoint, SimulationError> {
        let [disc_height, disc_substrate] = self.fields([Map::DiscHeight, Map::DiscSubstrate])?;
        let [pin_height, pin_substrate] = self.fields([Map::PinHeight, Map::PinSubstrate])?;
        let memory = match &mut self.team {
            Team::Alone(worker) => worker.memory(),
            Team::Plain(plain) => plain.memory(),
            Team::Crew(crew) => crew.memory()?,
            #[cfg(feature = "mpi")]
            Team::Rank(worker) => worker.memory(),
        };
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
        Ok(Checkpoint { disc_height, disc_substrate, pin_height, pin_substrate, memory })
    }

    /// Looks at all heights: one that is no number is followed by others, and shows in no series for a while.
    ///
    /// # Errors
    /// [`SimulationError::NotFinite`], and [`SimulationError::Worker`] when a worker failed.
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

    /// Goes on from a checkpoint of a simulation with the same parameters, time acceleration apart, and the same initial
    /// surfaces: the coming steps are bit for bit those that it would have taken.
    ///
    /// # Errors
    /// [`SimulationError::Checkpoint`] when it is of another mesh, [`SimulationError::Worker`] when a worker failed.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), SimulationError> {
        checkpoint.check(&self.parameters.mesh)?;
        team!(self, team => team.restore(checkpoint))?;
        Arc::make_mut(&mut self.parameters).time_acceleration = checkpoint.memory.time_acceleration;
        Ok(())
    }

    /// The reported quantities after the last step.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotWatched`] after [`Simulation::pass_to`],
    /// [`SimulationError::NotFinite`] when an amount is no number.
    pub fn sample(&mut self) -> Result<Sample, SimulationError> {
        let sample = team!(self, team => team.sample())?;
        // A ratio may have nothing to be a ratio of.
        let amounts = || QUANTITIES.iter().filter(|quantity| quantity.unit != "1");
        let name = |place| format!("the {}", amounts().nth(place).map_or("", |quantity| quantity.long_name));
        self.refuse_not_finite(amounts().map(|quantity| quantity.value(&sample)), name)?;
        Ok(sample)
    }

    /// The same with series on request. Each takes about as long as the maps that it is measured of.
    ///
    /// # Errors
    /// As [`Simulation::sample`].
    pub fn sample_with(&mut self, extras: &[&Extra]) -> Result<Sample, SimulationError> {
        let mut sample = self.sample()?;
        for extra in extras {
            let Some(request) = &extra.request else { continue };
            let fields: Vec<Vec<f64>> =
                self.snapshot(request.maps)?.maps.into_iter().map(|(_, values)| values.into_numbers()).collect();
            sample.add(extra.quantities, (request.measure)(&self.parameters, &fields));
        }
        Ok(sample)
    }

    /// The maps asked for, as they are now.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotWatched`] for pressures after
    /// [`Simulation::pass_to`], [`SimulationError::NotFinite`] when a value is no number.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        let snapshot = team!(self, team => team.snapshot(maps))?;
        for (map, values) in &snapshot.maps {
            if let MapValues::Float(values) = values {
                let name = |place| format!("cell {place} of {}", map.name());
                self.refuse_not_finite(values.iter().copied(), name)?;
            }
        }
        Ok(snapshot)
    }

    /// The disc as it is now.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn disc(&mut self) -> Result<Disc, SimulationError> {
        let [height, substrate] = self.fields([Map::DiscHeight, Map::DiscSubstrate])?;
        Ok(Disc { height, substrate })
    }

    /// z_d of every disc cell as it is now, m, column by column.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn disc_height(&mut self) -> Result<Vec<f64>, SimulationError> {
        let [height] = self.fields([Map::DiscHeight])?;
        Ok(height)
    }

    /// The pin as it is now.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn pin(&mut self) -> Result<Pin, SimulationError> {
        let [height, substrate] = self.fields([Map::PinHeight, Map::PinSubstrate])?;
        Ok(Pin { height, substrate, base: self.pin_base.clone() })
    }

    fn fields<const COUNT: usize>(&mut self, maps: [Map; COUNT]) -> Result<[Vec<f64>; COUNT], SimulationError> {
        let mut fields = self.snapshot(&maps)?.maps.into_iter().map(|(_, values)| values.into_numbers());
        Ok(std::array::from_fn(|_| fields.next().unwrap_or_default()))
    }

    /// What the simulation was told.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Base of every pin cell, column by column.
    pub fn pin_base(&self) -> &[Base] {
        &self.pin_base
    }

    /// How it is carried out.
    pub fn execution(&self) -> Execution {
        self.execution
    }

    /// What the steps so far were like.
    pub fn course(&self) -> Course {
        match &self.team {
            Team::Alone(worker) => worker.course(),
            Team::Plain(plain) => plain.course(),
            Team::Crew(crew) => crew.course(),
            #[cfg(feature = "mpi")]
            Team::Rank(worker) => worker.course(),
        }
    }

    /// Steps done.
    pub fn steps_done(&self) -> u64 {
        self.course().steps
    }

    /// t, s.
    pub fn time(&self) -> f64 {
        self.course().time
    }
}

/// Refuses surfaces that do not fit the mesh or have a height that is not finite.
fn check(mesh: &Mesh, surfaces: &InitialSurfaces) -> Result<(), SimulationError> {
    if !surfaces.fits(mesh) {
        return Err(SimulationError::Size { disc: mesh.disc_cells(), pin: mesh.pin_cells() });
    }
    for (surface, heights) in [("disc", &surfaces.disc_height), ("pin", &surfaces.pin_height)] {
        let count = heights.iter().filter(|height| !height.is_finite()).count();
        if count > 0 {
            return Err(SimulationError::Height { surface, count });
        }
    }
    Ok(())
}
