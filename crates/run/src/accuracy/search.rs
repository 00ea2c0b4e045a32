//! Error against run time of one scene: the reference, its own error, and the runs held against it, within a budget.

use std::time::Instant;

use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::Execution;
use plateau_io::dataset_file::now;
use plateau_io::number;
use plateau_io::scene::Scene;

use super::comparison::{Comparison, HistoryError, Outcome};
use super::error::{AccuracyError, PlanError, Unfinished, enough};
use super::history::{History, LEAST_WINDOW, Windows, common_multiple};
use super::ladder::{COARSENINGS, Ladder, Numerics, Rung, time_accelerations};
use super::plan::{Plan, Refusal, Task, plan};
use super::reference::{OwnError, Provenance, ReadReference, Reference};
use super::report::{Measured, Report, Row};
use super::runs::Runs;
use crate::execution::cores;
use crate::machine;
use crate::observer::Observer;
use crate::options::Program;

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
    /// Who makes the runs.
    pub program: Program,
}

/// What was found, and the signal that stopped the search, if one did.
#[derive(Debug)]
pub struct Found {
    /// What was found until then.
    pub report: Report,
    /// The signal.
    pub stopped: Option<u8>,
}

/// Makes the reference, unless there is one, and the runs that fit into the budget.
///
/// # Errors
/// [`AccuracyError`] when the budget is too small or the reference too coarse, when the reference fails, and when a signal came
/// before anything could be compared.
pub fn search(
    scene: &Scene,
    surfaces: &InitialSurfaces,
    execution: Execution,
    mut wish: Wish,
    observer: &mut dyn Observer,
) -> Result<Found, AccuracyError> {
    let started = Instant::now();
    let mut notes = Vec::new();
    if scene.cycle.is_some() && wish.ladders.contains(&Ladder::Tolerance) {
        wish.ladders.retain(|ladder| *ladder != Ladder::Tolerance);
        notes.push("the ladder tolerance is left out: a run with a cycle does not choose its acceleration".to_owned());
    }
    let runs = Runs::new(scene, surfaces, execution, &wish.ladders, observer)?;
    let read = wish.reference.take();
    let mut search = Search { runs, wish, started, notes };
    let plan = search.plan(read.as_ref())?;
    search.note_what_is_left_out(&plan, read.is_some());
    let windows = search.windows(&plan, read.as_ref());
    let (own_error, scene_in_opening) = search.open(&plan, read.as_ref())?;
    let reference = match read {
        Some(read) => {
            search.notes.extend(read.missing);
            read.reference
        }
        None => search.make_reference(plan.reference, &windows)?,
    };
    let (rows, stopped) = search.climb(&plan, &reference, &windows)?;
    if let Some(load) = machine::load().filter(|load| *load > cores() as f64 + 0.5) {
        search.notes.push(format!(
            "other programs were running, too (load {load} on {} cores): wall times are longer than on a quiet machine",
            cores()
        ));
    }
    let own_run = rows.iter().find(|row| row.rung.numerics == Numerics::of(scene));
    let own_error = own_error.growing(scene_in_opening, own_run.map_or(f64::NAN, Row::error));
    let mut report = Report { title: scene.title.clone(), reference, own_error, windows, rows, notes: search.notes };
    report.complete();
    Ok(Found { report, stopped })
}

/// A search on its way.
struct Search<'a> {
    runs: Runs<'a>,
    wish: Wish,
    started: Instant,
    notes: Vec<String>,
}

