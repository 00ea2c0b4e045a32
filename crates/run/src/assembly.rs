//! A scene put together: the simulation of a scene, the scout that goes before it, and when what is reported; and the time loop, which
//! takes it from its first step to its last and hands out samples and maps on the way.

use std::sync::Arc;
use std::time::{Duration, Instant};

use plateau_core::acceleration::Chosen;
use plateau_core::acceleration::scout::{Idle, Scout};
use plateau_core::model::brake::Brake;
use plateau_core::model::cycle::Cycle;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::observe::event::{EventLog, EventRecord};
use plateau_core::observe::extra::record_brake;
use plateau_core::observe::schedule::{Moment, Schedule};
use plateau_core::observe::{ACCELERATION, CYCLE, ROAD, Sample, Snapshot};
use plateau_core::simulation::{Course, Execution, Simulation, SimulationError};
use plateau_io::run_file::checkpoint::SimulationState;
use plateau_io::scene::{OutputSettings, Scene};

use crate::error::{InputError, RunError};

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
    /// Brake of whose pads the pin is a piece.
    brake: Option<Brake>,
    /// Records of the events of the cycle.
    pub(crate) events: EventLog,
    /// Physical time until which all that was due is reported, s: of a cycle it may lie in a pause, beyond the last step or
    /// before its end.
    pub(crate) reached: f64,
}

impl Assembly {
    /// The simulation of a scene in this process.
    pub fn new(scene: &Scene, surfaces: InitialSurfaces, execution: Execution) -> Result<Self, RunError> {
        Self::made_by(Simulation::with_execution, scene, surfaces, execution)
    }

