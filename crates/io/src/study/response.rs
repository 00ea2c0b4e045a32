//! Responses: one number that a run gives for each question of a study; what a scene needs in order to record the series that is asked,
//! and the least and largest value.

use plateau_core::observe::event::{EVENT_QUANTITIES, event_quantity};
use plateau_core::observe::extra::Extra;
use plateau_core::observe::running_in::{NotDefined, time_to, time_to_in_contact};
use plateau_core::observe::window_mean::{Cumulative, WindowMean, last_tenth};
use plateau_core::observe::{CYCLE, EXTRAS, quantities};
use thiserror::Error;

use crate::number;
use crate::scene::Scene;
use crate::study::record::{CONTACT_TIME, EVENT, REVOLUTIONS, Series, unit_of};

/// The series from which means of the contact area are taken: it knows every step.
const INTEGRAL: &str = "contact_area_integral";

/// A question to the series of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// Name of the response.
    pub name: String,
    /// The series that is asked, by its name in a run file; for a quantity of events with `event/` before it.
    pub series: String,
    /// The question to it.
    pub question: Question,
    /// Scale on which an analysis fits the answers: one of [`TRANSFORMS`].
    pub transform: &'static str,
    /// The unit that the study gives an answer from elsewhere, which people fill in; it measures the same as the SI unit.
    pub stated_unit: Option<String>,
}

/// Scales on which an analysis fits answers.
pub const TRANSFORMS: [&str; 4] = ["none", "log", "square root", "logit"];

/// Question to a series.
#[derive(Debug, Clone, PartialEq)]
pub enum Question {
    /// The last value.
    End,
    /// The value at a time, s, linear between samples.
    At(f64),
    /// The mean between two times, s.
    Mean(f64, f64),
    /// The mean over the last tenth of the run: see [`last_tenth`].
    MeanOfLastTenth,
    /// The value of an event.
    Event(WhichEvent),
    /// Nothing: the answers come from elsewhere, by `plateau sweep import`, in this SI unit.
    Imported(&'static str),
    /// The time, s, after which the series has come to this fraction of its value at the end: see [`time_to`].
    Reaches(f64),
    /// Nothing of a single run: `plateau fit` compares the whole series with one that was measured.
    Measured,
}

/// Choice among the events of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhichEvent {
    /// The one with this number, from 1.
    Number(usize),
    /// The last.
    Last,
    /// All of them: the mean of those that have a value.
    Mean,
}

/// Reason why a run gives no answer.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum NoAnswer {
    #[error("its series was not kept")]
    NotKept,
    #[error("it comes from elsewhere")]
    Elsewhere,
    #[error("the run ends at {} s, before {} s", number::rounded(*.end, 6), number::rounded(*.asked, 6))]
    Ended { asked: f64, end: f64 },
    #[error("there is no number then, as where the pin is lifted")]
    NoNumber,
    #[error("it has no such event, or the event has no value")]
    NoEvent,
    /// Time to reach the fraction, which is not defined for this run.
    #[error(transparent)]
    NotDefined(#[from] NotDefined),
}

impl Response {
    /// The answer of a run, in the unit of the series (s for [`Question::Reaches`]).
    pub fn of(&self, run: &Series) -> Result<f64, NoAnswer> {
        let answer = self.answer(run)?;
        if answer.is_finite() { Ok(answer) } else { Err(NoAnswer::NoNumber) }
    }

    fn answer(&self, run: &Series) -> Result<f64, NoAnswer> {
        if !self.is_of_one_run() {
            return Err(NoAnswer::Elsewhere);
        }
        if let Question::Event(which) = self.question {
            let values = self.series.strip_prefix(EVENT).and_then(|series| run.of_events(series));
            return of_event(values.ok_or(NoAnswer::NotKept)?, which).ok_or(NoAnswer::NoEvent);
        }
        let (time, values) = (run.time(), run.values(&self.series).ok_or(NoAnswer::NotKept)?);
        match self.question {
            Question::At(at) => value_at(time, values, reached(run, at)?),
            Question::Mean(..) | Question::MeanOfLastTenth => {
                let (from, to) = self.window(run)?;
                match self.integral(run) {
                    Some(integral) => mean_of_contact_area(run, integral, from, to).map(|found| found.mean),
                    None => mean(time, values, from, to),
                }
            }
            Question::Reaches(fraction) => return self.time_to(fraction, run, values),
            Question::End | Question::Event(_) | Question::Imported(_) | Question::Measured => values.last().copied(),
        }
        .ok_or(NoAnswer::NoNumber)
    }

