//! All that was found: what the table, the files and the figure show.

use plateau_io::number::percent;

use super::choice::{CLEAR, Cost, front};
use super::comparison::{Comparison, Outcome};
use super::history::{History, Windows};
use super::ladder::{Ladder, Rung};
use super::order::{self, Point};
use super::reference::{OwnError, Reference};

/// All that was found.
#[derive(Debug, Clone)]
pub struct Report {
    /// Title of the scene.
    pub title: String,
    /// What the runs are held against.
    pub reference: Reference,
    /// How far that is from the model itself.
    pub own_error: OwnError,
    /// Over which contact areas are compared.
    pub windows: Windows,
    /// One row for every rung that was run, ladder by ladder, the finest first.
    pub rows: Vec<Row>,
    /// What is worth knowing besides.
    pub notes: Vec<String>,
}

/// A rung and what came of it.
#[derive(Debug, Clone)]
pub struct Row {
    /// The rung.
    pub rung: Rung,
    /// Rows, columns of the disc and of the pin.
    pub cells: [usize; 3],
    /// Stiffness number.
    pub stiffness_number: f64,
    /// What was measured, or why the run failed.
    pub result: Result<Measured, String>,
    /// Whether the error of the contact area is well above the reference's own.
    pub is_clear: bool,
    /// Whether no other rung is as quick and as exact.
    pub on_front: bool,
    /// Observed order of convergence from the next finer rung to this one; NaN where there is none.
    pub order: f64,
    /// Why the order means nothing, if it does; else empty.
    pub order_note: String,
}

/// A run that came to its end.
#[derive(Debug, Clone)]
pub struct Measured {
    /// Steps.
    pub steps: u64,
    /// Wall time, s.
    pub wall_time: Option<f64>,
    /// Its course.
    pub history: History,
    /// Largest load residual of any step.
    pub load_residual: f64,
    /// Balance residual at the end.
    pub balance_residual: f64,
    /// How far it is from the reference.
    pub comparison: Comparison,
    /// Error of the contact areas against the scene's own run, from which this one differs in one thing; NaN on the ladder
    /// of time accelerations, and where the scene's own run failed or was not made.
    pub change: f64,
}

impl Measured {
    /// What is kept of a run that was compared.
    pub fn of(outcome: Outcome, comparison: Comparison) -> Self {
        let Outcome { steps, wall_time, history, end, .. } = outcome;
        let (load_residual, balance_residual) = (end.load_residual, end.balance_residual);
        Self { steps, wall_time, history, load_residual, balance_residual, comparison, change: f64::NAN }
    }
}

impl Row {
    /// A row of which orders and front are not known yet.
    pub fn new(rung: Rung, cells: [usize; 3], stiffness_number: f64, result: Result<Measured, String>) -> Self {
        Self {
            rung,
            cells,
            stiffness_number,
            result,
            is_clear: false,
            on_front: false,
            order: f64::NAN,
            order_note: String::new(),
        }
    }

    /// Keys and values that make this run, as a scene has them.
    pub fn setting(&self) -> String {
        let [rows, disc_columns, pin_columns] = self.cells;
        match self.rung.ladder {
            Ladder::Mesh => format!(
                "{}, rows = {rows}, disc_columns = {disc_columns}, pin_columns = {pin_columns}",
                self.rung.numerics.acceleration()
            ),
            _ => self.rung.full_name(),
        }
    }

    /// Error of the contact areas; NaN where the run failed.
    pub fn error(&self) -> f64 {
        self.result.as_ref().map_or(f64::NAN, |measured| measured.comparison.contact_area.mean_square)
    }

    /// Wall time and error.
    pub fn cost(&self) -> Cost {
        let time = self.result.as_ref().ok().and_then(|measured| measured.wall_time).unwrap_or(f64::NAN);
        Cost { time, error: self.error() }
    }

    /// Wall time and error as they count for a choice. A run that equals the scene's own, step by step, is none, for only
    /// chance makes it the quicker of the two; nor is a perturbed reference, nor what is not quicker than the reference.
    fn choice(&self, reference: &Outcome) -> Cost {
        let is_quicker = |run: &Measured| reference.wall_time.is_none() || run.wall_time < reference.wall_time;
        let none = |run: &Measured| run.change == 0.0 || run.steps >= reference.steps || !is_quicker(run);
        let none = self.rung.ladder == Ladder::Perturbation || self.result.as_ref().is_ok_and(none);
        Cost { error: if none { f64::NAN } else { self.error() }, ..self.cost() }
    }
}

impl Report {
    /// Puts the rows in order and fills in what needs all of them: front and orders.
    pub fn complete(&mut self) {
        self.rows.sort_by(|one, other| {
            let place = |row: &Row| (row.rung.ladder, row.rung.value());
            let ((one_ladder, one), (other_ladder, other)) = (place(one), place(other));
            one_ladder.cmp(&other_ladder).then(one.total_cmp(&other))
        });
        let on_front = front(&self.choices());
        let own_error = self.own_error.contact_area();
        for (row, on_front) in self.rows.iter_mut().zip(on_front) {
            row.is_clear = row.error() >= CLEAR * own_error;
            row.on_front = on_front && row.is_clear;
        }
        let reference = Point { size: self.reference.time_acceleration, error: own_error };
        self.observe_orders(Ladder::TimeAcceleration, reference, |measured| {
            measured.comparison.contact_area.mean_square
        });
        // The scene's mesh is the reference of the other meshes.
        self.observe_orders(Ladder::Mesh, Point { size: 1.0, error: 0.0 }, |measured| measured.change);
        self.note_ladders();
    }

    /// Wall time and error of every row that is a choice; the error of the others is NaN.
    pub fn choices(&self) -> Vec<Cost> {
        self.rows.iter().map(|row| row.choice(&self.reference.outcome)).collect()
    }

    /// Says what the rows of a ladder show together.
    fn note_ladders(&mut self) {
        let perturbed = self.rows.iter().filter(|row| row.rung.ladder == Ladder::Perturbation).map(Row::error);
        if let Some(error) = perturbed.filter(|error| !error.is_nan()).reduce(f64::max) {
            self.notes.push(format!(
                "small changes of the initial heights change the contact area of the reference by up to {}: smaller errors \
                 are chance",
                percent(error)
            ));
        }
        let points: Vec<Point> = self
            .rows
            .iter()
            .filter(|row| row.rung.ladder == Ladder::TimeAcceleration)
            .map(|row| Point { size: row.rung.value(), error: row.error() })
            .collect();
        let reference = Point { size: self.reference.time_acceleration, error: self.own_error.contact_area() };
        if let Some(order) = order::fitted(&points, reference) {
            self.notes.push(format!(
                "the errors of all time accelerations together grow with order {order:.2} (least squares, from {} times the \
                 reference's on)",
                order::FAR
            ));
        }
    }

    fn observe_orders(&mut self, ladder: Ladder, reference: Point, error: impl Fn(&Measured) -> f64) {
        let mut finer: Option<Point> = None;
        for row in self.rows.iter_mut().filter(|row| row.rung.ladder == ladder) {
            let Ok(measured) = &row.result else { continue };
            let coarser = Point { size: row.rung.value(), error: error(measured) };
            match finer.map(|finer| order::observed(finer, coarser, reference)) {
                Some(Ok(order)) => row.order = order,
                Some(Err((why, order))) => {
                    row.order = order.unwrap_or(f64::NAN);
                    row.order_note = why.to_string();
                }
                None => {}
            }
            finer = Some(coarser);
        }
    }
}