    /// Assembles the scene from simulations that `make` makes.
    pub(crate) fn made_by(
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
            brake: scene.brake,
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

/// Time between two looks at progress and signals.
const LOOK_EVERY: Duration = Duration::from_millis(100);

/// Takes what a simulation reports.
pub trait Sink {
    /// Reason why the sink fails.
    type Error: From<SimulationError>;

    /// Takes a sample of the step just done.
    fn sample(&mut self, sample: Sample) -> Result<(), Self::Error>;

    /// Takes the maps after the step just done. Not called where the scene asks for none.
    fn snapshot(&mut self, _snapshot: Snapshot) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Called every few steps. `steps` is the number proposed until the next call; returns the number that it shall be.
    fn look(&mut self, _simulation: &Simulation, steps: u64) -> Result<u64, Self::Error> {
        Ok(steps)
    }

    /// Called between two steps when all that was due is done: here the run may be stopped and gone on with later.
    fn rest(&mut self, _assembly: &mut Assembly) -> Result<(), Self::Error> {
        Ok(())
    }
}

impl Assembly {
    /// Takes all steps that are left; the samples and maps that the scene asks for go to `sink`. A run with a scout chooses its
    /// acceleration.
    pub fn run_to_end<S: Sink>(&mut self, sink: &mut S) -> Result<(), S::Error> {
        let has_maps = !self.output.maps.is_empty();
        let mut steps_per_look = 1;
        if self.simulation.steps_done() == 0 && has_maps && self.schedule.begins_with_maps() {
            sink.snapshot(self.simulation.snapshot(&self.output.maps)?)?;
        }
        while let Some(moment) = self.schedule.next(self.simulation.steps_done(), self.reached) {
            let comparison = self.scout.as_ref().and_then(Scout::comparison);
            let noted = self.events.next(self.simulation.steps_done());
            let target = moment.step.min(comparison.unwrap_or(u64::MAX)).min(noted.unwrap_or(u64::MAX));
            let is_due = target == moment.step;
            let (sampled, mapped) = (is_due && moment.sample, is_due && moment.maps && has_maps);
            let is_watched = sampled || mapped || noted == Some(target);
            if self.simulation.steps_done() == target {
                // A long pause may have many samples.
                steps_per_look = sink.look(&self.simulation, steps_per_look)?;
            }
            while self.simulation.steps_done() < target {
                let start = Instant::now();
                match self.simulation.steps_done().saturating_add(steps_per_look) {
                    before if before < target => self.simulation.pass_to(before)?,
                    _ if is_watched => self.simulation.advance_to(target)?,
                    _ => self.simulation.pass_to(target)?,
                }
                steps_per_look = sink.look(&self.simulation, adapted(steps_per_look, start.elapsed()))?;
                if self.simulation.steps_done() < target {
                    self.reached = self.simulation.time();
                    sink.rest(self)?;
                }
            }
            if is_due && moment.pause.is_some() {
                self.simulation.keep_contact()?;
            }
            if noted == Some(target) {
                let mut sample = self.simulation.sample()?;
                if let Some(moment) = self.events.closing(target) {
                    sample.accounts = self.simulation.accounts_at(moment)?;
                }
                self.events.note(&sample);
            }
            if sampled {
                sink.sample(self.sample(&moment)?)?;
            }
            if mapped {
                sink.snapshot(self.simulation.snapshot_at(&moment, &self.output.maps)?)?;
            }
            self.reached = if is_due { moment.time } else { self.simulation.time() };
            if comparison == Some(target) && target < self.schedule.last() {
                self.choose_acceleration(sink, steps_per_look)?;
            }
            sink.rest(self)?;
        }
        Ok(self.simulation.check_heights()?)
    }

    /// The sample of the step just done, with all series that a run file of the scene has.
    pub fn last_sample(&mut self) -> Result<Sample, SimulationError> {
        let Course { steps, time, .. } = self.simulation.course();
        self.sample(&Moment { step: steps, time, ..Moment::default() })
    }

    /// Takes a sample of the step just done, or of a pause before or after its end.
    fn sample(&mut self, moment: &Moment) -> Result<Sample, SimulationError> {
        let mut sample = self.simulation.sample_at(moment, &self.output.extras)?;
        let parameters = self.simulation.parameters();
        let (mut force, mut turning, mut distance) =
            (self.simulation.course().load, self.simulation.last_speed(), f64::NAN);
        if let Some(cycle) = &self.cycle {
            let [load, speed] = cycle.operation_at(moment.step, parameters.step_angle(), moment.time, moment.pause);
            // How hard a braking torque presses, the steps alone know.
            force = if parameters.by_torque && load > 0.0 { force } else { load };
            (turning, distance) = (speed, cycle.road_distance_at(moment.time));
            CYCLE.record(&mut sample, [force, speed, cycle.contact_time_until(moment.time)]);
            ROAD.record(&mut sample, [distance]);
        } else if parameters.by_torque {
            CYCLE.record(&mut sample, [force, self.simulation.last_speed(), moment.time]);
        }
        if let Some(brake) = &self.brake {
            record_brake(brake, &parameters.mesh, [force, turning], distance, &mut sample);
        }
        if let Some(choice) = self.scout.as_ref().map(Scout::choice) {
            ACCELERATION.record(&mut sample, [choice.acceleration(), choice.error()]);
        }
        Ok(sample)
    }

    /// Has the scout come to where the run is, and chooses the acceleration anew.
    fn choose_acceleration<S: Sink>(&mut self, sink: &mut S, steps_per_look: u64) -> Result<(), S::Error> {
        let Some(scout) = &mut self.scout else { return Ok(()) };
        while !scout.advance(steps_per_look)? {
            sink.look(&self.simulation, steps_per_look)?;
        }
        if scout.compare(&mut self.simulation)? {
            self.schedule.change(self.simulation.steps_done(), self.simulation.parameters().step_time());
        }
        Ok(())
    }
}

/// The number of steps between two looks, after that many took so long.
pub fn adapted(steps: u64, time: Duration) -> u64 {
    if time > LOOK_EVERY {
        (steps / 2).max(1)
    } else if time < LOOK_EVERY / 2 {
        steps.saturating_mul(2)
    } else {
        steps
    }
}
