//! Error against run time of one scene: the reference, its own error, and the runs compared with it, within a budget.

use std::time::Instant;

use plateau_core::acceleration::scout::Smoothness;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::Execution;
use plateau_io::dataset_file::now;
use plateau_io::process::load;
use plateau_io::scene::Scene;
use plateau_io::{number, surface};

use super::error::{AccuracyError, PlanError, Unfinished, enough};
use super::ladder::{Base, Ladder, LadderPoint, Rung, steps, time_accelerations};
use super::quantity::Course;
use super::reference::Reference;
use super::report::{Measured, OwnError, Report, Row};
use crate::accuracy::ladder::Cells;
use crate::accuracy::quantity::{LEAST_WINDOW, Windows, common_multiple};
use crate::accuracy::reference::{Outcome, make, try_steps};
use crate::error::{InputError, RunError};
use crate::execution::{self, cores};
use crate::options::{Observer, Program};

/// Part of the budget that the reference and its check may take.
const FOR_REFERENCE: f64 = 0.5;
/// Part of the budget for the check, as long as more than one window can be had for it.
const FOR_CHECK: f64 = 0.1;
/// Acceleration that a run which chooses it is thought to choose, at least, before it is made.
const USUAL_ACCELERATION: f64 = 20.0;
/// Fewest samples of a reference in a window that ends between them: interpolation errs by a part of their distance.
const SAMPLES_PER_WINDOW: f64 = 20.0;

/// Request for a measurement.
#[derive(Debug)]
pub struct Wish {
    /// The scene.
    pub base: Base,
    /// Ladders, in order.
    pub ladders: Vec<Ladder>,
    /// Names of the quantities that count for front and advice.
    pub quantities: Vec<&'static str>,
    /// Permitted error for which a setting is advised.
    pub tolerance: f64,
    /// Wall time that all runs may take, s.
    pub budget: f64,
    /// A reference that was read.
    pub reference: Option<Reference>,
    /// Program that makes the runs.
    pub program: Program,
}

/// Makes the reference, unless there is one, and the runs that fit into the budget.
pub fn measure(
    mut wish: Wish,
    surfaces: &InitialSurfaces,
    execution: Execution,
    observer: &dyn Observer,
) -> Result<Report, AccuracyError> {
    let Scene { parameters, duration, .. } = &wish.base.scene;
    let revolution = std::f64::consts::TAU / parameters.angular_velocity;
    let accelerations = time_accelerations(parameters.time_acceleration, duration / revolution);
    let read = wish.reference.take();
    let started = Instant::now();
    let mut run =
        Measurement { wish, surfaces, finest: None, execution, observer, started, step_time: 0.0, notes: Vec::new() };
    if read.is_none() {
        run.finest = run.halve().unwrap_or_else(|note| {
            run.notes.push(note);
            None
        });
    }
    let model = run.rung(1.0)?;
    run.step_time = try_steps(&model.scene, run.surfaces_of(&model)?, execution)? / model.cells.work().sqrt();

    let time_acceleration = run.choose_reference(&accelerations, revolution, read.as_ref())?;
    let rungs = run.rungs(&accelerations, time_acceleration);
    let windows = run.windows(&rungs, time_acceleration, revolution, read.as_ref());
    let check = run.check(model, time_acceleration, &windows)?;
    let reference = match read {
        Some(read) => read,
        None => run.make_reference(time_acceleration, &windows)?,
    };
    let expected = reference.outcome.course.at(&windows);
    let opening = expected.first(check.as_ref().map_or(0, |check| check.course.moments()));
    let mut own = OwnError::NONE;
    if let Some(check) = &check {
        let errors = opening.errors(&check.course);
        let end = windows.width * opening.moments() as f64;
        own = OwnError { opening: errors.map(|error| error.mean_square), end, ..own };
    }
    let (rows, stopped) = run.climb(rungs, &windows, &expected, &opening, &mut own)?;
    run.note_load();
    let Measurement { wish, notes, .. } = run;
    let (title, asked, tolerance) = (wish.base.scene.title, wish.quantities, wish.tolerance);
    let mut report = Report { title, reference, own, windows, asked, tolerance, rows, notes, stopped };
    report.complete();
    Ok(report)
}

