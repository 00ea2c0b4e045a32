//! All that was found: what the table, the files and the figure show, and which setting is advised.

use super::ladder::{Ladder, Rung};
use super::quantity::{COMPARED, COUNT, Compared, QuantityError, Values, greatest};
use super::reference::Reference;
use crate::accuracy::quantity::Windows;

/// All that was found.
#[derive(Debug, Clone)]
pub struct Report {
    /// Title of the scene.
    pub title: String,
    /// Run that the others are compared with.
    pub reference: Reference,
    /// Estimate of how far that is from the model itself, `time_acceleration` = 1.
    pub own: OwnError,
    /// Windows over which runs are compared.
    pub windows: Windows,
    /// Names of the quantities that count for front and advice.
    pub asked: Vec<&'static str>,
    /// Permitted error for which a setting is advised.
    pub tolerance: f64,
    /// A row for every rung that was run, ladder by ladder, the finest first.
    pub rows: Vec<Row>,
    /// Notes on what is worth knowing besides.
    pub notes: Vec<String>,
    /// The signal that ended the measurement before all runs were made.
    pub stopped: Option<u8>,
}

/// Error of the reference itself: of its time acceleration, from the first windows, the opening, in which the model itself was run,
/// too, and of its cells, where these are a numerical setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnError {
    /// Errors of the means in the opening, relative, root mean square.
    pub opening: Values,
    /// Ratio of errors over the whole run to errors in the opening.
    pub growth: Values,
    /// End of the opening, s; 0 where the reference is the model.
    pub end: f64,
    /// Errors by the cells of the reference: as large as the change from cells twice as long, for an error of first order.
    pub cells: Values,
}

impl OwnError {
    /// Error of the model itself, which has none.
    pub const NONE: Self = Self { opening: [0.0; COUNT], growth: [1.0; COUNT], end: 0.0, cells: [0.0; COUNT] };

    /// The same, with errors that grow after the opening as those of another run do: `opening` in the opening, `whole` over
    /// the whole run. Errors are not taken to shrink; where one of the two is not known there is no growth.
    #[must_use]
    pub fn growing(self, opening: &[QuantityError; COUNT], whole: &[QuantityError; COUNT]) -> Self {
        let growth = |one: usize| {
            let growth = whole[one].mean_square / opening[one].mean_square;
            if growth.is_finite() { growth.max(1.0) } else { 1.0 }
        };
        Self { growth: std::array::from_fn(growth), ..self }
    }

    /// Errors over the whole run, about.
    pub fn whole(&self) -> Values {
        std::array::from_fn(|one| self.opening[one] * self.growth[one] + self.cells[one])
    }
}

/// A rung and what came of it.
#[derive(Debug, Clone)]
pub struct Row {
    /// The rung.
    pub rung: Rung,
    /// Errors and time of the run, or the reason why it failed.
    pub result: Result<Measured, String>,
    /// True if no other rung is as quick and as exact.
    pub on_front: bool,
}

/// A run that came to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Number of steps.
    pub steps: u64,
    /// Wall time of all steps, s.
    pub wall_time: f64,
    /// Errors against the reference, in the order of [`COMPARED`].
    pub errors: [QuantityError; COUNT],
}

/// Advice for a permitted error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Advice {
    /// Row that is the quickest of those that are as exact.
    Use(usize),
    /// Row with the least error, where none is as exact.
    Missed(usize),
    /// No run is quicker than the reference and has an error that is known.
    NoChoice,
}

impl Report {
    /// Puts the rows in order, and finds the front.
    pub fn complete(&mut self) {
        self.rows.sort_by(|one, other| {
            let acceleration = |row: &Row| row.rung.scene.parameters.time_acceleration;
            let order = one.rung.ladder.cmp(&other.rung.ladder).then(one.rung.value.total_cmp(&other.rung.value));
            order.then(acceleration(one).total_cmp(&acceleration(other)))
        });
        let costs: Vec<Option<[f64; 2]>> = self.rows.iter().map(|row| self.cost(row)).collect();
        for (row, on_front) in self.rows.iter_mut().zip(front(&costs)) {
            row.on_front = on_front;
        }
    }

    /// Quantities that count for front and advice.
    pub fn counted(&self) -> impl Iterator<Item = (usize, &'static Compared)> {
        COMPARED.iter().enumerate().filter(|(_, compared)| self.asked.contains(&compared.name))
    }

    /// Largest error of the quantities that count, and the quantity; none where a run failed.
    pub fn worst(&self, row: &Row) -> Option<(f64, &'static Compared)> {
        let run = row.result.as_ref().ok()?;
        self.worst_of(&run.errors.map(|error| error.mean_square))
    }

    /// Largest error of the reference itself.
    pub fn own_error(&self) -> f64 {
        self.worst_of(&self.own.whole()).map_or(0.0, |(error, _)| error)
    }

    fn worst_of(&self, errors: &Values) -> Option<(f64, &'static Compared)> {
        let worst = greatest(self.counted().map(|(one, _)| errors[one]));
        let is_worst = |one: usize| errors[one].total_cmp(&worst).is_eq() || errors[one].is_nan();
        self.counted().find(|(one, _)| is_worst(*one)).or(self.counted().next()).map(|(_, of)| (worst, of))
    }

    /// Wall time (s) and largest error of a row that is a choice. No choice is a perturbed reference, and what is not quicker
    /// than the reference.
    fn cost(&self, row: &Row) -> Option<[f64; 2]> {
        let run = row.result.as_ref().ok()?;
        let reference = &self.reference.outcome;
        let is_quicker =
            run.steps < reference.steps && reference.wall_time.is_none_or(|longest| run.wall_time < longest);
        let (error, _) = self.worst(row).filter(|(error, _)| !error.is_nan())?;
        (is_quicker && row.rung.ladder != Ladder::Perturbation).then_some([run.wall_time, error])
    }

    /// Advises the quickest run whose error, with the reference's own, is permitted.
    pub fn advice(&self) -> Advice {
        let costs: Vec<Option<[f64; 2]>> = self.rows.iter().map(|row| self.cost(row)).collect();
        advise(self.tolerance - self.own_error(), &costs)
    }
}

/// Tells of each run whether it is on the Pareto front of wall time and error: no other one is as good in both, and better in one.
fn front(costs: &[Option<[f64; 2]>]) -> Vec<bool> {
    let beats = |one: [f64; 2], other: [f64; 2]| one[0] <= other[0] && one[1] <= other[1] && one != other;
    let is_beaten = |other: [f64; 2]| costs.iter().flatten().any(|one| beats(*one, other));
    costs.iter().map(|cost| cost.is_some_and(|cost| !is_beaten(cost))).collect()
}

fn advise(permitted: f64, costs: &[Option<[f64; 2]>]) -> Advice {
    let choices = || costs.iter().enumerate().filter_map(|(index, cost)| Some((index, (*cost)?)));
    let quickest = choices().filter(|(_, cost)| cost[1] <= permitted).min_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
    let most_exact = choices().min_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]));
    match (quickest, most_exact) {
        (Some((index, _)), _) => Advice::Use(index),
        (None, Some((index, _))) => Advice::Missed(index),
        (None, None) => Advice::NoChoice,
    }
}

#[cfg(test)]
#[path = "../../tests/unit/accuracy/report.rs"]
mod tests;
