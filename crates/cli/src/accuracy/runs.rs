//! The runs of a scene: how each is made, and how long it takes.

use std::collections::BTreeMap;
use std::time::Duration;

use plateau_core::acceleration::scout::Scout;
use plateau_core::acceleration::smoothness::Smoothness;
use plateau_core::model::mesh::MeshError;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::{Execution, Simulation, SimulationError};
use plateau_io::scene::recipe::Scene;

use super::coarsening::Coarsening;
use super::ladder::COARSENINGS;
use super::measure::{Unfinished, measure};
use super::numerics::Numerics;
use super::outcome::Outcome;
use super::windows::Windows;
use crate::arguments::Ladder;
use crate::execution::time_per_step;
use crate::failure::Failure;
use crate::interrupt::Interrupt;

/// What a run that chooses its acceleration is thought to choose, at least, before it is made.
const USUAL_ACCELERATION: f64 = 20.0;
/// How long the first steps on a mesh are timed.
const TRIAL: Duration = Duration::from_millis(200);

/// A scene with all that its runs have in common.
#[derive(Debug)]
pub struct Runs<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// How its steps are made.
    pub execution: Execution,
    /// Whether a run that chooses its acceleration has none.
    pub too_smooth: bool,
    surfaces: &'a InitialSurfaces,
    interrupt: Interrupt,
    coarsenings: BTreeMap<usize, Coarsening>,
    /// Wall time of a step on every mesh, s, by its coarsening.
    step_times: BTreeMap<usize, f64>,
}

impl<'a> Runs<'a> {
    /// Makes coarser meshes where they are asked for, and times the first steps on every mesh.
    ///
    /// # Errors
    /// [`Failure`] when the scene's surfaces make no simulation, or its first steps fail.
    pub fn new(
        scene: &'a Scene,
        surfaces: &'a InitialSurfaces,
        execution: Execution,
        ladders: &[Ladder],
    ) -> Result<Self, Failure> {
        let mut runs = Self {
            scene,
            execution,
            too_smooth: Smoothness::forbids_from_the_start(&scene.parameters, surfaces),
            surfaces,
            interrupt: Interrupt::listen().map_err(Failure::run)?,
            coarsenings: BTreeMap::new(),
            step_times: BTreeMap::new(),
        };
        if ladders.contains(&Ladder::Mesh) {
            runs.coarsen().map_err(Failure::run)?;
        }
        let time = runs.try_steps(1)?;
        runs.step_times.insert(1, time);
        for coarsening in runs.coarsenings() {
            // If it fails, its run will, too, and say so; no step takes longer than on the scene's mesh.
            let time = runs.try_steps(coarsening).unwrap_or(time);
            runs.step_times.insert(coarsening, time);
        }
        Ok(runs)
    }

    /// Wall time of the first steps on a mesh, s each; without time acceleration, which could be too much for the scene.
    fn try_steps(&self, coarsening: usize) -> Result<f64, Failure> {
        let numerics = Numerics { coarsening, ..Numerics::of(self.scene).accelerated(1.0) };
        let mut simulation = self.simulation(&numerics).map_err(Failure::input)?;
        let last = simulation.parameters().steps_of(self.scene.duration);
        time_per_step(&mut simulation, last, TRIAL).map_err(Failure::run)
    }

    fn coarsen(&mut self) -> Result<(), MeshError> {
        for factor in COARSENINGS {
            let coarsening = Coarsening::new(&self.scene.parameters.mesh, &self.surfaces.pin_base, factor)?;
            self.coarsenings.extend(coarsening.map(|coarsening| (factor, coarsening)));
        }
        Ok(())
    }

    /// The coarser meshes that there are.
    pub fn coarsenings(&self) -> Vec<usize> {
        self.coarsenings.keys().copied().collect()
    }

    /// The mesh of a run, if it is coarser than the scene's.
    pub fn coarsening(&self, numerics: &Numerics) -> Option<&Coarsening> {
        self.coarsenings.get(&numerics.coarsening)
    }

    /// What the simulation of a run is told.
    pub fn parameters(&self, numerics: &Numerics) -> Parameters {
        numerics.parameters(self.scene, self.coarsening(numerics))
    }

    /// About how long a run takes, s.
    pub fn seconds(&self, numerics: &Numerics) -> f64 {
        let steps = self.parameters(numerics).steps_of(self.scene.duration) as f64;
        let time = self.step_times.get(&numerics.coarsening).copied().unwrap_or(0.0) * steps;
        if numerics.adaptive.is_some() && !self.too_smooth { time / USUAL_ACCELERATION } else { time }
    }

    /// Steps per second on the scene's mesh, as far as is known.
    pub fn speed(&self) -> f64 {
        self.step_times.get(&1).map_or(f64::NAN, |time| 1.0 / time)
    }

    /// Makes a run of `duration` (s); `name` is shown meanwhile.
    ///
    /// # Errors
    /// [`Unfinished`].
    pub fn make(
        &mut self,
        numerics: &Numerics,
        duration: f64,
        windows: &Windows,
        name: &str,
    ) -> Result<Outcome, Unfinished> {
        let mut simulation = self.simulation(numerics)?;
        let scout = self.scout(numerics, duration)?;
        let outcome = measure(&mut simulation, scout, duration, windows, name, &self.interrupt)?;
        // A run tells better than a trial how long steps take, if it took longer.
        if numerics.adaptive.is_none() && outcome.wall_time > TRIAL.as_secs_f64() {
            self.step_times.insert(numerics.coarsening, outcome.wall_time / outcome.steps as f64);
        }
        Ok(outcome)
    }

    fn simulation(&self, numerics: &Numerics) -> Result<Simulation, SimulationError> {
        let coarsening = self.coarsening(numerics);
        let mut surfaces = coarsening.map_or_else(|| self.surfaces.clone(), |coarse| coarse.surfaces(self.surfaces));
        if numerics.perturbation != 0.0 {
            surfaces.disc_height.iter_mut().for_each(|height| *height *= 1.0 + numerics.perturbation);
        }
        let parameters = numerics.parameters(self.scene, coarsening);
        Simulation::with_execution(parameters, surfaces, self.execution)
    }

    /// What goes before a run that chooses its acceleration.
    fn scout(&self, numerics: &Numerics, duration: f64) -> Result<Option<Scout>, SimulationError> {
        let Some(adaptive) = &numerics.adaptive else { return Ok(None) };
        let scout = Scout::new(self.simulation(numerics)?, adaptive, duration)?;
        Ok(scout.idle().is_none().then_some(scout))
    }
}