    /// Time at which a series has come to a fraction of its last value, s; of the contact area by its integral, over the time in contact.
    /// Time in which another series has no value is left out, too.
    fn time_to(&self, fraction: f64, run: &Series, values: &[f64]) -> Result<f64, NoAnswer> {
        let time = run.time();
        let samples = |integral| Cumulative { time, integral, revolutions: revolutions(run) };
        if let Some(integral) = self.integral(run) {
            return Ok(match run.values(CONTACT_TIME) {
                Some(contact_time) => time_to_in_contact(fraction, &samples(integral), contact_time)?,
                None => time_to(fraction, &samples(integral), run.pulse_time)?,
            });
        }
        let (integral, known) = integral(time, values);
        if known.last().is_none_or(|known| *known == 0.0) {
            return Err(NoAnswer::NoNumber);
        }
        let pulse_time = run.pulse_time.filter(|_| self.is_of_contact_area());
        Ok(match values.iter().all(|value| value.is_finite()) {
            true => time_to(fraction, &samples(&integral), pulse_time)?,
            false => time_to_in_contact(fraction, &samples(&integral), &known)?,
        })
    }

    /// The series, or the quantity of events, that a run must have kept for an answer; none where it comes from elsewhere.
    pub fn needs(&self) -> impl Iterator<Item = &str> {
        let asked = (!self.is_imported()).then_some(self.series.as_str());
        asked.into_iter().chain(self.is_of_every_step().then_some([INTEGRAL, CONTACT_TIME]).into_iter().flatten())
    }

    /// Tells whether the answer is known with a standard error: a mean of the contact area.
    pub fn has_error(&self) -> bool {
        self.is_of_contact_area() && matches!(self.question, Question::Mean(..) | Question::MeanOfLastTenth)
    }

    /// Tells whether the answer is taken from the integral of the contact area.
    fn is_of_every_step(&self) -> bool {
        self.has_error() || self.is_of_contact_area() && matches!(self.question, Question::Reaches(_))
    }

    /// Standard error of the answer of a run, in the same unit, where it is known.
    pub fn error_of(&self, run: &Series) -> Option<f64> {
        let (from, to) = self.window(run).ok()?;
        mean_of_contact_area(run, self.integral(run)?, from, to)?.standard_error
    }

    fn is_of_contact_area(&self) -> bool {
        self.series == "contact_area" || self.series == "contact_area_mean"
    }

    /// The integral of the contact area, if that is asked.
    fn integral<'a>(&self, run: &'a Series) -> Option<&'a [f64]> {
        run.values(INTEGRAL).filter(|_| self.is_of_contact_area())
    }

    /// Times between which a mean is taken, s.
    fn window(&self, run: &Series) -> Result<(f64, f64), NoAnswer> {
        match self.question {
            Question::Mean(from, to) => Ok((reached(run, from)?, reached(run, to)?)),
            Question::MeanOfLastTenth => last_tenth(run.time(), revolutions(run)).ok_or(NoAnswer::NotKept),
            _ => Err(NoAnswer::NotKept),
        }
    }

    /// The last time, s, that the question names, if it names one.
    pub fn latest_time(&self) -> Option<f64> {
        match self.question {
            Question::At(time) | Question::Mean(_, time) => Some(time),
            _ => None,
        }
    }

    /// SI unit of the answer, given that of the series.
    pub fn unit<'a>(&self, of_series: &'a str) -> &'a str {
        match self.question {
            Question::Reaches(_) => "s",
            Question::Imported(unit) => unit,
            _ => of_series,
        }
    }

    /// Tells whether a run answers it by itself.
    pub fn is_of_one_run(&self) -> bool {
        !matches!(self.question, Question::Imported(_) | Question::Measured)
    }

    /// Tells whether its answers come from elsewhere, not from the series of runs.
    pub fn is_imported(&self) -> bool {
        matches!(self.question, Question::Imported(_))
    }
}