impl Search<'_> {
    fn plan(&self, read: Option<&ReadReference>) -> Result<Plan, AccuracyError> {
        let scene = self.runs.scene;
        let (own, revolution) = (Numerics::of(scene), self.revolution());
        let accelerations = time_accelerations(own.time_acceleration, scene.duration / revolution);
        let task = Task {
            own,
            accelerations: &accelerations,
            ladders: &self.wish.ladders,
            coarsenings: &self.runs.coarsenings(),
            duration: scene.duration,
            revolution,
            budget: self.wish.budget,
        };
        let read = read.map(|read| read.reference.time_acceleration);
        let plan = plan(&task, read, |numerics| self.runs.seconds(numerics));
        Ok(plan.map_err(|refusal| self.refuse(&refusal, &own, read))?)
    }

    fn note_what_is_left_out(&mut self, plan: &Plan, is_read: bool) {
        let (ladders, there) = (&self.wish.ladders, self.runs.coarsenings());
        if plan.reference > 1.0 {
            let better = if is_read {
                "one with 1, the model itself, is better".to_owned()
            } else {
                format!(
                    "the finest that the budget of {} allows; for 1, the model itself, give --budget {}",
                    number::duration(self.wish.budget),
                    enough(plan.budget_of_model)
                )
            };
            self.notes.push(format!("the reference has time_acceleration = {}: {better}", plan.reference));
        }
        if ladders.contains(&Ladder::Tolerance) {
            if plan.reference > 1.0 {
                let note =
                    "runs that choose their acceleration begin with 1: not run, for the reference is not as fine";
                self.notes.push(note.to_owned());
            } else if self.runs.too_smooth {
                let note =
                    "the disc is so smooth that a run which chooses its acceleration has none: it takes all the steps";
                self.notes.push(note.to_owned());
            }
        }
        if ladders.contains(&Ladder::Mesh) {
            let missing = COARSENINGS.iter().filter(|factor| !there.contains(factor));
            let note = |factor| format!("a mesh coarsened {factor} times has too few cells: not run");
            self.notes.extend(missing.map(note));
        }
    }

    /// Says why there is no plan.
    fn refuse(&self, refusal: &Refusal, own: &Numerics, read: Option<f64>) -> PlanError {
        let scene = own.acceleration();
        match *refusal {
            Refusal::NotFiner => PlanError::NotFiner { reference: read.unwrap_or(f64::NAN), scene },
            Refusal::NothingToRun { reference } => PlanError::NothingToRun { reference },
            Refusal::TooSmall { reference, needed, budget_of_model } => {
                let (what, model) = match read {
                    Some(_) => ("the runs to hold against the reference".to_owned(), String::new()),
                    None if own.adaptive.is_none() && own.time_acceleration == 1.0 => (
                        "the scene's own run, which is the reference, and one to hold against it".to_owned(),
                        String::new(),
                    ),
                    None => (
                        format!(
                            "a reference with time_acceleration = {reference}, finer than the scene's {scene}, and the \
                             runs to hold against it"
                        ),
                        match reference {
                            1.0 => String::new(),
                            _ => format!(", or {} for a reference with 1, the model itself", enough(budget_of_model)),
                        },
                    ),
                };
                let (budget, speed) = (self.wish.budget, self.runs.speed());
                PlanError::TooSmall { budget, speed, what, needed, model }
            }
        }
    }

    /// Time of a revolution, s.
    fn revolution(&self) -> f64 {
        std::f64::consts::TAU / self.runs.scene.parameters.angular_velocity
    }

    /// The same windows for all runs: whole revolutions of each of them, if that can be.
    fn windows(&mut self, plan: &Plan, read: Option<&ReadReference>) -> Windows {
        let mut accelerations: Vec<f64> = plan.rungs.iter().map(|rung| rung.numerics.time_acceleration).collect();
        accelerations.push(plan.reference);
        let unit = common_multiple(&accelerations) * self.revolution();
        let Scene { duration, parameters, .. } = self.runs.scene;
        let windows = |least: f64| Windows::new(*duration, unit, LEAST_WINDOW.max(least));
        let Some(ReadReference { reference, sample_every, .. }) = read else { return windows(0.0) };
        let narrow = windows(2.0 * sample_every);
        let step = parameters.step_time() * reference.time_acceleration / parameters.time_acceleration;
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

    /// Runs the opening with the model itself, as the reference does and as the scene does. Gives the reference's error there,
    /// and that of the scene against the reference.
    fn open(&mut self, plan: &Plan, read: Option<&ReadReference>) -> Result<(OwnError, f64), AccuracyError> {
        let Some(opening) = plan.opening else { return Ok((OwnError::NONE, f64::NAN)) };
        let (own, end) = (Numerics::of(self.runs.scene), opening.span());
        let integrator = read.map_or(own.integrator, |read| read.integrator);
        let mut areas = |numerics: Numerics| {
            let name = format!("the first {} s with {}", number::short(end), numerics.acceleration());
            let made = self.runs.make(&numerics, end, &opening, &name);
            let outcome = made.map_err(|unfinished| unfinished_before_any(unfinished, &name))?;
            Ok::<_, AccuracyError>(outcome.history.mean_areas())
        };
        let model = areas(own.accelerated(1.0))?;
        let reference = areas(Numerics { integrator, ..own.accelerated(plan.reference) })?;
        let scene = areas(own)?;
        let error = OwnError {
            opening: HistoryError::of(&reference, &model).mean_square,
            growth: 1.0,
            end,
            comes_late: self.runs.too_smooth,
        };
        Ok((error, HistoryError::of(&scene, &reference).mean_square))
    }

    fn make_reference(&mut self, time_acceleration: f64, windows: &Windows) -> Result<Reference, AccuracyError> {
        let numerics = Numerics::of(self.runs.scene).accelerated(time_acceleration);
        let start_time = now();
        let name = format!("the reference run with {}", numerics.acceleration());
        let outcome = self
            .runs
            .make(&numerics, self.runs.scene.duration, windows, &name)
            .map_err(|unfinished| unfinished_before_any(unfinished, &name))?;
        let provenance = Provenance {
            file: None,
            program: self.wish.program.name.clone(),
            source_revision: self.wish.program.revision.clone(),
            host: machine::host(),
            workers: self.runs.execution.workers as u64,
            start_time,
        };
        Ok(Reference { time_acceleration, outcome, provenance })
    }

    /// Runs the rungs in the order of the plan.
    fn climb(
        &mut self,
        plan: &Plan,
        reference: &Reference,
        windows: &Windows,
    ) -> Result<(Vec<Row>, Option<u8>), AccuracyError> {
        let (mut rows, mut stopped) = (Vec::new(), None);
        for rung in &plan.rungs {
            // Without the first the reference would be for nothing.
            if !(rows.is_empty() || self.has_time(rung)) {
                continue;
            }
            match self.runs.make(&rung.numerics, self.runs.scene.duration, windows, &rung.full_name()) {
                Err(Unfinished::Stopped(signal)) if rows.is_empty() => {
                    let moment = "before any run could be compared".to_owned();
                    return Err(AccuracyError::Stopped { signal, moment });
                }
                Err(Unfinished::Stopped(signal)) => {
                    stopped = Some(signal);
                    break;
                }
                outcome => rows.push(self.row(*rung, outcome.map_err(|failed| failed.to_string()), reference, windows)),
            }
        }
        self.hold_against_own(&mut rows, reference, windows);
        Ok((rows, stopped))
    }

    /// Holds the runs against the scene's own run, from which all ladders but that of time accelerations and that of perturbed
    /// references start.
    fn hold_against_own(&self, rows: &mut [Row], reference: &Reference, windows: &Windows) {
        let own = Numerics::of(self.runs.scene);
        let areas = |history: &History| history.at(windows).mean_areas();
        let own_run = rows.iter().find(|row| row.rung.numerics == own).and_then(|row| row.result.as_ref().ok());
        let own_areas = match own_run {
            Some(run) => areas(&run.history),
            None if own == own.accelerated(reference.time_acceleration) => areas(&reference.outcome.history),
            None => return,
        };
        let start_from_own = |row: &&mut Row| {
            !matches!(row.rung.ladder, Ladder::TimeAcceleration | Ladder::Tolerance | Ladder::Perturbation)
        };
        for row in rows.iter_mut().filter(start_from_own) {
            if let Ok(run) = &mut row.result {
                run.change = HistoryError::of(&areas(&run.history), &own_areas).mean_square;
            }
        }
    }

    /// Whether a run fits into what is left of the budget; if not, that is noted.
    fn has_time(&mut self, rung: &Rung) -> bool {
        let left = self.wish.budget - self.started.elapsed().as_secs_f64();
        let needed = self.runs.seconds(&rung.numerics);
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

    /// Holds a run against the reference.
    fn row(&self, rung: Rung, outcome: Result<Outcome, String>, reference: &Reference, windows: &Windows) -> Row {
        let parameters = self.runs.parameters(&rung.numerics);
        let cells = [parameters.mesh.rows(), parameters.mesh.disc_columns(), parameters.mesh.pin_columns()];
        let (mesh, coarsening) = (&self.runs.scene.parameters.mesh, self.runs.coarsening(&rung.numerics));
        let measured = |outcome: Outcome| {
            let comparison = Comparison::of(&outcome, &reference.outcome, windows, mesh, coarsening);
            Measured::of(outcome, comparison)
        };
        Row::new(rung, cells, parameters.first_stiffness_number(), outcome.map(measured))
    }
}

/// Why there is nothing to compare with.
fn unfinished_before_any(unfinished: Unfinished, run: &str) -> AccuracyError {
    match unfinished {
        Unfinished::Stopped(signal) => AccuracyError::Stopped { signal, moment: format!("during {run}") },
        error => AccuracyError::Failed { run: run.to_owned(), error },
    }
}