/// The finest of these references, increasing, that costs no more than its part of the budget (s); else the budget that the
/// cheapest of them needs.
fn finest(references: &[f64], budget: f64, cost: impl Fn(f64) -> f64) -> Result<f64, Option<(f64, f64)>> {
    let costs = references.iter().map(|reference| (*reference, cost(*reference) / FOR_REFERENCE));
    let fits = costs.clone().find(|(_, needed)| *needed <= budget);
    fits.map(|(reference, _)| reference).ok_or_else(|| costs.min_by(|(_, a), (_, b)| a.total_cmp(b)))
}

/// A measurement on its way.
struct Measurement<'a> {
    wish: Wish,
    surfaces: &'a InitialSurfaces,
    /// Surfaces on the mesh of halved cells, if the cell is varied; those of all runs are samples of them.
    finest: Option<InitialSurfaces>,
    execution: Execution,
    observer: &'a dyn Observer,
    started: Instant,
    /// Wall time of a step with the scene's cells, s, from a trial or the last long run.
    step_time: f64,
    notes: Vec<String>,
}

impl Measurement<'_> {
    fn base(&self) -> &Scene {
        &self.wish.base.scene
    }

    /// Makes the surfaces on the mesh of halved cells, if the mesh is to be varied and the cell is a numerical setting; or a note on why it
    /// is not varied.
    fn halve(&self) -> Result<Option<InitialSurfaces>, String> {
        if !self.wish.ladders.contains(&Ladder::Mesh) {
            return Ok(None);
        }
        if self.base().parameters.plateaus.transport_length.is_none() {
            let note = "the cell is part of the model of this scene, so the mesh is not varied; with \
                        plateaus.transport_length it is a numerical setting";
            return Err(note.to_owned());
        }
        let point = LadderPoint { ladder: Ladder::TimeAcceleration, value: 1.0, cells: Cells::Halved };
        let unset = "the mesh is not varied: columns cannot be set where it is given in lengths, or the pin is round";
        let rung = Rung::new(&self.wish.base, point, 1.0).map_err(|_| unset)?;
        let unmade = |error| format!("the mesh is not varied: with {}, {error}", rung.setting());
        surface::load(&rung.scene).map(|loaded| Some(loaded.surfaces)).map_err(unmade)
    }

    /// Cells of the reference.
    fn finest_cells(&self) -> Cells {
        if self.finest.is_some() { Cells::Halved } else { Cells::Own }
    }

    /// A run with the cells of the reference and this time acceleration.
    fn rung(&self, time_acceleration: f64) -> Result<Rung, PlanError> {
        let step =
            LadderPoint { ladder: Ladder::TimeAcceleration, value: time_acceleration, cells: self.finest_cells() };
        Ok(Rung::new(&self.wish.base, step, time_acceleration)?)
    }

    fn surfaces_of(&self, rung: &Rung) -> Result<InitialSurfaces, RunError> {
        if rung.scene.disc_surface != self.base().disc_surface {
            let loaded = surface::load(&rung.scene).map_err(|error| InputError::Surface(Box::new(error)))?;
            return Ok(loaded.surfaces);
        }
        let rows = self.base().parameters.mesh.rows();
        Ok(self.finest.as_ref().map_or_else(|| self.surfaces.clone(), |finest| rung.cells.sample(finest, rows)))
    }

    /// Wall time of a run with these cells and this time acceleration, s.
    fn seconds(&self, cells: Cells, time_acceleration: f64) -> f64 {
        let parameters = &self.base().parameters;
        let steps = parameters.steps_of(self.base().duration) as f64;
        steps * parameters.time_acceleration / time_acceleration * self.step_time * cells.work()
    }

    /// Wall time that a window of the check takes, s, with so many seconds of physical time.
    fn check_seconds(&self, window: f64) -> f64 {
        self.seconds(self.finest_cells(), 1.0) * window / self.base().duration
    }

    /// Time acceleration of the reference: that which was read, or the smallest that the budget allows. It is finer than the
    /// scene, and 1 where only the model itself judges.
    fn choose_reference(
        &mut self,
        accelerations: &[f64],
        revolution: f64,
        read: Option<&Reference>,
    ) -> Result<f64, AccuracyError> {
        let scene = self.base();
        let own = scene.parameters.time_acceleration;
        // On a smooth disc with pooled debris the error of every acceleration comes late, and no check at the start shows it.
        let needs_model =
            scene.adaptive.is_some() || Smoothness::forbids_from_the_start(&scene.parameters, self.surfaces);
        let is_fine = |reference: f64| reference == 1.0 || !needs_model && reference < own;
        let finer = self.finest.is_some();
        let judges = |reference: f64| !steps(&self.wish.ladders, accelerations, None, reference, finer).is_empty();
        if let Some(read) = read {
            let reference = read.time_acceleration;
            return match (is_fine(reference), judges(reference)) {
                (true, true) => Ok(reference),
                (false, _) => Err(PlanError::NotFiner { reference, own, needs_model }.into()),
                (true, false) => Err(PlanError::NothingToRun { reference, notes: self.notes.clone() }.into()),
            };
        }
        let references: Vec<f64> = accelerations.iter().copied().filter(|one| is_fine(*one) && judges(*one)).collect();
        let cost = |reference: f64| {
            let coarser: Vec<f64> = accelerations.iter().copied().filter(|other| *other >= reference).collect();
            let windows = Windows::new(scene.duration, common_multiple(&coarser) * revolution, LEAST_WINDOW);
            self.seconds(self.finest_cells(), reference)
                + if reference > 1.0 { self.check_seconds(windows.width) } else { 0.0 }
        };
        let budget = self.wish.budget;
        let of_model = cost(1.0) / FOR_REFERENCE;
        match finest(&references, budget, cost) {
            Ok(reference) => {
                if reference > 1.0 {
                    self.notes.push(format!(
                        "the reference has time_acceleration = {reference}, the finest that the budget of {} allows; for 1, the \
                         model itself, give --budget {}",
                        number::duration(budget),
                        enough(of_model)
                    ));
                }
                Ok(reference)
            }
            Err(None) => Err(PlanError::NothingToRun { reference: 1.0, notes: self.notes.clone() }.into()),
            Err(Some((reference, needed))) => {
                let speed = 1.0 / self.step_time;
                Err(PlanError::TooSmall { budget, speed, reference, needed, of_model }.into())
            }
        }
    }

    /// Runs that this reference judges, the quickest first, so that a budget that runs out has the most of them.
    fn rungs(&mut self, accelerations: &[f64], reference: f64) -> Vec<Rung> {
        if reference > 1.0 && self.wish.ladders.contains(&Ladder::Tolerance) {
            let note = "runs that choose their acceleration begin with 1: not run, for the reference is not as fine";
            self.notes.push(note.to_owned());
        }
        let own = self.base().adaptive.map(|adaptive| adaptive.tolerance);
        let mut rungs = Vec::new();
        let mut left_out = Vec::new();
        for step in steps(&self.wish.ladders, accelerations, own, reference, self.finest.is_some()) {
            if step.cells.columns(&self.base().parameters.mesh).is_none() {
                left_out.push("cells twice as long are left out: mesh.disc_columns is odd".to_owned());
                continue;
            }
            match Rung::new(&self.wish.base, step, reference) {
                Ok(rung) => rungs.push(rung),
                Err(error) => {
                    let reason = &error.problems()[0].message;
                    left_out.push(format!("the ladder {} is left out: {reason}", step.ladder.name()));
                }
            }
        }
        left_out.dedup();
        self.notes.append(&mut left_out);
        // The run that tells the error by the reference's cells comes first.
        let key = |rung: &Rung| (!self.tells_cells(rung, reference), self.seconds_of(rung));
        rungs.sort_by(|one, other| {
            let [one, other] = [key(one), key(other)];
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        });
        rungs
    }

    /// Tells whether a run differs from the reference in cells twice as long alone.
    fn tells_cells(&self, rung: &Rung, reference: f64) -> bool {
        let is_same = rung.ladder == Ladder::TimeAcceleration && rung.value == reference;
        self.finest.is_some() && is_same && rung.cells == Cells::Own
    }

    /// Wall time of a run, s, as far as it can be told before.
    fn seconds_of(&self, rung: &Rung) -> f64 {
        let usual = if rung.scene.adaptive.is_some() { USUAL_ACCELERATION } else { 1.0 };
        self.seconds(rung.cells, rung.scene.parameters.time_acceleration * usual)
    }

    /// The same windows for all runs: whole revolutions of each of them, if that can be.
    fn windows(&mut self, rungs: &[Rung], reference: f64, revolution: f64, read: Option<&Reference>) -> Windows {
        let accelerations = rungs.iter().map(|rung| rung.scene.parameters.time_acceleration);
        let unit = common_multiple(&accelerations.chain([reference]).collect::<Vec<_>>()) * revolution;
        let Scene { duration, parameters, .. } = self.base();
        let windows = |least: f64| Windows::new(*duration, unit, LEAST_WINDOW.max(least));
        let Some(Reference { outcome, file: Some((_, sample_every)), .. }) = read else { return windows(0.0) };
        let narrow = windows(2.0 * sample_every);
        let step = parameters.step_time() * reference / parameters.time_acceleration;
        if outcome.course.knows(&narrow, step) {
            return narrow;
        }
        let wide = windows(SAMPLES_PER_WINDOW * sample_every);
        self.notes.push(format!(
            "windows end between samples of the reference, which are {} s apart: interpolation adds an error of its own, \
             larger the larger its time_acceleration; with one sample a revolution there is none",
            number::short(*sample_every)
        ));
        wide
    }

    /// Runs the model itself over the first windows, as many as a part of the budget allows, unless it is the reference.
    fn check(&mut self, model: Rung, reference: f64, windows: &Windows) -> Result<Option<Outcome>, AccuracyError> {
        if reference == 1.0 {
            return Ok(None);
        }
        let room = FOR_CHECK * self.wish.budget / self.check_seconds(windows.width);
        let opening = Windows { count: (room as usize).clamp(1, windows.count), ..*windows };
        let end = opening.width * opening.count as f64;
        let name = format!("the first {} s with {}", number::short(end), model.setting());
        let outcome = self.make(&model.lasting(end), &opening, &name);
        Ok(Some(outcome.map_err(|unfinished| before_any(unfinished, &name))?))
    }

    fn make_reference(&mut self, time_acceleration: f64, windows: &Windows) -> Result<Reference, AccuracyError> {
        let rung = self.rung(time_acceleration)?;
        let start_time = now();
        let name = format!("the reference run with {}", rung.setting());
        let outcome = self.make(&rung, windows, &name).map_err(|unfinished| before_any(unfinished, &name))?;
        Ok(Reference {
            time_acceleration,
            setting: rung.setting(),
            outcome,
            file: None,
            program: self.wish.program.clone(),
            host: execution::host(),
            workers: self.execution.workers as u64,
            start_time,
        })
    }

    /// Takes the steps of a run; `name` is shown meanwhile.
    fn make(&mut self, rung: &Rung, windows: &Windows, name: &str) -> Result<Outcome, Unfinished> {
        let surfaces = self.surfaces_of(rung)?;
        self.observer.starts(name, rung.scene.duration);
        let outcome = make(&rung.scene, surfaces, self.execution, windows, self.observer);
        self.observer.ends();
        let outcome = outcome?;
        // A run tells better than a trial how long steps take.
        if let Some(wall_time) = outcome.wall_time.filter(|time| *time > 1.0)
            && rung.scene.adaptive.is_none()
        {
            self.step_time = wall_time / outcome.steps as f64 / rung.cells.work().sqrt();
        }
        Ok(outcome)
    }

    /// Makes the runs, as long as there is time, and compares each with the course that is `expected`, and with the `opening` of it,
    /// which has no moments where the reference is the model. The reference's own error grows as that of the finest of them with the
    /// same cells; that by its cells is taken from the first run, if the cells are varied.
    fn climb(
        &mut self,
        rungs: Vec<Rung>,
        windows: &Windows,
        expected: &Course,
        opening: &Course,
        own: &mut OwnError,
    ) -> Result<(Vec<Row>, Option<u8>), AccuracyError> {
        let (mut rows, mut stopped, mut finest) = (Vec::new(), None, f64::INFINITY);
        for rung in rungs {
            // Without the first the reference would be for nothing.
            if !(rows.is_empty() || self.has_time(&rung)) {
                continue;
            }
            let result = match self.make(&rung, windows, &rung.setting()) {
                Err(Unfinished::Stopped(signal)) if rows.is_empty() => {
                    let moment = "before any run could be compared".to_owned();
                    return Err(AccuracyError::Stopped { signal, moment });
                }
                Err(Unfinished::Stopped(signal)) => {
                    stopped = Some(signal);
                    break;
                }
                Err(failed) => Err(failed.to_string()),
                Ok(Outcome { steps, wall_time, course }) => {
                    let errors = course.errors(expected);
                    let acceleration = rung.scene.parameters.time_acceleration;
                    let is_like = rung.scene.adaptive.is_none()
                        && rung.ladder != Ladder::Perturbation
                        && rung.cells == self.finest_cells();
                    if rows.is_empty() && self.finest.is_some() {
                        own.cells = errors.map(|error| error.mean_square);
                    }
                    if opening.moments() > 0 && is_like && acceleration < finest {
                        finest = acceleration;
                        *own = own.growing(&course.first(opening.moments()).errors(opening), &errors);
                    }
                    Ok(Measured { steps, wall_time: wall_time.unwrap_or(f64::NAN), errors })
                }
            };
            rows.push(Row { rung, result, on_front: false });
        }
        Ok((rows, stopped))
    }

    /// Tells whether a run fits into what is left of the budget; if not, that is noted.
    fn has_time(&mut self, rung: &Rung) -> bool {
        let left = self.wish.budget - self.started.elapsed().as_secs_f64();
        let needed = self.seconds_of(rung);
        if needed > left {
            let [needed, left] = [needed, left.max(0.0)].map(number::duration);
            self.notes.push(format!(
                "{}: not run, it takes about {needed} and {left} of the budget are left",
                rung.setting()
            ));
        }
        needed <= left
    }

    fn note_load(&mut self) {
        if let Some(load) = load().filter(|load| *load > cores() as f64 + 0.5) {
            self.notes.push(format!(
                "other programs were running, too (load {load} on {} cores): wall times are longer than on a quiet machine",
                cores()
            ));
        }
    }
}

/// Makes the error of a run that ended before there was anything to compare.
fn before_any(unfinished: Unfinished, run: &str) -> AccuracyError {
    match unfinished {
        Unfinished::Stopped(signal) => AccuracyError::Stopped { signal, moment: format!("during {run}") },
        error => AccuracyError::Failed { run: run.to_owned(), error },
    }
}

#[cfg(test)]
#[path = "../../tests/unit/accuracy/measure.rs"]
mod tests;
