//! `plateau fit`: values of a scene's keys with which runs give what was measured.

mod document;
mod files;
mod plan;
mod rounds;
mod task;
mod text;

use plateau_present::study::fit::FittedKey;
use plateau_study::fit::FitResult;

use crate::arguments::FitArguments;
use crate::failure::{Failure, in_job};
use crate::table::print;
use crate::{message, number, sweep};
use rounds::Fitted;
use task::Task;

/// What all outputs are made of.
struct Told<'a> {
    fitted: &'a Fitted,
    task: &'a Task,
    result: &'a FitResult,
    keys: &'a [FittedKey],
}

/// Makes runs and fits, and says what came of it.
pub fn fit(arguments: &FitArguments) -> Result<(), Failure> {
    let plan = sweep::plan(&arguments.study)?;
    let task = Task::of(plan.study())?;
    task.check_times(&plan)?;
    if plan.study().fit.runs < plan.runs() {
        message::warning(format_args!(
            "fit.runs = {} is fewer than the {} of the design, which are made all the same",
            plan.study().fit.runs,
            number::count(plan.runs(), "run")
        ));
    }
    if arguments.plan {
        return plan::say(&plan, &task, arguments);
    }
    let folder = files::folder(plan.study(), arguments)?;
    in_job(|job| {
        let Some(fitted) = rounds::fitted(plan, &task, arguments, job)? else { return Ok(()) };
        let result = fitted.fit.result();
        let keys: Vec<FittedKey> = fitted.plan.study().factors.iter().map(FittedKey::of).collect();
        let told = Told { fitted: &fitted, task: &task, result: &result, keys: &keys };
        let files = files::write(&told, folder)?;
        if arguments.json { print(&document::text(&told, &files)?) } else { print(&text::text(&told, &files)) }
    })
}

impl Told<'_> {
    /// Whether the fit ended because further runs would have changed little, though not enough is known.
    fn has_no_gain(&self) -> bool {
        self.fitted.end == rounds::End::NoGain
    }

    /// Names of the responses that were measured.
    fn names(&self) -> Vec<&str> {
        let responses = &self.fitted.plan.study().responses;
        self.task.responses.iter().map(|at| responses[*at].name.as_str()).collect()
    }

    /// Names of the responses of which a whole series was measured, with the SI units of the series.
    fn series(&self) -> Vec<(&str, &'static str)> {
        let responses = &self.fitted.plan.study().responses;
        let of =
            |at: &usize| (responses[*at].name.as_str(), plateau_io::study::collected::unit_of(&responses[*at].series));
        self.task.series.iter().map(of).collect()
    }

    /// The units in which the tables of the series have the time.
    fn times(&self) -> Vec<&str> {
        let responses = &self.fitted.plan.study().responses;
        let unit = |at: &usize| responses[*at].measured_series().map_or("s", |file| file.time_unit.as_str());
        self.task.series.iter().map(unit).collect()
    }

    /// SI units of those of which a value was measured.
    fn units(&self) -> Vec<&str> {
        let responses = &self.fitted.plan.study().responses;
        let unit = |at: &usize| responses[*at].unit(plateau_io::study::collected::unit_of(&responses[*at].series));
        self.task.responses.iter().map(unit).collect()
    }
}
