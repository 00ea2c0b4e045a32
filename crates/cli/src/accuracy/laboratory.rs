//! Makes the runs of a scene: reference first, then the quickest rungs, within a budget of wall time.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use plateau_core::mesh::MeshError;
use plateau_core::scout::Scout;
use plateau_core::simulation::{Execution, Simulation, SimulationError};
use plateau_core::smoothness::Smoothness;
use plateau_core::state::InitialSurfaces;
use plateau_io::dataset_file::now;
use plateau_io::scene::recipe::Scene;

use super::coarsening::Coarsening;
use super::comparison::Comparison;
use super::history::History;
use super::history_error::HistoryError;
use super::ladder::{COARSENINGS, Rung, rungs, time_accelerations};
use super::measure::{Unfinished, measure};
use super::numerics::Numerics;
use super::outcome::Outcome;
use super::plan::{Plan, TooSmall, plan, plan_beside};
use super::reference::{Provenance, ReadReference, Reference};
use super::report::{Measured, Report, Row};
use super::windows::{Windows, common_multiple};
use crate::arguments::Ladder;
use crate::execution::{cores, time_per_step};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::{machine, number, version};

/// What a run that chooses its acceleration is thought to choose, at least, before it is made.
const USUAL_ACCELERATION: f64 = 20.0;
/// How long the first steps on a mesh are timed.
const TRIAL: Duration = Duration::from_millis(200);
/// Narrowest window, s.
const LEAST_WINDOW: f64 = 5.0;
/// Samples of a reference in a window that ends between them, at least: interpolation errs by a part of their distance.
const SAMPLES_PER_WINDOW: f64 = 20.0;

/// What is asked for.
#[derive(Debug)]
pub struct Wish {
    /// Ladders, in order.
    pub ladders: Vec<Ladder>,
    /// Wall time that all runs may take, s.
    pub budget: f64,
    /// A reference that was read.
    pub reference: Option<ReadReference>,
}

/// What was found, and the signal that stopped the search, if one did.
#[derive(Debug)]
pub struct Found {
    /// What was found until then.
    pub report: Report,
    /// The signal.
    pub stopped: Option<u8>,
}

/// A scene with all that its runs have in common.
#[derive(Debug)]
pub struct Laboratory<'a> {
    scene: &'a Scene,
    surfaces: &'a InitialSurfaces,
    execution: Execution,
    interrupt: Interrupt,
    started: Instant,
    coarsenings: BTreeMap<usize, Coarsening>,
    /// Wall time of a step on every mesh, s, by its coarsening.
    step_times: BTreeMap<usize, f64>,
    notes: Vec<String>,
    /// Whether a run that chooses its acceleration has none.
    too_smooth: bool,
}

