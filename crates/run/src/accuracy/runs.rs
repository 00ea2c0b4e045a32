//! The runs of a scene: how each is made and measured, and how long it takes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use plateau_core::acceleration::smoothness::Smoothness;
use plateau_core::model::mesh::MeshError;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::observe::schedule::SampleEvery;
use plateau_core::observe::{Map, MapValues, Sample, Snapshot};
use plateau_core::simulation::{Execution, Simulation};
use plateau_io::scene::{OutputSettings, Scene};

use super::coarsening::Coarsening;
use super::comparison::{End, Heights, Outcome};
use super::error::{AccuracyError, Unfinished};
use super::history::{History, Windows};
use super::ladder::{COARSENINGS, Ladder, Numerics};
use crate::assembly::Assembly;
use crate::error::{InputError, RunError};
use crate::execution::time_per_step;
use crate::observer::Observer;
use crate::time_loop::Sink;

/// What a run that chooses its acceleration is thought to choose, at least, before it is made.
const USUAL_ACCELERATION: f64 = 20.0;
/// How long the first steps on a mesh are timed.
const TRIAL: Duration = Duration::from_millis(200);

/// A scene with all that its runs have in common.
pub struct Runs<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// How its steps are made.
    pub execution: Execution,
    /// Whether a run that chooses its acceleration has none.
    pub too_smooth: bool,
    surfaces: &'a InitialSurfaces,
    observer: &'a mut dyn Observer,
    coarsenings: BTreeMap<usize, Coarsening>,
    /// Wall time of a step on every mesh, s, by its coarsening.
    step_times: BTreeMap<usize, f64>,
}

impl<'a> Runs<'a> {
    /// Makes coarser meshes where they are asked for, and times the first steps on every mesh.
    ///
    /// # Errors
    /// [`AccuracyError`] when the scene's surfaces make no simulation, or its first steps fail.
    pub fn new(
        scene: &'a Scene,
        surfaces: &'a InitialSurfaces,
        execution: Execution,
        ladders: &[Ladder],
        observer: &'a mut dyn Observer,
    ) -> Result<Self, AccuracyError> {
        let mut runs = Self {
            scene,
            execution,
            too_smooth: Smoothness::forbids_from_the_start(&scene.parameters, surfaces),
            surfaces,
            observer,
            coarsenings: BTreeMap::new(),
            step_times: BTreeMap::new(),
        };
        if ladders.contains(&Ladder::Mesh) {
            runs.coarsen()?;
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
    fn try_steps(&self, coarsening: usize) -> Result<f64, RunError> {
        let numerics = Numerics { coarsening, ..Numerics::of(self.scene).accelerated(1.0) };
        let (parameters, surfaces) = (self.parameters(&numerics), self.surfaces(&numerics));
        let mut simulation =
            Simulation::with_execution(parameters, surfaces, self.execution).map_err(InputError::Simulation)?;
        let last = simulation.parameters().steps_of(self.scene.duration);
        Ok(time_per_step(&mut simulation, last, TRIAL)?)
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
        let assembly = self.assembly(numerics, duration, windows)?;
        self.observer.starts(name, duration);
        let outcome = measure(assembly, windows.count, self.observer);
        self.observer.ends();
        let outcome = outcome?;
        // A run tells better than a trial how long steps take, if it took longer.
        if let Some(wall_time) = outcome.wall_time.filter(|time| *time > TRIAL.as_secs_f64())
            && numerics.adaptive.is_none()
        {
            self.step_times.insert(numerics.coarsening, wall_time / outcome.steps as f64);
        }
        Ok(outcome)
    }

    /// The scene with other numerics, of which heights at the end and samples at the ends of windows are wanted.
    fn assembly(&self, numerics: &Numerics, duration: f64, windows: &Windows) -> Result<Assembly, RunError> {
        let parameters = self.parameters(numerics);
        let output = OutputSettings {
            file: PathBuf::new(),
            sample_every: SampleEvery::Time(windows.width),
            maps_at: Vec::new(),
            maps: vec![Map::DiscHeight, Map::PinHeight],
            extras: Vec::new(),
            checkpoint_every: f64::INFINITY,
        };
        let (steps, adaptive) = (parameters.steps_of(duration), numerics.adaptive);
        let mut scene = Scene { parameters, steps, adaptive, duration, output, ..self.scene.clone() };
        let mut assembly = Assembly::new(&scene, self.surfaces(numerics), self.execution)?;
        if assembly.idle().is_some() {
            // Nothing changes its acceleration: it ends after a number of steps, as other runs do.
            scene.adaptive = None;
            assembly.schedule = scene.schedule();
        }
        Ok(assembly)
    }

    /// The initial surfaces of a run.
    fn surfaces(&self, numerics: &Numerics) -> InitialSurfaces {
        let coarsening = self.coarsening(numerics);
        let mut surfaces = coarsening.map_or_else(|| self.surfaces.clone(), |coarse| coarse.surfaces(self.surfaces));
        if numerics.perturbation != 0.0 {
            surfaces.disc_height.iter_mut().for_each(|height| *height *= 1.0 + numerics.perturbation);
        }
        surfaces
    }
}

/// Takes the steps of a run that is compared over so many windows, and keeps what is compared.
///
/// # Errors
/// [`Unfinished`].
pub fn measure(mut assembly: Assembly, windows: usize, observer: &mut dyn Observer) -> Result<Outcome, Unfinished> {
    let (history, last, heights) = (History::start(), Sample::default(), Heights::default());
    let mut record = Record { observer, windows, history, last, heights };
    let start = Instant::now();
    assembly.run_to_end(&mut record)?;
    let wall_time = Some(start.elapsed().as_secs_f64());
    let Record { history, last, heights, .. } = record;
    let end = End::of(&last, assembly.simulation.course().largest_load_residual);
    Ok(Outcome { steps: assembly.simulation.steps_done(), wall_time, history, end, heights })
}

/// Keeps what is compared.
struct Record<'a> {
    observer: &'a mut dyn Observer,
    windows: usize,
    history: History,
    last: Sample,
    heights: Heights,
}

impl Sink for Record<'_> {
    type Error = Unfinished;

    fn sample(&mut self, sample: Sample) -> Result<(), Unfinished> {
        if !(sample.contact_area_integral.is_finite() && sample.filled_fraction.is_finite()) {
            return Err(Unfinished::NotFinite { step: sample.step });
        }
        // What comes after the last window is its end.
        if self.history.moments() < self.windows {
            self.history.record(sample.time, sample.contact_area_integral, sample.filled_fraction);
        }
        self.last = sample;
        Ok(())
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), Unfinished> {
        for (map, values) in snapshot.maps {
            let MapValues::Float(heights) = values else { continue };
            match map {
                Map::DiscHeight => self.heights.disc = Some(heights),
                Map::PinHeight => self.heights.pin = Some(heights),
                _ => {}
            }
        }
        Ok(())
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, Unfinished> {
        self.observer.progress(simulation);
        self.observer.asked_to_stop().map_or(Ok(steps), |signal| Err(Unfinished::Stopped(signal)))
    }
}
