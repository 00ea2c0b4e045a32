//! A scene put together: the simulation of a scene, the scout that goes before it, and when what is reported.

use std::sync::Arc;

use plateau_core::acceleration::Chosen;
use plateau_core::acceleration::scout::{Idle, Scout};
use plateau_core::model::cycle::Cycle;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::observe::event::{EventLog, EventRecord};
use plateau_core::observe::schedule::Schedule;
use plateau_core::simulation::{Execution, Simulation, SimulationError};
use plateau_io::run_file::checkpoint::SimulationState;
use plateau_io::scene::{OutputSettings, Scene};

use crate::error::{InputError, RunError};
use crate::job::Job;

/// A scene ready to be simulated, or on its way between two steps. [`run_to_end`](Self::run_to_end) takes its steps.
#[derive(Debug)]
pub struct Assembly {
    /// The simulation.
    pub simulation: Simulation,
    /// Scout that runs ahead, where the run chooses its acceleration.
    pub(crate) scout: Option<Scout>,
    /// Reason why there is no scout although the scene asks for one.
    idle: Option<Idle>,
    /// Tolerance that the scene asks for, where the run chooses its acceleration.
    tolerance: Option<f64>,
    /// Time at which samples and maps are due, as far as is known now; may be another one before the first step.
    pub(crate) schedule: Schedule,
    pub(crate) output: OutputSettings,
    pub(crate) cycle: Option<Arc<Cycle>>,
    /// Records of the events of the cycle.
    pub(crate) events: EventLog,
    /// Physical time until which all that was due is reported, s: of a cycle it may lie in a pause, beyond the last step or
    /// before its end.
    pub(crate) reached: f64,
}

impl Assembly {
    /// The simulation of a scene in this process.
    ///
    /// # Errors
    /// [`InputError::Simulation`] when parameters and surfaces make no simulation, [`RunError::Failed`] when a worker failed.
    pub fn new(scene: &Scene, surfaces: InitialSurfaces, execution: Execution) -> Result<Self, RunError> {
        Self::made_by(Simulation::with_execution, scene, surfaces, execution)
    }

    /// The simulation of a scene that all processes of a job carry out together.
    pub(crate) fn on(
        job: &Job,
        scene: &Scene,
        surfaces: InitialSurfaces,
        execution: Execution,
    ) -> Result<Self, RunError> {
        Self::made_by(
            |parameters, surfaces, execution| job.simulation(parameters, surfaces, execution),
            scene,
            surfaces,
            execution,
        )
    }

    fn made_by(
        make: impl Fn(Parameters, InitialSurfaces, Execution) -> Result<Simulation, SimulationError>,
        scene: &Scene,
        surfaces: InitialSurfaces,
        execution: Execution,
    ) -> Result<Self, RunError> {
        let simulation = |surfaces| make(scene.parameters.clone(), surfaces, execution).map_err(InputError::Simulation);
        let mut scout = None;
        if let Some(adaptive) = &scene.adaptive {
            scout = Some(Scout::new(simulation(surfaces.clone())?, adaptive, scene.duration)?);
        }
        let idle = scout.as_ref().and_then(Scout::idle);
        let (cycle, schedule) = (scene.cycle.as_ref().map(|operation| operation.cycle.clone()), scene.schedule());
        Ok(Self {
            simulation: simulation(surfaces)?,
            scout: scout.filter(|_| idle.is_none()),
            idle,
            tolerance: scene.adaptive.map(|adaptive| adaptive.tolerance),
            events: EventLog::new(&scene.parameters, cycle.as_deref(), scene.duration, schedule.last()),
            schedule,
            output: scene.output.clone(),
            cycle,
            reached: 0.0,
        })
    }

    /// Tells whether the run chooses its acceleration, and so has a series of it.
    pub(crate) fn chooses_acceleration(&self) -> bool {
        self.scout.is_some()
    }

    /// Acceleration so far, if the scene has the run choose it.
    pub(crate) fn chosen_acceleration(&self) -> Option<Chosen> {
        let of_scout = |scout: &Scout| scout.choice().chosen(self.simulation.time());
        self.tolerance.map(|tolerance| self.scout.as_ref().map_or(Chosen::never(tolerance), of_scout))
    }

    /// Reason why the run is not accelerated (any more), if its scene has it choose.
    pub(crate) fn idle(&self) -> Option<Idle> {
        self.idle.or_else(|| self.scout.as_ref().and_then(Scout::idle))
    }

    /// Records of the events of the cycle that have ended.
    pub fn events(&self) -> &[EventRecord] {
        &self.events.progress().records
    }

    /// The complete state between two steps. All processes of a job take it together.
    pub fn checkpoint(&mut self) -> Result<SimulationState, SimulationError> {
        Ok(SimulationState {
            run: self.simulation.checkpoint()?,
            scout: self.scout.as_mut().map(Scout::checkpoint).transpose()?,
            reached: self.reached,
            events: self.events.progress().clone(),
        })
    }

    /// Goes on from a state of a run of the same scene, instead of from the start.
    pub fn restore(&mut self, state: &SimulationState) -> Result<(), SimulationError> {
        let SimulationState { run, scout, reached, events } = state;
        self.simulation.restore(run)?;
        self.reached = *reached;
        self.events.restore(events.clone());
        if let (Some(own), Some(scout)) = (&mut self.scout, scout) {
            own.restore(scout)?;
        }
        self.schedule.go_on(run.clock());
        Ok(())
    }
}