impl<'a> Laboratory<'a> {
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
        let mut laboratory = Self {
            scene,
            surfaces,
            execution,
            interrupt: Interrupt::listen().map_err(Failure::run)?,
            started: Instant::now(),
            coarsenings: BTreeMap::new(),
            step_times: BTreeMap::new(),
            notes: Vec::new(),
            too_smooth: Smoothness::forbids_from_the_start(&scene.parameters, surfaces),
        };
        if laboratory.too_smooth && ladders.contains(&Ladder::Tolerance) {
            let note =
                "the disc is so smooth that a run which chooses its acceleration has none: it takes all the steps";
            laboratory.notes.push(note.to_owned());
        }
        if ladders.contains(&Ladder::Mesh) {
            laboratory.coarsen().map_err(Failure::run)?;
        }
        let time = laboratory.try_steps(1)?;
        laboratory.step_times.insert(1, time);
        for coarsening in laboratory.coarsenings.keys().copied().collect::<Vec<_>>() {
            // If it fails, its run will, too, and say so; no step takes longer than on the scene's mesh.
            let time = laboratory.try_steps(coarsening).unwrap_or(time);
            laboratory.step_times.insert(coarsening, time);
        }
        Ok(laboratory)
    }

    /// Wall time of the first steps on a mesh, s each; without time acceleration, which could be too much for the scene.
    fn try_steps(&self, coarsening: usize) -> Result<f64, Failure> {
        let numerics = Numerics { coarsening, ..Numerics::of(self.scene).accelerated(1.0) };
        let mut simulation = self.simulation(&numerics).map_err(Failure::input)?;
        time_per_step(&mut simulation, TRIAL).map_err(Failure::run)
    }

    fn coarsen(&mut self) -> Result<(), MeshError> {
        for factor in COARSENINGS {
            match Coarsening::new(&self.scene.parameters.mesh, &self.surfaces.pin_base, factor)? {
                Some(coarsening) => drop(self.coarsenings.insert(factor, coarsening)),
                None => self.notes.push(format!("a mesh coarsened {factor} times has too few cells: not run")),
            }
        }
        Ok(())
    }

    /// Makes the reference, unless there is one, and the runs that fit into the budget.
    ///
    /// # Errors
    /// [`Failure::Input`] when the budget is too small, [`Failure::Run`] when the reference fails, and
    /// [`Failure::Stopped`] when a signal came before anything could be compared.
    pub fn search(mut self, wish: Wish) -> Result<Found, Failure> {
        let plan = self.plan(&wish)?;
        let windows = self.windows(&plan, &wish);
        let reference = match wish.reference {
            Some(read) => {
                self.notes.extend(read.missing);
                read.reference
            }
            None => self.make_reference(plan.reference, &windows)?,
        };
        let (rows, stopped) = self.climb(&plan, &reference, &windows, wish.budget)?;
        if let Some(load) = machine::load().filter(|load| *load > cores() as f64 + 0.5) {
            self.notes.push(format!(
                "other programs were running, too (load {load} on {} cores): wall times are longer than on a quiet machine",
                cores()
            ));
        }
        let title = self.scene.title.clone();
        let mut report = Report { title, reference, windows, rows, notes: self.notes };
        report.complete();
        Ok(Found { report, stopped })
    }

    fn plan(&mut self, wish: &Wish) -> Result<Plan, Failure> {
        let own = Numerics::of(self.scene);
        let revolutions = self.scene.duration / self.revolution();
        let accelerations = time_accelerations(own.time_acceleration, revolutions);
        let factors: Vec<usize> = self.coarsenings.keys().copied().collect();
        let rungs = |reference: f64| rungs(&wish.ladders, own, &accelerations, &factors, reference);
        let seconds = |numerics: &Numerics| self.seconds(numerics);
        let plan = match &wish.reference {
            Some(read) => plan_beside(read.reference.time_acceleration, rungs, seconds, wish.budget),
            None => plan(&accelerations, own, rungs, seconds, wish.budget),
        };
        let plan = plan.map_err(|too_small| refusal(&too_small, wish.budget))?;
        if plan.reference > 1.0 && wish.reference.is_none() {
            self.notes.push(format!(
                "the reference has time_acceleration = {}, the finest that the budget of {} allows: errors against the \
                 model itself (1) are larger",
                plan.reference,
                number::duration(wish.budget)
            ));
        }
        if plan.base.time_acceleration > own.time_acceleration {
            self.notes.push(format!(
                "the scene's own time_acceleration = {} is finer than the reference: not run",
                own.time_acceleration
            ));
        }
        Ok(plan)
    }

    /// Time of a revolution, s.
    fn revolution(&self) -> f64 {
        std::f64::consts::TAU / self.scene.parameters.angular_velocity
    }

    /// The same windows for all runs: whole revolutions of each of them, if that can be.
    fn windows(&mut self, plan: &Plan, wish: &Wish) -> Windows {
        let mut accelerations: Vec<f64> = plan.rungs.iter().map(|rung| rung.numerics.time_acceleration).collect();
        accelerations.push(plan.reference);
        let unit = common_multiple(&accelerations) * self.revolution();
        let duration = self.scene.duration;
        let windows = |least: f64| Windows::new(duration, unit, LEAST_WINDOW.max(least));
        let Some(ReadReference { reference, sample_every, .. }) = &wish.reference else { return windows(0.0) };
        let narrow = windows(2.0 * sample_every);
        let step =
            self.scene.parameters.step_time() * reference.time_acceleration / self.scene.parameters.time_acceleration;
        if reference.outcome.history.knows(&narrow, step) {
            return narrow;
        }
        self.notes.push(format!(
            "windows end between samples of the reference, which are {} s apart: interpolation adds an error of its own, \
             larger the larger its time_acceleration; with one sample a revolution there is none",
            number::short(*sample_every)
        ));
        windows(SAMPLES_PER_WINDOW * sample_every)
    }

    fn make_reference(&mut self, time_acceleration: f64, windows: &Windows) -> Result<Reference, Failure> {
        let numerics = Numerics::of(self.scene).accelerated(time_acceleration);
        let start_time = now();
        let mut simulation = self.simulation(&numerics).map_err(Failure::run)?;
        let name = format!("reference, time_acceleration = {time_acceleration}");
        let outcome = measure(&mut simulation, None, self.scene.duration, windows, &name, &self.interrupt).map_err(
            |unfinished| match unfinished {
                Unfinished::Stopped(signal) => Failure::Stopped {
                    signal,
                    message: Some(format!("stopped by signal {signal} during the reference run; nothing is written")),
                },
                failed => {
                    Failure::run(format_args!("the reference with time_acceleration = {time_acceleration}: {failed}"))
                }
            },
        )?;
        self.learn(&numerics, &outcome);
        let provenance = Provenance {
            file: None,
            program: version::program(),
            source_revision: version::REVISION.to_owned(),
            host: machine::host(),
            workers: simulation.execution().workers as u64,
            start_time,
        };
        Ok(Reference { time_acceleration, outcome, provenance })
    }

    /// Runs the rungs, the scene's own run and then the quickest first.
    fn climb(
        &mut self,
        plan: &Plan,
        reference: &Reference,
        windows: &Windows,
        budget: f64,
    ) -> Result<(Vec<Row>, Option<u8>), Failure> {
        let mut waiting = plan.rungs.clone();
        let own_first = |rung: &Rung| (rung.numerics != plan.base, self.seconds(&rung.numerics));
        waiting.sort_by(|one, other| {
            let ((one_later, one), (other_later, other)) = (own_first(one), own_first(other));
            one_later.cmp(&other_later).then(one.total_cmp(&other))
        });
        let own_is_reference =
            plan.base.adaptive.is_none() && plan.base.time_acceleration == reference.time_acceleration;
        let mut own: Option<History> = own_is_reference.then(|| reference.outcome.history.clone());
        let mut rows = Vec::new();
        for rung in waiting {
            if !self.has_time(&rung, budget) {
                continue;
            }
            let outcome = match self.run(&rung, windows) {
                Err(Unfinished::Stopped(signal)) if rows.is_empty() => {
                    let message =
                        format!("stopped by signal {signal} before any run could be compared; nothing is written");
                    return Err(Failure::Stopped { signal, message: Some(message) });
                }
                Err(Unfinished::Stopped(signal)) => return Ok((rows, Some(signal))),
                outcome => outcome.map_err(|failed| failed.to_string()),
            };
            if rung.numerics == plan.base {
                own = outcome.as_ref().ok().map(|outcome| outcome.history.clone());
            }
            rows.push(self.row(rung, outcome, reference, windows, own.as_ref()));
        }
        Ok((rows, None))
    }

    /// Whether a run fits into what is left of the budget (s); if not, that is noted.
    fn has_time(&mut self, rung: &Rung, budget: f64) -> bool {
        let left = budget - self.started.elapsed().as_secs_f64();
        let needed = self.seconds(&rung.numerics);
        if needed > left {
            self.notes.push(format!(
                "{}: not run, it takes about {} and {} of the budget are left",
                rung.full_name(),
                number::duration(needed),
                number::duration(left.max(0.0))
            ));
        }
        needed <= left
    }

    fn run(&mut self, rung: &Rung, windows: &Windows) -> Result<Outcome, Unfinished> {
        let mut simulation = self.simulation(&rung.numerics)?;
        let scout = self.scout(&rung.numerics)?;
        let duration = self.scene.duration;
        let outcome = measure(&mut simulation, scout, duration, windows, &rung.full_name(), &self.interrupt)?;
        self.learn(&rung.numerics, &outcome);
        Ok(outcome)
    }

    /// Holds a run against the reference, and against the scene's own run, from which all ladders but that of time
    /// accelerations and that of perturbed references start.
    fn row(
        &self,
        rung: Rung,
        outcome: Result<Outcome, String>,
        reference: &Reference,
        windows: &Windows,
        own: Option<&History>,
    ) -> Row {
        let coarsening = self.coarsenings.get(&rung.numerics.coarsening);
        let parameters = rung.numerics.parameters(self.scene, coarsening);
        let cells = [parameters.mesh.rows(), parameters.mesh.disc_columns(), parameters.mesh.pin_columns()];
        let own =
            own.filter(|_| !matches!(rung.ladder, Ladder::TimeAcceleration | Ladder::Tolerance | Ladder::Perturbation));
        let result = outcome.map(|outcome| {
            let mesh = &self.scene.parameters.mesh;
            let comparison = Comparison::of(&outcome, &reference.outcome, windows, mesh, coarsening);
            let areas = |history: &History| history.at(windows).mean_areas();
            let change = own.map(|own| HistoryError::of(&areas(&outcome.history), &areas(own)).mean_square);
            Measured::of(outcome, comparison, change.unwrap_or(f64::NAN))
        });
        Row::new(rung, cells, parameters.stiffness_number(), result)
    }

    fn simulation(&self, numerics: &Numerics) -> Result<Simulation, SimulationError> {
        let coarsening = self.coarsenings.get(&numerics.coarsening);
        let mut surfaces = coarsening.map_or_else(|| self.surfaces.clone(), |coarse| coarse.surfaces(self.surfaces));
        if numerics.perturbation != 0.0 {
            surfaces.disc_height.iter_mut().for_each(|height| *height *= 1.0 + numerics.perturbation);
        }
        Simulation::with_execution(numerics.parameters(self.scene, coarsening), surfaces, self.execution)
    }

    /// What goes before a run that chooses its acceleration.
    fn scout(&self, numerics: &Numerics) -> Result<Option<Scout>, SimulationError> {
        let Some(adaptive) = &numerics.adaptive else { return Ok(None) };
        let scout = Scout::new(self.simulation(numerics)?, adaptive, self.scene.duration)?;
        Ok(scout.idle().is_none().then_some(scout))
    }

    /// About how long a run takes, s.
    fn seconds(&self, numerics: &Numerics) -> f64 {
        let parameters = numerics.parameters(self.scene, self.coarsenings.get(&numerics.coarsening));
        let time = self.step_times.get(&numerics.coarsening).copied().unwrap_or(0.0) * parameters.steps as f64;
        if numerics.adaptive.is_some() && !self.too_smooth { time / USUAL_ACCELERATION } else { time }
    }

    /// A run tells better than a trial how long steps take, if it took longer.
    fn learn(&mut self, numerics: &Numerics, outcome: &Outcome) {
        if numerics.adaptive.is_none() && outcome.wall_time > TRIAL.as_secs_f64() {
            self.step_times.insert(numerics.coarsening, outcome.wall_time / outcome.steps as f64);
        }
    }
}

/// Says why there is no plan.
fn refusal(too_small: &TooSmall, budget: f64) -> Failure {
    let TooSmall { needed, reference } = *too_small;
    if needed == 0.0 {
        return Failure::input(format_args!(
            "nothing is coarser than the reference with time_acceleration = {reference}: choose other ladders, a longer \
             duration or a finer reference"
        ));
    }
    // With room, for the estimate is one.
    let enough = (1.2 * needed).ceil().max(1.0);
    let (budget, needed) = (number::duration(budget), number::duration(needed));
    Failure::input(format_args!(
        "the budget of {budget} is too small: with time_acceleration = {reference} as the reference the runs take about \
         {needed}; give --budget {enough}s or more"
    ))
}
