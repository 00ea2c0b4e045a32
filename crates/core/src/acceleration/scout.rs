//! A second simulation that goes beside a run, to see what its acceleration costs; and the discs too smooth for time acceleration where
//! debris is pooled, of which it cannot tell (model 4.2, 4P and 4.6).
//!
//! With local debris (4L) the gap behind a cell of resin takes what that cell loses, wherever it touches: nothing is raised
//! above the highest initial level, and no disc is too smooth.
//!
//! Resin loses its wear height at once where it touches, and its debris is compacted where the pin just is. On a rough disc
//! the topography decides where that is, at any m. On a smooth one the debris does: with m = 1 resin touches on the
//! highest part of the ring first, which its debris raises further, so that waves longer than the pin grow round the ring;
//! with a larger m a revolution lowers the pin by more than these waves are high, resin touches all round, and there
//! are none. That is an error that two accelerated runs share, so that comparing them does not show it.

use std::f64::consts::TAU;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::acceleration::{Adaptive, Choice, RATIO};
use crate::engine::parts::Needs;
use crate::model::parameters::Parameters;
use crate::model::state::{Base, InitialSurfaces};
use crate::observe::extra::root_mean_square_along_tracks;
use crate::simulation::checkpoint::Checkpoint;
use crate::simulation::{Simulation, SimulationError};

/// A simulation that begins with the state of a run whenever that begins to be accelerated, and goes on with [`RATIO`] times its
/// acceleration.
///
/// The two are compared whenever the scout has taken one revolution and the run [`RATIO`] of them, in which the same
/// physical time passes. While the run goes with m = 1, the scout rests. It fails as its [`Simulation`] and that of the run do.
#[derive(Debug)]
pub struct Scout {
    /// Simulation of the scout; none where the run will not be accelerated any more.
    simulation: Option<Simulation>,
    choice: Choice,
    smoothness: Option<Smoothness>,
    idle: Option<Idle>,
    /// Moment of the run at the last comparison.
    run: Mark,
    /// Moment of the scout at the last comparison.
    scout: Mark,
}

/// The complete state of a scout.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScoutCheckpoint {
    simulation: Option<Checkpoint>,
    choice: Choice,
    idle: Option<Idle>,
    run: Mark,
    scout: Mark,
}

/// Reason that a run is not accelerated (any more).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Idle {
    /// No m from 2 on is possible, and below that a scout does not pay.
    Limited,
    /// The disc is too smooth since this time (s): see [`crate::acceleration::scout`].
    Smooth(f64),
}

impl fmt::Display for Idle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Limited => write!(f, "nothing to choose, the run is not accelerated"),
            Self::Smooth(0.0) => write!(
                f,
                "the run is not accelerated: on a disc as smooth as this nobody knows the error, but with m = 1; \
                 a number accelerates it all the same"
            ),
            Self::Smooth(time) => write!(
                f,
                "the run was not accelerated from {time:.1} s on: on a disc as smooth as it was then nobody knows the \
                 error, but with m = 1"
            ),
        }
    }
}

/// A moment of a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Mark {
    steps: u64,
    time: f64,
    contact_area_integral: f64,
}

impl Mark {
    fn of(simulation: &Simulation) -> Self {
        let course = simulation.course();
        Self { steps: course.steps, time: course.time, contact_area_integral: course.contact_area_integral }
    }
}

impl Scout {
    /// A scout for a run of `duration` (s) that has not begun; `simulation` is another one like it.
    pub fn new(mut simulation: Simulation, adaptive: &Adaptive, duration: f64) -> Result<Self, SimulationError> {
        let parameters = simulation.parameters();
        let choice = Choice::new(adaptive, parameters, duration);
        let smoothness = Smoothness::of(parameters, simulation.pin_base());
        let limited = (!choice.is_free()).then_some(Idle::Limited);
        let idle = limited.or(too_smooth(smoothness, &mut simulation)?);
        let simulation = idle.is_none().then_some(simulation);
        Ok(Self { simulation, choice, smoothness, idle, run: Mark::default(), scout: Mark::default() })
    }

    /// Returns the reason that the run is not accelerated, if there is one.
    pub fn idle(&self) -> Option<Idle> {
        self.idle
    }

    /// Choice of m of the run, with the estimate of its error.
    pub fn choice(&self) -> &Choice {
        &self.choice
    }

    /// Tells whether the scout goes beside the run.
    fn is_at_work(&self) -> bool {
        self.choice.acceleration() > 1.0
    }

    /// The step of the run after which the acceleration is chosen anew; none any more if the run will not be accelerated.
    pub fn comparison(&self) -> Option<u64> {
        let revolution = self.simulation.as_ref().map(revolution)?;
        Some(self.run.steps + u64::from(RATIO) * revolution)
    }

    /// Takes at most `steps` steps. Returns whether the scout has come to where the two are compared, or rests.
    pub fn advance(&mut self, steps: u64) -> Result<bool, SimulationError> {
        let is_at_work = self.is_at_work();
        let Some(simulation) = self.simulation.as_mut().filter(|_| is_at_work) else { return Ok(true) };
        let end = self.scout.steps + revolution(simulation);
        simulation.pass_to(simulation.steps_done().saturating_add(steps).min(end))?;
        Ok(simulation.steps_done() == end)
    }