/// Mean contact area, m², by its integral, which knows every step, the samples only some. With a cycle it is over the time in contact.
fn mean_of_contact_area(run: &Series, integral: &[f64], from: f64, to: f64) -> Option<WindowMean> {
    let samples = Cumulative { time: run.time(), integral, revolutions: revolutions(run) };
    match run.values(CONTACT_TIME) {
        Some(contact_time) => samples.mean_in_contact(contact_time, from, to),
        None => Some(samples.mean(from, to)?.of_pulses(run.pulse_time)),
    }
}

/// The SI units that responses have, each once: those of series and events, and what is measured besides.
pub fn units() -> Vec<&'static str> {
    let series = quantities(EXTRAS).map(|quantity| quantity.unit);
    let mut units: Vec<&str> = series
        .chain(EVENT_QUANTITIES.iter().map(|quantity| quantity.unit))
        .chain(["N", "W", "m s-1", "Pa-1"])
        .collect();
    units.sort_unstable();
    units.dedup();
    units
}

/// Simulated revolutions at the samples; nothing where the run was recorded without them.
fn revolutions(run: &Series) -> &[f64] {
    run.values(REVOLUTIONS).unwrap_or_default()
}

/// The value of an event; none where there is no such event, or it has no value.
fn of_event(values: &[f64], which: WhichEvent) -> Option<f64> {
    let value = match which {
        WhichEvent::Number(number) => *values.get(number.checked_sub(1)?)?,
        WhichEvent::Last => *values.last()?,
        WhichEvent::Mean => {
            let there = values.iter().filter(|value| value.is_finite());
            there.clone().sum::<f64>() / there.count() as f64
        }
    };
    value.is_finite().then_some(value)
}

/// A time (s) that is asked for, as a time that there are samples of: the last sample stands for what is left of a run after it, less than
/// a step.
fn reached(run: &Series, asked: f64) -> Result<f64, NoAnswer> {
    let last = *run.time().last().ok_or(NoAnswer::NotKept)?;
    let end = run.until.max(last);
    // A number of steps may end one rounding before the time that is meant.
    if asked > end * (1.0 + 1e-9) { Err(NoAnswer::Ended { asked, end }) } else { Ok(asked.min(last)) }
}

/// Value at a time, linear between samples; before the first one, that one; none after the last.
fn value_at(time: &[f64], values: &[f64], at: f64) -> Option<f64> {
    if at > *time.last()? {
        return None;
    }
    let after = time.partition_point(|time| *time < at).min(time.len() - 1);
    if after == 0 || time[after] == time[after - 1] {
        return Some(values[after]);
    }
    let share = (at - time[after - 1]) / (time[after] - time[after - 1]);
    // A sample has its value even where the one before it has none.
    Some(if share == 1.0 { values[after] } else { values[after - 1] + share * (values[after] - values[after - 1]) })
}

/// The mean of the line through the samples, over the time in which there is one: while the pin is lifted, a series may have no
/// value.
fn mean(time: &[f64], values: &[f64], from: f64, to: f64) -> Option<f64> {
    let mut places = vec![(from, value_at(time, values, from)?)];
    let inside = time.iter().zip(values).filter(|(time, _)| (from < **time) && (**time < to));
    places.extend(inside.map(|(time, value)| (*time, *value)));
    places.push((to, value_at(time, values, to)?));
    let pieces = places.windows(2).map(|pair| (pair[1].0 - pair[0].0, (pair[0].1 + pair[1].1) / 2.0));
    let (area, duration) = pieces
        .filter(|(_, mean)| mean.is_finite())
        .fold((0.0, 0.0), |(area, duration), (length, mean)| (area + length * mean, duration + length));
    (duration > 0.0).then_some(area / duration)
}