    /// The complete state, to go on from later.
    pub fn checkpoint(&mut self) -> Result<ScoutCheckpoint, SimulationError> {
        let simulation = self.simulation.as_mut().map(Simulation::checkpoint).transpose()?;
        let Self { choice, idle, run, scout, .. } = self;
        Ok(ScoutCheckpoint { simulation, choice: choice.clone(), idle: *idle, run: *run, scout: *scout })
    }

    /// Goes on from a checkpoint of a scout for the same run.
    pub fn restore(&mut self, checkpoint: &ScoutCheckpoint) -> Result<(), SimulationError> {
        match (&mut self.simulation, &checkpoint.simulation) {
            (Some(simulation), Some(state)) => simulation.restore(state)?,
            (simulation, _) => *simulation = None,
        }
        self.choice = checkpoint.choice.clone();
        (self.idle, self.run, self.scout) = (checkpoint.idle, checkpoint.run, checkpoint.scout);
        Ok(())
    }

    /// Compares the run with the scout, if that goes beside it, chooses the acceleration anew and changes that of both. Returns whether it
    /// changed.
    pub fn compare(&mut self, run: &mut Simulation) -> Result<bool, SimulationError> {
        let (was_at_work, acceleration) = (self.is_at_work(), self.choice.acceleration());
        let Some(scout) = &mut self.simulation else { return Ok(false) };
        let before = std::mem::replace(&mut self.run, Mark::of(run));
        let starts = if was_at_work {
            let scout_before = std::mem::replace(&mut self.scout, Mark::of(scout));
            let area = self.run.contact_area_integral - before.contact_area_integral;
            let scouted = self.scout.contact_area_integral - scout_before.contact_area_integral;
            self.choice.note(scouted / area - 1.0, self.run.time - before.time, self.run.time);
            false
        } else {
            self.choice.start(self.run.time)
        };
        if was_at_work || starts {
            self.idle = too_smooth(self.smoothness, run)?;
        }
        if self.idle.is_some() {
            self.choice.give_up();
            self.simulation = None;
        }
        let chosen = self.choice.acceleration();
        if chosen == acceleration {
            return Ok(false);
        }
        if let Some(scout) = self.simulation.as_mut().filter(|_| chosen > 1.0) {
            if starts {
                scout.restore(&run.checkpoint()?)?;
                self.scout = Mark::of(scout);
            }
            scout.accelerate(f64::from(RATIO) * chosen)?;
        }
        run.accelerate(chosen)?;
        Ok(true)
    }
}

/// Steps of a simulated revolution.
fn revolution(simulation: &Simulation) -> u64 {
    simulation.parameters().mesh.disc_columns() as u64
}

/// Returns [`Idle::Smooth`] if the disc is too smooth now.
fn too_smooth(smoothness: Option<Smoothness>, simulation: &mut Simulation) -> Result<Option<Idle>, SimulationError> {
    let Some(smoothness) = smoothness else { return Ok(None) };
    let disc_height = simulation.disc_height()?;
    Ok(smoothness.forbids(simulation.parameters(), &disc_height).then(|| Idle::Smooth(simulation.time())))
}

/// Least ratio of a disc's roughness to the pin's recession in a revolution with m = 1.
///
/// Of the paper's discs the roughest has 75, and 62 after 3000 s: waves grow, and are lost among its
/// asperities. The others begin with 7.5 and 0.75, and end as waves (docs/evidence/accuracy.md).
const ROUGH_ENOUGH: f64 = 20.0;

/// The roughness below which a disc is too smooth to accelerate its run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothness {
    /// Recession of the pin's fibres in a revolution with m = 1, if they carry the load alone, m.
    recession: f64,
}

impl Smoothness {
    /// Returns the least roughness for a pin; none where no resin wears, its debris is not compacted, or debris is local.
    pub fn of(parameters: &Parameters, pin_base: &[Base]) -> Option<Self> {
        let Parameters { mesh, materials, .. } = parameters;
        let base = || pin_base.iter().zip(mesh.pin_areas()).filter(|(_, area)| *area > 0.0);
        let wears = materials.wear_height > 0.0 && base().any(|(base, _)| base.is_resin());
        let pooled = Needs::of(parameters).pools && parameters.plateaus.captured_of_resin() > 0.0;
        if !(wears && pooled) {
            return None;
        }
        let fibre: f64 = base().filter(|(base, _)| !base.is_resin()).map(|(_, area)| area).sum();
        let radius = mesh.radius().iter().sum::<f64>() / mesh.rows() as f64;
        let pressure = parameters.usual_load() / fibre;
        Some(Self { recession: materials.pin_primary.specific_wear_rate * pressure * TAU * radius })
    }

    /// Tells whether a run that begins with these surfaces is not accelerated because its disc is too smooth.
    pub fn forbids_from_the_start(parameters: &Parameters, surfaces: &InitialSurfaces) -> bool {
        Self::of(parameters, &surfaces.pin_base)
            .is_some_and(|smoothness| smoothness.forbids(parameters, &surfaces.disc_height))
    }

    /// Tells whether a disc of these heights (m, column by column) is too smooth.
    pub(crate) fn forbids(&self, parameters: &Parameters, disc_height: &[f64]) -> bool {
        root_mean_square_along_tracks(&parameters.mesh, disc_height) < ROUGH_ENOUGH * self.recession
    }
}