/// The integral of that line over time since t = 0 and the time in which there is one, s; the first sample stands for what is before it.
fn integral(time: &[f64], values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut sum, mut known) = (0.0, 0.0);
    let mut before = (0.0, values.first().copied().unwrap_or(0.0));
    let added = |(time, value): (&f64, &f64)| {
        let (length, mean) = (time - before.0, 0.5 * (value + before.1));
        if mean.is_finite() {
            (sum, known) = (sum + length * mean, known + length);
        }
        before = (*time, *value);
        (sum, known)
    };
    time.iter().zip(values).map(added).unzip()
}

/// Part that a scene must have so that its run file has a series, or, with `event/` before it, a quantity of events; none if it has it.
pub fn lacking(scene: &Scene, series: &str) -> Option<String> {
    let extras = scene.extras(scene.adaptive.is_some());
    let needs = |extra: &Extra| extra.needs.to_owned();
    if let Some(name) = series.strip_prefix(EVENT) {
        if scene.cycle.is_none() {
            return Some(needs(&CYCLE));
        }
        return event_quantity(name)?.part.filter(|part| !extras.contains(part)).map(needs);
    }
    if quantities(&extras).any(|quantity| quantity.name == series) {
        return None;
    }
    let extra = EXTRAS.iter().find(|extra| extra.quantities.iter().any(|quantity| quantity.name == series))?;
    let is_asked_for = extra.request.is_none() || scene.output.extras.contains(extra);
    Some(if is_asked_for { needs(extra) } else { format!("output.{} = true", extra.name) })
}

const FRACTIONS: [&str; 7] =
    ["contact_ratio", "pin_primary", "pin_secondary", "pin_none", "disc_secondary", "filled_fraction", "pressure_gini"];
/// Units of what is not negative, whatever it is: areas and volumes, pressures, masses.
const NOT_NEGATIVE_UNITS: [&str; 5] = ["m2", "m2 s", "m3", "Pa", "kg"];
/// Units of what is not negative in tables from elsewhere, where a pressure may be a difference.
const NOT_NEGATIVE_ELSEWHERE: [&str; 3] = ["m2", "m3", "kg"];
/// Series of other units that are not negative.
const NOT_NEGATIVE: [&str; 12] = [
    "sliding_distance",
    "road_distance",
    "friction_coefficient",
    "friction_coefficient_mean",
    "friction_work",
    "particle_number",
    "pressure_variation",
    "disc_sa",
    "disc_sq",
    "pin_sa",
    "pin_sq",
    "normal_force",
];

/// The least and the most that a response can be, SI; infinite where there is no such bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least.
    pub least: f64,
    /// The most.
    pub most: f64,
}

impl Bounds {
    /// Bounds of what may be any number.
    pub const NONE: Self = Self { least: f64::NEG_INFINITY, most: f64::INFINITY };
    const NOT_NEGATIVE: Self = Self { least: 0.0, ..Self::NONE };
    const FRACTION: Self = Self { least: 0.0, most: 1.0 };
}

impl Response {
    /// Bounds of its values, as far as its series or unit tells.
    pub fn bounds(&self) -> Bounds {
        let name = self.series.rsplit('/').next().unwrap_or_default();
        match self.question {
            Question::Imported(unit) if NOT_NEGATIVE_ELSEWHERE.contains(&unit) => Bounds::NOT_NEGATIVE,
            Question::Imported(_) => Bounds::NONE,
            Question::Reaches(_) => Bounds::NOT_NEGATIVE,
            // A pin that hardly wears may gain what a disc loses.
            _ if name == "lost_pin" => Bounds::NONE,
            _ if FRACTIONS.contains(&name) => Bounds::FRACTION,
            _ if NOT_NEGATIVE.contains(&name) => Bounds::NOT_NEGATIVE,
            _ if NOT_NEGATIVE_UNITS.contains(&unit_of(&self.series)) => Bounds::NOT_NEGATIVE,
            _ => Bounds::NONE,
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/study/response.rs"]
mod tests;
